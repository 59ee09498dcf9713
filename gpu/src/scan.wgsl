// Sums of counts before each, by workgroups. An invocation takes SCANNED of them, a workgroup a
// tile; sums of tiles are summed up by one workgroup, in between.
//#import item

// Entries of each list; whoever fills the lists may count them down again.
@group(0) @binding(5) var<storage, read_write> counts: array<atomic<u32>>;

// Entries of each tile of lists, then of all tiles before.
@group(0) @binding(13) var<storage, read_write> sums: array<u32>;

const SCANNED: u32 = 16u;
const TILE: u32 = 1024u;

// Sums that saturate, so that too many entries are seen to be too many.
fn plus(a: u32, b: u32) -> u32 {
    return select(a + b, 0xffffffffu, a + b < a);
}

var<workgroup> parts: array<u32, 64>;

// The sum of all parts before an invocation's own. All of a workgroup come along.
fn parts_before(lane: u32, part: u32) -> u32 {
    parts[lane] = part;
    workgroupBarrier();
    for (var reach = 1u; reach < WORKGROUP; reach *= 2u) {
        let sum = plus(parts[lane], select(0u, parts[max(lane, reach) - reach], lane >= reach));
        workgroupBarrier();
        parts[lane] = sum;
        workgroupBarrier();
    }
    return select(0u, parts[max(lane, 1u) - 1u], lane > 0u);
}

// Counts of an invocation.
struct Part {
    first: u32,
    end: u32,
    // The sum of all counts before the first.
    before: u32,
}

fn counted(first: u32, items: u32) -> u32 {
    var sum = 0u;
    for (var i = first; i < min(first + SCANNED, items); i += 1u) {
        sum = plus(sum, atomicLoad(&counts[i]));
    }
    return sum;
}

// The sum of a tile.
fn sum_tile(tile: u32, lane: u32, items: u32) {
    let own = counted(tile * TILE + lane * SCANNED, items);
    let before = parts_before(lane, own);
    if lane == WORKGROUP - 1u && tile * TILE < items {
        sums[tile] = plus(before, own);
    }
}

// The sum of all tiles before each tile; one workgroup.
fn sum_tiles(lane: u32, items: u32) {
    let tiles = (items + TILE - 1u) / TILE;
    let share = (tiles + WORKGROUP - 1u) / WORKGROUP;
    let first = lane * share;
    let end = min(first + share, tiles);
    var own = 0u;
    for (var tile = first; tile < end; tile += 1u) {
        own = plus(own, sums[tile]);
    }
    var before = parts_before(lane, own);
    for (var tile = first; tile < end; tile += 1u) {
        let tile_sum = sums[tile];
        sums[tile] = before;
        before = plus(before, tile_sum);
    }
}

// An invocation's counts of a tile, after both.
fn part_of_tile(tile: u32, lane: u32, items: u32) -> Part {
    let first = tile * TILE + lane * SCANNED;
    let before = parts_before(lane, counted(first, items));
    return Part(first, min(first + SCANNED, items), plus(sums[tile], before));
}
