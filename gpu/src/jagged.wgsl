// Where the fragments of a tile's lists are: as jagged diagonals (Saad 1989), so that neighbouring
// invocations read and write neighbouring words whatever the lists' lengths. Lists are taken longest
// first; row i holds entry i of every list that has one. Nothing is left free between rows, or tiles.
//
// A tile with a list of more than ROWS entries keeps its lists one after another instead. Imported
// where there are `listed` and `opaque_key`.
//#import draw
//#import counter
//#import digest
//#import jagged_run

struct List {
    // Its first entry, and CONTIGUOUS.
    start: u32,
    length: u32,
    // How far it is filled, and IN_ORDER.
    filled: u32,
}

// The lists of a tile, in order of its pixels.
@group(0) @binding(30) var<storage, read_write> lists: array<List>;

// Of each tile, where its rows are told of, and there how many entries lie before each. There are no more
// rows than triangles in the tile's bin, so that they have the place that these have among the bins.
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

// Entries of the longest list of a tile with rows: no more than LONG, as the longest lists of all are
// merged where they lie one after another.
const ROWS: u32 = 256u;
const_assert ROWS <= LONG;
const_assert ROWS % 2u == 0u && ROWS * WORKGROUP <= 1u << 16u;

// Entries that an invocation blends in one go: llvmpipe leaves loops after 65,535 rounds.
const AT_ONCE: u32 = 16384u;

// Entries of the longest list that is sorted in registers.
const IN_REGISTERS: u32 = 64u;

// In `start`: its tile is done, and has no lists.
const NO_LIST: u32 = 0xffffffffu;

fn run_at(tile: u32, lane: u32) -> Run {
    let list = lists[tile * WORKGROUP + lane];
    let row = select(rows[tile], CONTIGUOUS, (list.start & CONTIGUOUS) != 0u);
    return Run(list.start & ~CONTIGUOUS, list.length, row, (list.filled & IN_ORDER) != 0u);
}

const FROM_BACK: bool = false;

// Where a list begins, and whether its entries lie in rows.
struct Start {
    at: u32,
    in_rows: bool,
}

fn start_of(list: u32) -> Start {
    let start = lists[list].start;
    return Start(start & ~CONTIGUOUS, (start & CONTIGUOUS) == 0u);
}

// What an invocation keeps of its list while it is filled.
struct Held {
    start: Start,
    // The last fragment, and whether each was nearer than the next.
    last: Listed,
    in_order: bool,
}

// Fragments of each pixel of a tile.
var<workgroup> kept: array<atomic<u32>, WORKGROUP>;
// How many entries of a tile lie before each row, two to a word: a KiB more takes the room of three of 32
// workgroups on a multiprocessor of an H200, and 5 % of the speed at which lists are filled.
var<workgroup> own_rows: array<u32, ROWS / 2u>;

// Kernels of stage shade that take any of a tile's lists.
var<workgroup> kernels_here: atomic<u32>;

fn start_pixel(own: ptr<function, Pixel>, fill: bool) {
    let list = (*own).tile * WORKGROUP + (*own).lane;
    (*own).held.in_order = tiled.first == 0u;
    if fill {
        (*own).held.start = start_of(list);
        if (*own).held.start.in_rows {
            take_rows((*own).tile, (*own).lane);
        }
    }
    if tiled.first > 0u {
        (*own).count = select(lists[list].length, lists[list].filled & ~IN_ORDER, fill);
    }
    atomicStore(&kept[(*own).lane], (*own).count);
}

// The rows of a tile that has any, to where all of the workgroup see them.
fn take_rows(tile: u32, lane: u32) {
    let bin = bin_of(tile);
    let count = min(bin.y - bin.x, ROWS);
    let told = rows[tile];
    for (var row = 2u * lane; row < count; row += 2u * WORKGROUP) {
        own_rows[row / 2u] = rows[told + row] | (rows[told + min(row + 1u, count - 1u)] << 16u);
    }
}

fn own_row(i: u32) -> u32 {
    return (own_rows[i / 2u] >> (16u * (i % 2u))) & 0xffffu;
}

fn put_small(tile: u32, pixel: u32, entry: Listed, fill: bool) {
    let i = atomicAdd(&kept[pixel], 1u);
    if fill {
        write(start_of(tile * WORKGROUP + pixel), i, entry);
    }
}

fn take_small(own: ptr<function, Pixel>) {
    let count = atomicLoad(&kept[(*own).lane]);
    (*own).held.in_order = (*own).held.in_order && count == (*own).count;
    (*own).count = count;
}

