// Grid: lists of triangles in cells, and rays through them (Yang et al. 2010, section 4.2).
// Twin: spec/src/grid.rs.
//
// A list is built in passes of its own and read in later ones; within a pass, invocations
// meet in atomics only.
//#import sweep
//#import counter
//#import scan
//#import sort
//#import search

// First entry of each cell's linked list, or EOL.
@group(0) @binding(9) var<storage, read_write> heads: array<atomic<u32>>;

struct Entry {
    prim: u32,
    next: u32,
}

@group(0) @binding(10) var<storage, read_write> entries: array<Entry>;

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

// Entries of each tile of cells.
@compute @workgroup_size(64)
fn scan_tiles(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    sum_tile(group.x, lane, cells.items);
}

// Entries of all tiles before each tile; one workgroup.
@compute @workgroup_size(64)
fn scan_sums(@builtin(local_invocation_index) lane: u32) {
    sum_tiles(lane, cells.items);
}

// Where each cell's run starts, and the end of the last.
@compute @workgroup_size(64)
fn scan(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let own = part_of_tile(group.x, lane, cells.items);
    var start = own.before;
    for (var i = own.first; i < own.end; i += 1u) {
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
            listed[address] = way.triangle;
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

// Lists in order of id; 64 cells.
@compute @workgroup_size(64)
fn fill_sort(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let run = run_of(chunk_of(group, groups) * WORKGROUP + lane, cells.items);
    sort_lists(Run(run.x, run.y), lane);
}

// The longest lists: runs in order; one entry.
@compute @workgroup_size(64)
fn fill_runs(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let entry = item(id, groups);
    if entry < cells.items {
        let cell = list_of(entry, total_cells());
        sort_run(entry, offsets[cell], offsets[cell + 1u]);
    }
}

// The same: two runs in order become one; one entry.
@compute @workgroup_size(64)
fn fill_merge(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let entry = item(id, groups);
    if entry < cells.items {
        let cell = list_of(entry, total_cells());
        merge_runs(entry, offsets[cell], offsets[cell + 1u], cells.run);
    }
}

fn total_cells() -> u32 {
    return cells.x * cells.y * cells.z;
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
