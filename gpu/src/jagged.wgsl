// Where the fragments of a tile's lists are: as jagged diagonals (Saad 1989), so that neighbouring
// invocations read and write neighbouring words whatever the lists' lengths. Lists are taken longest
// first; row i holds entry i of every list that has one. Nothing is left free between rows, or tiles.
//
// A tile with a list of more than ROWS entries keeps its lists one after another instead. Imported
// where there are `listed` and `opaque_key`.
//#import draw
//#import counter
//#import digest

struct List {
    // Its first entry, and CONTIGUOUS.
    start: u32,
    length: u32,
    // How far it is filled, and IN_ORDER.
    filled: u32,
}

// The lists of a tile, in order of its pixels.
@group(0) @binding(30) var<storage, read_write> lists: array<List>;

// Of each tile, entries in rows before each.
@group(0) @binding(31) var<storage, read_write> rows: array<u32>;

// The longest list of all; which kernels of stage shade have any, a bit for each; lists longer than LONG.
struct Longest {
    length: atomic<u32>,
    kernels: atomic<u32>,
    count: atomic<u32>,
    lists: array<u32>,
}

@group(0) @binding(32) var<storage, read_write> longest: Longest;

const CONTIGUOUS: u32 = 0x80000000u;

// Each entry is nearer than the next.
const IN_ORDER: u32 = 0x80000000u;

// Entries of the longest list of a tile with rows.
const ROWS: u32 = 64u;

// Entries that an invocation blends in one go: llvmpipe leaves loops after 65,535 rounds.
const AT_ONCE: u32 = 16384u;

// In `start`: its tile is done, and has no lists.
const NO_LIST: u32 = 0xffffffffu;

// A list as it is read and written.
struct Run {
    start: u32,
    length: u32,
    // Where its tile's rows are, or CONTIGUOUS.
    row: u32,
    in_order: bool,
}

fn run_at(tile: u32, lane: u32) -> Run {
    let list = lists[tile * WORKGROUP + lane];
    let row = select(tile * ROWS, CONTIGUOUS, (list.start & CONTIGUOUS) != 0u);
    return Run(list.start & ~CONTIGUOUS, list.length, row, (list.filled & IN_ORDER) != 0u);
}

fn slot(run: Run, i: u32) -> u32 {
    if run.row == CONTIGUOUS {
        return run.start + i;
    }
    return run.start + rows[run.row + i];
}

const FROM_BACK: bool = false;

// What an invocation keeps of its list while it is filled.
struct Held {
    run: Run,
    // The last fragment, and whether each was nearer than the next.
    last: Listed,
    in_order: bool,
}

// Fragments of each pixel of a tile.
var<workgroup> kept: array<atomic<u32>, WORKGROUP>;
// How many entries of a tile lie before each row.
var<workgroup> own_rows: array<u32, ROWS>;

// Kernels of stage shade that take any of a tile's lists.
var<workgroup> kernels_here: atomic<u32>;

fn start_pixel(own: ptr<function, Pixel>, fill: bool) {
    let list = (*own).tile * WORKGROUP + (*own).lane;
    (*own).held.in_order = tiled.first == 0u;
    if fill {
        let run = run_at((*own).tile, (*own).lane);
        (*own).held.run = run;
        if run.row != CONTIGUOUS {
            own_rows[(*own).lane] = rows[run.row + (*own).lane];
        }
    }
    if tiled.first > 0u {
        (*own).count = select(lists[list].length, lists[list].filled & ~IN_ORDER, fill);
    }
    atomicStore(&kept[(*own).lane], (*own).count);
}

fn put_small(tile: u32, pixel: u32, entry: Listed, fill: bool) {
    let i = atomicAdd(&kept[pixel], 1u);
    if fill {
        write(run_at(tile, pixel), i, entry);
    }
}

fn take_small(own: ptr<function, Pixel>) {
    let count = atomicLoad(&kept[(*own).lane]);
    (*own).held.in_order = (*own).held.in_order && count == (*own).count;
    (*own).count = count;
}

fn put(own: ptr<function, Pixel>, entry: Listed, fill: bool) {
    if fill {
        write((*own).held.run, (*own).count, entry);
        let follows = (*own).count == 0u || less((*own).held.last, entry);
        (*own).held.in_order = (*own).held.in_order && follows;
        (*own).held.last = entry;
    }
    (*own).count += 1u;
}

fn leave_pixel(own: Pixel) {
    atomicStore(&kept[own.lane], own.count);
}

fn write(run: Run, i: u32, entry: Listed) {
    var address = run.start + i;
    if run.row != CONTIGUOUS {
        address = run.start + own_rows[i];
    }
    if address < tiled.capacity {
        listed[address] = entry;
    }
}

fn count_lists(tile: u32, lane: u32) {
    let list = tile * WORKGROUP + lane;
    if is_left(tile) {
        lists[list].length = draw(tile, lane, false).count;
        lists[list].start = 0u;
    } else {
        lists[list].start = NO_LIST;
    }
}