fn put(own: ptr<function, Pixel>, entry: Listed, fill: bool) {
    if fill {
        write((*own).held.start, (*own).count, entry);
        let follows = (*own).count == 0u || less((*own).held.last, entry);
        (*own).held.in_order = (*own).held.in_order && follows;
        (*own).held.last = entry;
    }
    (*own).count += 1u;
}

fn leave_pixel(own: Pixel) {
    atomicStore(&kept[own.lane], own.count);
}

fn write(start: Start, i: u32, entry: Listed) {
    var address = start.at + i;
    if start.in_rows {
        address = start.at + own_row(i);
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
    atomicOr(&kernels_here, 1u << kernel_of(!own.held.start.in_rows, own.count, in_order));
    workgroupBarrier();
    if lane == 0u {
        atomicOr(&longest.kernels, atomicLoad(&kernels_here));
    }
}

// Of lists that are sorted in memory, and of such that are blended as they are.
const IN_MEMORY: u32 = 4u;
const AS_IT_IS: u32 = 5u;

// Which kernel of stage shade takes a list; the first ones are those of up to 8, 16, 32, 64 entries.
fn kernel_of(is_contiguous: bool, length: u32, in_order: bool) -> u32 {
    if in_order && length <= AT_ONCE {
        return AS_IT_IS;
    }
    if is_contiguous || length > IN_REGISTERS {
        return IN_MEMORY;
    }
    return u32(length > 8u) + u32(length > 16u) + u32(length > 32u);
}

fn kernel_of_run(run: Run) -> u32 {
    return kernel_of(run.row == CONTIGUOUS, run.length, run.in_order);
}

// Of each list of a tile its length, and by how many places it stands before the tile's last: longer ones,
// and of equally long ones those of earlier pixels, are larger.
var<workgroup> lengths: array<u32, WORKGROUP>;
var<workgroup> first_of_tile: u32;

const LANE_BITS: u32 = 6u;
const_assert WORKGROUP == 1u << LANE_BITS;

// Four of them at a time.
fn lengths_from(first: u32) -> vec4<u32> {
    return vec4(lengths[first], lengths[first + 1u], lengths[first + 2u], lengths[first + 3u]);
}

// A list among those of its tile.
struct Among {
    // Entries of the longest, of all.
    longest: u32,
    all: u32,
    // Lists that begin before it in rows.
    rank: u32,
}

fn sum(four: vec4<u32>) -> u32 {
    return four.x + four.y + four.z + four.w;
}

fn among(own: u32) -> Among {
    var largest = vec4(0u);
    var all = vec4(0u);
    var before = vec4(0u);
    for (var i = 0u; i < WORKGROUP; i += 4u) {
        let others = lengths_from(i);
        largest = max(largest, others);
        all += others >> vec4(LANE_BITS);
        before += select(vec4(0u), vec4(1u), others > vec4(own));
    }
    let longest = max(max(largest.x, largest.y), max(largest.z, largest.w)) >> LANE_BITS;
    return Among(longest, sum(all), sum(before));
}

// All of a workgroup come along. The host has made sure that no sum is beyond SATURATED: a band's
// bins hold at most 2^25 triangles, so that a length leaves LANE_BITS.
fn place_lists(tile: u32, lane: u32) {
    let list = tile * WORKGROUP + lane;
    let length = lists[list].length;
    let own = (length << LANE_BITS) | (WORKGROUP - 1u - lane);
    lengths[lane] = own;
    workgroupBarrier();
    let found = among(own);
    if lane == 0u {
        first_of_tile = atomicAdd(&counter, found.all);
        atomicMax(&longest.length, found.longest);
    }
    let first = workgroupUniformLoad(&first_of_tile);
    if found.longest > ROWS {
        lists[list].start = (first + before_list(lane)) | CONTIGUOUS;
        if length > LONG {
            longest.lists[atomicAdd(&longest.count, 1u)] = list;
        }
    } else {
        lists[list].start = first + found.rank;
        place_rows(tile, found.longest, lane);
    }
}

// Entries of the lists before one, where they lie one after another.
fn before_list(lane: u32) -> u32 {
    var before = 0u;
    for (var i = 0u; i < lane; i += 1u) {
        before += lengths[i] >> LANE_BITS;
    }
    return before;
}

fn place_rows(tile: u32, count: u32, lane: u32) {
    let told = tiled.items + bin_of(tile).x;
    if lane == 0u {
        rows[tile] = told;
    }
    for (var row = lane; row < count; row += WORKGROUP) {
        var before = vec4(0u);
        for (var i = 0u; i < WORKGROUP; i += 4u) {
            before += min(lengths_from(i) >> vec4(LANE_BITS), vec4(row));
        }
        rows[told + row] = sum(before);
    }
}
