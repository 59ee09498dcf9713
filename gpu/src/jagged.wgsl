// Where the fragments of a tile's lists are: as jagged diagonals (Saad 1989), so that neighbouring
// invocations read and write neighbouring words whatever the lists' lengths. Lists are taken longest
// first; row i holds entry i of every list that has one. Nothing is left free between rows, or tiles.
//
// A tile with a list of more than ROWS entries keeps its lists one after another instead. Imported
// where there are `listed` and `opaque_key`.
//#import tile
//#import counter

struct List {
    // Its first entry, and CONTIGUOUS.
    start: u32,
    length: u32,
    // How far it is filled, where that takes several dispatches.
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

// Entries of the longest list of a tile with rows.
const ROWS: u32 = 64u;

// A list as it is read and written.
struct Run {
    start: u32,
    length: u32,
    // Where its tile's rows are, or CONTIGUOUS.
    row: u32,
}

fn run_at(tile: u32, lane: u32) -> Run {
    let list = lists[tile * WORKGROUP + lane];
    let row = select(tile * ROWS, CONTIGUOUS, (list.start & CONTIGUOUS) != 0u);
    return Run(list.start & ~CONTIGUOUS, list.length, row);
}

fn slot(run: Run, i: u32) -> u32 {
    if run.row == CONTIGUOUS {
        return run.start + i;
    }
    return run.start + rows[run.row + i];
}

// No opaque surface: farther than every key.
const NOTHING: u32 = 0xffffffffu;

// A triangle of no more pixels than this in a tile is drawn by the invocation that looks at it.
const SPOT: i32 = 8;

// The larger triangles of a batch, which are drawn by all of a workgroup.
var<workgroup> edges: array<Edges, WORKGROUP>;
var<workgroup> planes: array<Plane, WORKGROUP>;
var<workgroup> batch: atomic<u32>;
var<workgroup> batch_size: u32;

// Of each pixel of a tile: the key from which on fragments are not kept, how many were, where they go.
var<workgroup> ends: array<u32, WORKGROUP>;
var<workgroup> kept: array<atomic<u32>, WORKGROUP>;
var<workgroup> runs: array<Run, WORKGROUP>;

// A tile's triangles of this dispatch.
var<workgroup> bin_bounds: vec2<u32>;

fn end_at(pixel: u32) -> u32 {
    if pixel == NOWHERE {
        return 0u;
    }
    if frame.depth_test == 0u {
        return NOTHING;
    }
    return opaque_key[pixel];
}

// Draws a tile: its fragments are counted, or put in lists. All of a workgroup come along.
fn draw(tile: u32, lane: u32, fill: bool) {
    let list = tile * WORKGROUP + lane;
    let at = vec2<i32>(vec2(lane % SIDE, lane / SIDE));
    let sample = first_sample(tile);
    ends[lane] = end_at(pixel_of(tile, lane));
    if lane == 0u {
        let first = bins[tile] + tiled.first;
        bin_bounds = vec2(first, min(bins[tile + 1u], first + tiled.count));
    }
    var before = 0u;
    if fill {
        runs[lane] = run_at(tile, lane);
    }
    if tiled.first > 0u {
        before = select(lists[list].length, lists[list].filled, fill);
    }
    atomicStore(&kept[lane], before);
    let bin = workgroupUniformLoad(&bin_bounds);
    for (var first = bin.x; first < bin.y; first += WORKGROUP) {
        if lane == 0u {
            atomicStore(&batch, 0u);
        }
        workgroupBarrier();
        if first + lane < bin.y {
            draw_spot(binned[first + lane], sample, fill);
        }
        workgroupBarrier();
        if lane == 0u {
            batch_size = atomicLoad(&batch);
        }
        let size = workgroupUniformLoad(&batch_size);
        for (var i = 0u; i < size; i += 1u) {
            if edges[i].full != 0u || covers(edges[i], at) {
                keep(i, lane, at, fill);
            }
        }
    }
    workgroupBarrier();
    if fill {
        lists[list].filled = atomicLoad(&kept[lane]);
    } else {
        lists[list].length = atomicLoad(&kept[lane]);
    }
}

// A triangle by itself, unless it is larger.
fn draw_spot(prim: u32, sample: vec2<i32>, fill: bool) {
    let s = prepare(prim);
    let own = edges_of(prim, s, sample);
    let spot = spot_of(s, sample);
    if spot.pixels > SPOT {
        let i = atomicAdd(&batch, 1u);
        edges[i] = own;
        if fill || frame.depth_test != 0u {
            planes[i] = plane_of(s, sample);
        }
        return;
    }
    for (var i = 0; i < spot.pixels; i += 1) {
        let at = spot.first + vec2(i % spot.across, i / spot.across);
        if covers(own, at) {
            var key = 0u;
            if fill || frame.depth_test != 0u {
                key = sample_key(own, plane_of(s, sample), at);
            }
            store(u32(at.y) * SIDE + u32(at.x), key, prim, fill);
        }
    }
}

// A fragment of a larger triangle.
fn keep(i: u32, lane: u32, at: vec2<i32>, fill: bool) {
    var key = 0u;
    if fill || frame.depth_test != 0u {
        key = sample_key(edges[i], planes[i], at);
    }
    store(lane, key, edges[i].prim, fill);
}

fn store(pixel: u32, key: u32, prim: u32, fill: bool) {
    if key >= ends[pixel] {
        return;
    }
    let i = atomicAdd(&kept[pixel], 1u);
    if fill {
        let address = slot(runs[pixel], i);
        if address < tiled.capacity {
            listed[address] = vec2(key, prim);
        }
    }
}

// Which kernel of stage shade takes a list: those of up to 8, 16, 32, 64 entries, and of more.
fn kernel_of(length: u32) -> u32 {
    return u32(length > 8u) + u32(length > 16u) + u32(length > 32u) + u32(length > ROWS);
}

var<workgroup> tile_lengths: array<u32, WORKGROUP>;
var<workgroup> first_of_tile: u32;

// All of a workgroup come along. The host has made sure that no sum is beyond SATURATED: a band's
// bins hold at most 2^25 triangles.
fn place_lists(tile: u32, lane: u32) {
    let list = tile * WORKGROUP + lane;
    let length = lists[list].length;
    tile_lengths[lane] = length;
    workgroupBarrier();
    var most = 0u;
    var all = 0u;
    var before = 0u;    // entries of lists before this one
    var rank = 0u;      // lists that are longer, or as long and before it
    var row = 0u;       // entries in rows before row `lane`
    var kernels = 0u;
    for (var i = 0u; i < WORKGROUP; i += 1u) {
        let other = tile_lengths[i];
        most = max(most, other);
        all += other;
        before += select(0u, other, i < lane);
        rank += u32(other > length || (other == length && i < lane));
        row += min(other, lane);
        kernels |= 1u << kernel_of(other);
    }
    if most > ROWS {
        kernels = 1u << kernel_of(most);
    }
    if lane == 0u {
        first_of_tile = atomicAdd(&counter, all);
        atomicMax(&longest.length, most);
        atomicOr(&longest.kernels, kernels);
    }
    let first = workgroupUniformLoad(&first_of_tile);
    if most <= ROWS {
        lists[list].start = first + rank;
        rows[tile * ROWS + lane] = row;
        return;
    }
    lists[list].start = (first + before) | CONTIGUOUS;
    if length > LONG {
        longest.lists[atomicAdd(&longest.count, 1u)] = list;
    }
}
