// LDM: layered depth maps in deterministic directions, and what is seen through them (Aalund et
// al. 2015, sections 3.1 to 3.3 and 5.2). Twin: spec/src/ldm.rs.
//
// Lists are counted, filled and sorted in passes of their own, and read in later ones; within a
// pass, invocations meet in atomics only.
//#import cover
//#import scan
//#import sort
//#import counter
//#import relink
//#import opened
//#import mirror

// First entry of each pixel's linked list, or EOL.
@group(0) @binding(10) var<storage, read_write> heads: array<atomic<u32>>;

struct Link {
    key: u32,
    next: u32,
}

@group(0) @binding(11) var<storage, read_write> nodes: array<Link>;

// Where the sort of each list stands.
@group(0) @binding(12) var<storage, read_write> progress: array<Progress>;

// One triangle: whether it is large.
@compute @workgroup_size(64)
fn layers_larges(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let triangle = item(id, groups);
    if triangle < told.items {
        if is_large(triangle_of(triangle)) {
            larges[atomicAdd(&unfinished, 1u)] = triangle;
        }
    }
}

// Counts a triangle in every pixel that it covers, from the first of its box on and `stride` apart.
fn count_pixels(map: Map, cover: Cover, first: u32, stride: u32) {
    for (var at = first; at < cover.pixels; at += stride) {
        let sample = sample_of(map, cover, at);
        if sample.is_covered {
            atomicAdd(&counts[sample.pixel], 1u);
        }
    }
}

// Lists a triangle's keys likewise, from the end of each run down; after the last, the end has become
// the start.
fn fill_pixels(map: Map, cover: Cover, first: u32, stride: u32) {
    for (var at = first; at < cover.pixels; at += stride) {
        let sample = sample_of(map, cover, at);
        if sample.is_covered {
            let address = atomicSub(&counts[sample.pixel], 1u) - 1u;
            if address < told.capacity {
                listed[address] = key_at(cover, sample);
            }
        }
    }
}

// Links a triangle's keys likewise, in whatever order invocations come.
fn chain_pixels(map: Map, cover: Cover, first: u32, stride: u32) {
    for (var at = first; at < cover.pixels; at += stride) {
        let sample = sample_of(map, cover, at);
        if sample.is_covered {
            let address = claim();
            if address < told.capacity {
                let next = atomicExchange(&heads[sample.pixel], address);
                nodes[address] = Link(key_at(cover, sample), next);
            }
        }
    }
}

// 64 small triangles and some maps.
@compute @workgroup_size(64)
fn layers_count(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let job = small_job(chunk_of(group, groups));
    find_pairs(job, lane);
    for (var i = lane; i < atomicLoad(&all_pairs); i += WORKGROUP) {
        let map = map_of(job, pairs[i]);
        count_pixels(map, small_cover(map, job, pairs[i], false), 0u, 1u);
    }
}

// Large triangles and a map.
@compute @workgroup_size(64)
fn layers_count_large(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let job = large_job(chunk_of(group, groups));
    let count = hold(job, lane, false);
    let map = maps[told.first_map + job.map];
    for (var i = 0u; i < count; i += 1u) {
        count_pixels(map, held[i], lane, WORKGROUP);
    }
}

// Keys of each tile of pixels.
@compute @workgroup_size(64)
fn layers_tiles(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    sum_tile(chunk_of(group, groups), lane, told.items);
}

// Keys of all tiles before each tile; one workgroup.
@compute @workgroup_size(64)
fn layers_sums(@builtin(local_invocation_index) lane: u32) {
    sum_tiles(lane, told.items);
}

// Where each pixel's run ends, in place of its count.
@compute @workgroup_size(64)
fn layers_ends(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let own = part_of_tile(chunk_of(group, groups), lane, told.items);
    var end = own.before;
    for (var i = own.first; i < own.end; i += 1u) {
        end = plus(end, atomicLoad(&counts[i]));
        atomicStore(&counts[i], end);
        if i + 1u == told.items {
            atomicStore(&counts[told.items], end);
        }
    }
}

