// Grid: lists of triangles in cells, and rays through them (Yang et al. 2010, section 4.2).
// Twin: spec/src/grid.rs.
//
// A list is built in passes of its own and read in later ones; within a pass, invocations
// meet in atomics only.
//#import sweep
//#import counter
//#import runs
//#import scan
//#import search

// Triangles that each cell lists; `fill` counts them down again.
@group(0) @binding(5) var<storage, read_write> counts: array<atomic<u32>>;

// The same, with runs twice as long in order.
@group(0) @binding(8) var<storage, read_write> merged: array<u32>;

// First entry of each cell's linked list, or EOL.
@group(0) @binding(9) var<storage, read_write> heads: array<atomic<u32>>;

struct Entry {
    prim: u32,
    next: u32,
}

@group(0) @binding(10) var<storage, read_write> entries: array<Entry>;

// Entries of each tile of cells, then of all tiles before.
@group(0) @binding(13) var<storage, read_write> sums: array<u32>;

// Cells of an invocation, and of a workgroup, in a scan.
const SCANNED: u32 = 16u;
const TILE: u32 = 1024u;

// Lists up to so long are sorted by one invocation each.
const SHORT: u32 = 64u;

// The number of an invocation, of at most 65,535 workgroups a row.
fn item(id: vec3<u32>, groups: vec3<u32>) -> u32 {
    return id.x + id.y * groups.x * WORKGROUP;
}

// The same of a workgroup.
fn chunk_of(group: vec3<u32>, groups: vec3<u32>) -> u32 {
    return group.x + group.y * groups.x;
}

fn count_cell(way: Sweep) {
    if lists(way) {
        atomicAdd(&counts[number(here(way))], 1u);
    }
}

// One triangle.
@compute @workgroup_size(64)
fn count(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let triangle = item(id, groups);
    if triangle >= cells.items {
        return;
    }
    for (var way = sweep(triangle); way.left > 0u; way = onward(way)) {
        count_cell(way);
    }
}

// One chunk of a large box.
@compute @workgroup_size(64)
fn count_chunks(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let chunk = chunk_of(group, groups);
    if chunk >= cells.items {
        return;
    }
    for (var way = share(chunks[chunk], lane); way.left > 0u; way = onward(way)) {
        count_cell(way);
    }
}

fn counted(first: u32) -> u32 {
    var sum = 0u;
    for (var i = first; i < min(first + SCANNED, cells.items); i += 1u) {
        sum = plus(sum, atomicLoad(&counts[i]));
    }
    return sum;
}

// Entries of each tile of cells.
@compute @workgroup_size(64)
fn scan_tiles(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let own = counted(group.x * TILE + lane * SCANNED);
    let before = parts_before(lane, own);
    if lane == WORKGROUP - 1u {
        sums[group.x] = plus(before, own);
    }
}

// Entries of all tiles before each tile; one workgroup.
@compute @workgroup_size(64)
fn scan_sums(@builtin(local_invocation_index) lane: u32) {
    let tiles = (cells.items + TILE - 1u) / TILE;
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

// Where each cell's run starts, and the end of the last.
@compute @workgroup_size(64)
fn scan(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let first = group.x * TILE + lane * SCANNED;
    let before = parts_before(lane, counted(first));
    var start = plus(sums[group.x], before);
    for (var i = first; i < min(first + SCANNED, cells.items); i += 1u) {
        offsets[i] = start;
        start = plus(start, atomicLoad(&counts[i]));
        if i + 1u == cells.items {
            offsets[cells.items] = start;
        }
    }
}

// Whoever comes first gets the first place: as ids mostly come in order, lists then nearly are.
fn fill_cell(way: Sweep) {
    let cell = number(here(way));
    if lists(way) {
        let address = offsets[cell + 1u] - atomicSub(&counts[cell], 1u);
        if address < cells.capacity {
            prims[address] = way.triangle;
        }
    }
}

// One triangle.
@compute @workgroup_size(64)
fn fill(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let triangle = item(id, groups);
    if triangle >= cells.items {
        return;
    }
    for (var way = sweep(triangle); way.left > 0u; way = onward(way)) {
        fill_cell(way);
    }
}

// One chunk of a large box.
@compute @workgroup_size(64)
fn fill_chunks(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let chunk = chunk_of(group, groups);
    if chunk >= cells.items {
        return;
    }
    for (var way = share(chunks[chunk], lane); way.left > 0u; way = onward(way)) {
        fill_cell(way);
    }
}

// Short lists in order of id; one cell.
@compute @workgroup_size(64)
fn fill_sort(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let cell = item(id, groups);
    if cell >= cells.items {
        return;
    }
    let start = offsets[cell];
    let end = offsets[cell + 1u];
    if end - start > SHORT {
        atomicMax(&unfinished, end - start);
        return;
    }
    for (var i = start + 1u; i < end; i += 1u) {
        let prim = prims[i];
        var at = i;
        while at > start && prims[at - 1u] > prim {
            prims[at] = prims[at - 1u];
            at -= 1u;
        }
        prims[at] = prim;
    }
}

// Long lists: runs of SHORT in order; one entry, whose rank is its place.
@compute @workgroup_size(64)
fn fill_runs(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let entry = item(id, groups);
    if entry >= cells.items {
        return;
    }
    let cell = cell_of(entry);
    let start = offsets[cell];
    let end = offsets[cell + 1u];
    let prim = prims[entry];
    if end - start <= SHORT {
        merged[entry] = prim;
        return;
    }
    let own = start + (entry - start) / SHORT * SHORT;
    merged[own + rank(prim, own, min(own + SHORT, end))] = prim;
}

// The same: two runs in order become one; one entry.
@compute @workgroup_size(64)
fn fill_merge(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let entry = item(id, groups);
    if entry >= cells.items {
        return;
    }
    let cell = cell_of(entry);
    let start = offsets[cell];
    let end = offsets[cell + 1u];
    let prim = prims[entry];
    if end - start <= SHORT {
        merged[entry] = prim;
        return;
    }
    let run = (entry - start) / cells.run;
    let own = start + run * cells.run;
    let pair = start + (run & 0xfffffffeu) * cells.run;
    let other = min(select(pair, pair + cells.run, own == pair), end);
    let smaller = below(prim, other, min(other + cells.run, end));
    merged[pair + (entry - own) + smaller] = prim;
}

// The paper's lists, in whatever order invocations come.
fn link_cell(way: Sweep) {
    if lists(way) {
        let address = claim();
        if address < cells.capacity {
            let next = atomicExchange(&heads[number(here(way))], address);
            entries[address] = Entry(way.triangle, next);
        }
    }
}

// One triangle.
@compute @workgroup_size(64)
fn link(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let triangle = item(id, groups);
    if triangle >= cells.items {
        return;
    }
    for (var way = sweep(triangle); way.left > 0u; way = onward(way)) {
        link_cell(way);
    }
}

// One chunk of a large box.
@compute @workgroup_size(64)
fn link_chunks(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let chunk = chunk_of(group, groups);
    if chunk >= cells.items {
        return;
    }
    for (var way = share(chunks[chunk], lane); way.left > 0u; way = onward(way)) {
        link_cell(way);
    }
}

// Which cells list anything; one brick.
@compute @workgroup_size(64)
fn trace_bricks(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let brick = item(id, groups);
    if brick >= cells.items {
        return;
    }
    bricks[brick] = words_of(brick);
}

// What a ray meets.
@compute @workgroup_size(64)
fn trace(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = item(id, groups);
    if i < cells.items {
        hits[i] = traced(rays[i], hits[i]);
    }
}
