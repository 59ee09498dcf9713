// LDM: layered depth maps in deterministic directions, and what is seen through them (Aalund et
// al. 2015, sections 3.1 to 3.3 and 5.2). Twin: spec/src/ldm.rs.
//
// Lists are counted, filled and sorted in passes of their own, and read in later ones; within a
// pass, invocations meet in atomics only.
//#import cover
//#import sort
//#import counter
//#import relink
//#import receiver

// First entry of each pixel's linked list, or EOL.
@group(0) @binding(10) var<storage, read_write> heads: array<atomic<u32>>;

struct Link {
    key: u32,
    next: u32,
}

@group(0) @binding(11) var<storage, read_write> nodes: array<Link>;

// Where the sort of each list stands.
@group(0) @binding(12) var<storage, read_write> progress: array<Progress>;

struct Hits {
    // The receiver's own key.
    key: i32,
    // The nearest ones before and behind it, or NOTHING.
    before: u32,
    behind: u32,
}

// For each map of the dispatch, of every receiver.
@group(0) @binding(14) var<storage, read_write> hits: array<Hits>;

struct Open {
    whole: u32,
    part: f32,
}

@group(0) @binding(15) var<storage, read_write> opened: array<Open>;

// Radiance from each map's direction, and from the opposite one; the fourth numbers of these and
// of light are not used.
@group(0) @binding(16) var<storage, read> skies: array<array<vec4<f32>, 2>>;

@group(0) @binding(17) var<storage, read_write> light: array<vec4<f32>>;

// 64 triangles of a map.
@compute @workgroup_size(64)
fn layers_count(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let job = job_of(chunk_of(group, groups), lane);
    let triangle = triangle_of(job);
    for (var number = job.first_map; number < job.end; number += 1u) {
        let map = maps[number];
        let total = look(map, job, triangle, lane, false);
        for (var i = lane; i < total; i += WORKGROUP) {
            let sample = sample_of(map, i);
            if sample.is_covered {
                atomicAdd(&counts[sample.pixel], 1u);
            }
        }
        workgroupBarrier();
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

// 64 triangles of a map: from the end of each run down; after the last, the end has become the
// start.
@compute @workgroup_size(64)
fn layers_fill(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let job = job_of(chunk_of(group, groups), lane);
    let triangle = triangle_of(job);
    for (var number = job.first_map; number < job.end; number += 1u) {
        let map = maps[number];
        let total = look(map, job, triangle, lane, true);
        for (var i = lane; i < total; i += WORKGROUP) {
            let sample = sample_of(map, i);
            if sample.is_covered {
                let address = atomicSub(&counts[sample.pixel], 1u) - 1u;
                if address < told.capacity {
                    listed[address] = key_at(sample);
                }
            }
        }
        workgroupBarrier();
    }
}

// Lists in order; 64 pixels.
@compute @workgroup_size(64)
fn layers_sort(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    sort_lists(chunk_of(group, groups) * WORKGROUP + lane, told.items, lane);
}

// The longest lists: runs in order; one key.
@compute @workgroup_size(64)
fn layers_runs(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let key = item(id, groups);
    if key < told.items {
        sort_run(key, told.pixels);
    }
}

// The same: two runs in order become one; one key.
@compute @workgroup_size(64)
fn layers_merge(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let key = item(id, groups);
    if key < told.items {
        merge_runs(key, told.pixels, told.run);
    }
}

// 64 triangles of a map: the paper's lists, in whatever order invocations come.
@compute @workgroup_size(64)
fn chain(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let job = job_of(chunk_of(group, groups), lane);
    let triangle = triangle_of(job);
    for (var number = job.first_map; number < job.end; number += 1u) {
        let map = maps[number];
        let total = look(map, job, triangle, lane, true);
        for (var i = lane; i < total; i += WORKGROUP) {
            let sample = sample_of(map, i);
            if sample.is_covered {
                let address = claim();
                if address < told.capacity {
                    let next = atomicExchange(&heads[sample.pixel], address);
                    nodes[address] = Link(key_at(sample), next);
                }
            }
        }
        workgroupBarrier();
    }
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
    if i >= told.maps * told.items {
        return;
    }
    let found = neighbours_of(maps[told.first_map + i / told.items], receivers[i % told.items]);
    var own = Hits(found.key, NOTHING, NOTHING);
    if found.before > found.start {
        own.before = listed[found.before - 1u];
    }
    if found.behind < found.end {
        own.behind = listed[found.behind];
    }
    hits[i] = own;
}

// What a hit so many keys away lets pass.
fn passed(keys: u32) -> f32 {
    let part = f32(keys) / f32(told.most);
    var all = part;
    for (var i = 1u; i < told.power; i += 1u) {
        all *= part;
    }
    return all;
}

// A receiver, and all maps of the dispatch; those of the first one start from nothing.
@compute @workgroup_size(64)
fn occlusion(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = item(id, groups);
    if i >= told.items {
        return;
    }
    let receiver = receivers[i];
    var sum = opened[i];
    for (var at = told.first_map; at < told.first_map + told.maps; at += 1u) {
        let map = maps[at];
        let weight = weight_of(map, receiver.normal);
        if weight == 0 {
            continue;
        }
        let size = u32(abs(weight));
        if told.most == 0u {
            sum.whole += select(size, 0u, is_blocked(map, receiver, weight));
            continue;
        }
        let seen = seen_by(map, receiver, weight);
        let keys = u32(abs(i32(seen.hit) - seen.key));
        if seen.hit == NOTHING || keys >= told.most {
            sum.whole += size;
        } else if told.power > 0u {
            sum.part += f32(size) * passed(keys);
        }
    }
    opened[i] = sum;
}

// The same.
@compute @workgroup_size(64)
fn environment(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = item(id, groups);
    if i >= told.items {
        return;
    }
    let receiver = receivers[i];
    var sum = light[i];
    for (var at = told.first_map; at < told.first_map + told.maps; at += 1u) {
        let map = maps[at];
        let weight = weight_of(map, receiver.normal);
        if weight != 0 && !is_blocked(map, receiver, weight) {
            sum += f32(abs(weight)) * skies[at][u32(weight < 0)];
        }
    }
    light[i] = sum;
}