// Whether there is such a tile that has lists.
fn has_lists(tile: u32) -> bool {
    return tile < tiled.items && lists[tile * WORKGROUP].start != NO_LIST;
}

fn fill_lists(tile: u32, lane: u32) {
    if lane == 0u {
        atomicStore(&kernels_here, 0u);
    }
    var own = draw(tile, lane, true);
    let in_order = own.held.in_order || own.count < 2u;
    lists[tile * WORKGROUP + lane].filled = own.count | select(0u, IN_ORDER, in_order);
    atomicOr(&kernels_here, 1u << kernel_of(own.held.run, own.count, in_order));
    workgroupBarrier();
    if lane == 0u {
        atomicOr(&longest.kernels, atomicLoad(&kernels_here));
    }
}

// Which kernel of stage shade takes a list: those of up to 8, 16, 32, 64 entries, of lists that lie
// one after another, and of lists that are blended as they are.
fn kernel_of(run: Run, length: u32, in_order: bool) -> u32 {
    if in_order && length <= AT_ONCE {
        return 5u;
    }
    if run.row == CONTIGUOUS {
        return 4u;
    }
    return u32(length > 8u) + u32(length > 16u) + u32(length > 32u);
}

// Of each length up to ROWS, the lists of a tile that have it, a bit each.
var<workgroup> alike: array<atomic<u32>, 130>;
var<workgroup> longest_here: atomic<u32>;
var<workgroup> longest_of_tile: u32;
var<workgroup> partial: array<u32, WORKGROUP>;
var<workgroup> first_of_tile: u32;

// How many of the bits before number `lane` are set.
fn ones_before(bits: vec2<u32>, lane: u32) -> u32 {
    let below = (1u << (lane % 32u)) - 1u;
    if lane < 32u {
        return countOneBits(bits.x & below);
    }
    return countOneBits(bits.x) + countOneBits(bits.y & below);
}

// The sum of a value up to this invocation's own.
fn sum_up_to(value: u32, lane: u32) -> u32 {
    var sum = value;
    for (var reach = 1u; reach < WORKGROUP; reach *= 2u) {
        workgroupBarrier();
        partial[lane] = sum;
        workgroupBarrier();
        if lane >= reach {
            sum += partial[lane - reach];
        }
    }
    return sum;
}

// All of a workgroup come along. The host has made sure that no sum is beyond SATURATED: a band's
// bins hold at most 2^25 triangles.
fn place_lists(tile: u32, lane: u32) {
    let list = tile * WORKGROUP + lane;
    let length = lists[list].length;
    for (var i = lane; i < 130u; i += WORKGROUP) {
        atomicStore(&alike[i], 0u);
    }
    if lane == 0u {
        atomicStore(&longest_here, 0u);
    }
    workgroupBarrier();
    atomicMax(&longest_here, length);
    atomicOr(&alike[2u * min(length, ROWS) + lane / 32u], 1u << (lane % 32u));
    workgroupBarrier();
    if lane == 0u {
        longest_of_tile = atomicLoad(&longest_here);
        atomicMax(&longest.length, longest_of_tile);
    }
    if workgroupUniformLoad(&longest_of_tile) > ROWS {
        place_runs(list, length, lane);
    } else {
        place_rows(tile, list, length, lane);
    }
}

// One list after another.
fn place_runs(list: u32, length: u32, lane: u32) {
    let end = sum_up_to(length, lane);
    if lane == WORKGROUP - 1u {
        first_of_tile = atomicAdd(&counter, end);
    }
    lists[list].start = (workgroupUniformLoad(&first_of_tile) + end - length) | CONTIGUOUS;
    if length > LONG {
        longest.lists[atomicAdd(&longest.count, 1u)] = list;
    }
}

fn alike_at(length: u32) -> vec2<u32> {
    return vec2(atomicLoad(&alike[2u * length]), atomicLoad(&alike[2u * length + 1u]));
}

// In rows: lane l looks after row l as well, of the lists that are longer than l.
fn place_rows(tile: u32, list: u32, length: u32, lane: u32) {
    // Lengths from the longest down.
    let down = alike_at(ROWS - lane);
    let longer = sum_up_to(countOneBits(down.x) + countOneBits(down.y), lane);
    workgroupBarrier();
    partial[ROWS - 1u - lane] = longer;
    workgroupBarrier();
    let in_row = partial[lane];
    // Lists that are longer, or as long and before this one.
    var rank = ones_before(alike_at(length), lane);
    if length < ROWS {
        rank += partial[length];
    }
    let end = sum_up_to(in_row, lane);
    rows[tile * ROWS + lane] = end - in_row;
    if lane == WORKGROUP - 1u {
        first_of_tile = atomicAdd(&counter, end);
    }
    lists[list].start = workgroupUniformLoad(&first_of_tile) + rank;
}