// 64 small triangles and some maps.
@compute @workgroup_size(64)
fn layers_fill(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let job = small_job(chunk_of(group, groups));
    find_pairs(job, lane);
    for (var i = lane; i < atomicLoad(&all_pairs); i += WORKGROUP) {
        let map = map_of(job, pairs[i]);
        fill_pixels(map, small_cover(map, job, pairs[i], true), 0u, 1u);
    }
}

// Large triangles and a map.
@compute @workgroup_size(64)
fn layers_fill_large(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let job = large_job(chunk_of(group, groups));
    let count = hold(job, lane, true);
    let map = maps[told.first_map + job.map];
    for (var i = 0u; i < count; i += 1u) {
        fill_pixels(map, held[i], lane, WORKGROUP);
    }
}

// Lists in order; 64 pixels.
@compute @workgroup_size(64)
fn layers_sort(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let run = run_of(chunk_of(group, groups) * WORKGROUP + lane, told.items);
    sort_lists(Run(run.x, run.y), lane);
}

// The longest lists: runs in order; one key.
@compute @workgroup_size(64)
fn layers_runs(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let key = item(id, groups);
    if key < told.items {
        let pixel = list_of(key, told.pixels);
        sort_run(key, offsets[pixel], offsets[pixel + 1u]);
    }
}

// The same: two runs in order become one; one key.
@compute @workgroup_size(64)
fn layers_merge(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let key = item(id, groups);
    if key < told.items {
        let pixel = list_of(key, told.pixels);
        merge_runs(key, offsets[pixel], offsets[pixel + 1u], told.run);
    }
}

// The paper's lists; 64 small triangles and some maps.
@compute @workgroup_size(64)
fn chain(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let job = small_job(chunk_of(group, groups));
    find_pairs(job, lane);
    for (var i = lane; i < atomicLoad(&all_pairs); i += WORKGROUP) {
        let map = map_of(job, pairs[i]);
        chain_pixels(map, small_cover(map, job, pairs[i], true), 0u, 1u);
    }
}

// Large triangles and a map.
@compute @workgroup_size(64)
fn chain_large(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let job = large_job(chunk_of(group, groups));
    let count = hold(job, lane, true);
    let map = maps[told.first_map + job.map];
    for (var i = 0u; i < count; i += 1u) {
        chain_pixels(map, held[i], lane, WORKGROUP);
    }
}

fn next_of(at: u32) -> u32 {
    return nodes[at].next;
}

fn set_next(at: u32, next: u32) {
    nodes[at].next = next;
}

fn before(a: u32, b: u32) -> bool {
    return nodes[a].key < nodes[b].key;
}

// One pixel's list in order.
@compute @workgroup_size(64)
fn chain_sort(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let pixel = item(id, groups);
    if pixel >= told.items {
        return;
    }
    let p = relinked(progress[pixel], atomicLoad(&heads[pixel]));
    progress[pixel] = p;
    if p.state == DONE {
        atomicStore(&heads[pixel], p.merged);
    } else {
        atomicStore(&unfinished, 1u);
    }
}

// A receiver in a map.
@compute @workgroup_size(64)
fn neighbours(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = item(id, groups);
    if i < told.maps * told.items {
        find_neighbours(i);
    }
}

// A receiver, and all maps of the dispatch.
@compute @workgroup_size(64)
fn occlusion(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = item(id, groups);
    if i < told.items {
        add_open(i);
    }
}

// The same.
@compute @workgroup_size(64)
fn environment(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = item(id, groups);
    if i < told.items {
        add_light(i);
    }
}

// The same.
@compute @workgroup_size(64)
fn mirror(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = item(id, groups);
    if i < told.items {
        add_mirror(i);
    }
}
