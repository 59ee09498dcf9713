// A-buffer by tiles: triangles are put in bins, and each tile of the target is drawn by a workgroup.
// Yang et al. 2010, sections 2, 3.1 and 4.1, with other ways to lay lists out. Twin: spec/src/tiles.rs.
//
// Bins and lists are counted, filled and sorted in passes of their own, and read in later ones. A
// pixel's list is written by the one invocation that owns the pixel.
//#import bin
//#import scan
//#import sort
//#import relink

// A fragment in a list: depth key and triangle. Nearest first, ties by triangle.
alias Listed = vec2<u32>;

const LAST: Listed = vec2(0xffffffffu, 0xffffffffu);

fn less(a: Listed, b: Listed) -> bool {
    return a.x < b.x || (a.x == b.x && a.y < b.y);
}

@group(0) @binding(10) var<storage, read_write> picture: array<vec4<f32>>;
@group(0) @binding(12) var<storage, read_write> unfinished: atomic<u32>;
@group(0) @binding(21) var<storage, read_write> opaque_key: array<u32>;
@group(0) @binding(22) var<storage, read_write> opaque_prim: array<u32>;

// No opaque surface: farther than every key.
const NOTHING: u32 = 0xffffffffu;

// The key from which on a pixel's fragments are not kept.
fn end_of(place: Place) -> u32 {
    if place.pixel == NOWHERE {
        return 0u;
    }
    if frame.depth_test == 0u {
        return NOTHING;
    }
    return opaque_key[place.pixel];
}

// Stage bin: one triangle.
@compute @workgroup_size(WORKGROUP)
fn bin_count(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let prim = item(id, groups);
    if prim < tiled.items {
        bin_small(prim, false);
    }
}

@compute @workgroup_size(WORKGROUP)
fn bin_count_large(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    bin_large(chunk_of(group, groups), lane, false);
}

@compute @workgroup_size(WORKGROUP)
fn bin_fill(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let prim = item(id, groups);
    if prim < tiled.items {
        bin_small(prim, true);
    }
}

@compute @workgroup_size(WORKGROUP)
fn bin_fill_large(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    bin_large(chunk_of(group, groups), lane, true);
}

// Of bins or of lists: entries of each part of them.
@compute @workgroup_size(WORKGROUP)
fn bin_parts(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    sum_tile(chunk_of(group, groups), lane, tiled.items);
}

// Entries of all parts before each; one workgroup.
@compute @workgroup_size(WORKGROUP)
fn bin_sums(@builtin(local_invocation_index) lane: u32) {
    sum_tiles(lane, tiled.items);
}

// Where each begins, and the end of the last.
@compute @workgroup_size(WORKGROUP)
fn bin_offsets(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let own = part_of_tile(chunk_of(group, groups), lane, tiled.items);
    var start = own.before;
    for (var i = own.first; i < own.end; i += 1u) {
        offsets[i] = start;
        start = plus(start, atomicLoad(&counts[i]));
        if i + 1u == tiled.items {
            offsets[tiled.items] = start;
        }
    }
}

// Stage blocks: how long the list of each pixel of a tile will be.
@compute @workgroup_size(WORKGROUP)
fn blocks_count(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let tile = chunk_of(group, groups);
    if tile >= tiled.items {
        return;
    }
    let place = place_of(tile, lane);
    let sample = first_sample(tile);
    let end = end_of(place);
    let bin = bin_of(tile, lane);
    var count = 0u;
    for (var first = bin.x; first < bin.y; first += WORKGROUP) {
        let loaded = load(first, bin.y, sample, lane);
        for (var i = 0u; i < loaded; i += 1u) {
            if end > 0u && covers(i, place.at) && (end == NOTHING || key_at(i, place.at) < end) {
                count += 1u;
            }
        }
    }
    let list = tile * WORKGROUP + lane;
    atomicStore(&counts[list], atomicLoad(&counts[list]) + count);
}

// The same lists, filled; counts say how much is left.
@compute @workgroup_size(WORKGROUP)
fn blocks_fill(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let tile = chunk_of(group, groups);
    if tile >= tiled.items {
        return;
    }
    let place = place_of(tile, lane);
    let sample = first_sample(tile);
    let end = end_of(place);
    let bin = bin_of(tile, lane);
    let list = tile * WORKGROUP + lane;
    let stop = offsets[list + 1u];
    var address = stop - atomicLoad(&counts[list]);
    for (var first = bin.x; first < bin.y; first += WORKGROUP) {
        let loaded = load(first, bin.y, sample, lane);
        for (var i = 0u; i < loaded; i += 1u) {
            if end > 0u && covers(i, place.at) {
                let key = key_at(i, place.at);
                if key < end && address < tiled.capacity {
                    listed[address] = vec2(key, edges[i].prim);
                    address += 1u;
                }
            }
        }
    }
    atomicStore(&counts[list], stop - address);
}

// Lists in order; 64 of them.
@compute @workgroup_size(WORKGROUP)
fn blocks_sort(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    sort_lists(chunk_of(group, groups) * WORKGROUP + lane, tiled.items, lane);
}

// The longest lists: runs in order; one entry.
@compute @workgroup_size(WORKGROUP)
fn blocks_runs(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let entry = item(id, groups);
    if entry < tiled.items {
        sort_run(entry, all_lists());
    }
}

// The same: two runs in order become one; one entry.
@compute @workgroup_size(WORKGROUP)
fn blocks_merge(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let entry = item(id, groups);
    if entry < tiled.items {
        merge_runs(entry, all_lists(), tiled.run);
    }
}

fn all_lists() -> u32 {
    return WORKGROUP * tiles_across() * tiles_down();
}

// Stage shade: the sorted list of a pixel over what lies behind it, nearest first. A dispatch goes on
// where the one before stopped: the picture holds the sum so far and the transmittance.
@compute @workgroup_size(WORKGROUP)
fn shade(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let tile = chunk_of(group, groups);
    let place = place_of(tile, lane);
    if tile >= tiled.items || place.pixel == NOWHERE {
        return;
    }
    let list = tile * WORKGROUP + lane;
    let stop = offsets[list + 1u];
    let first = offsets[list] + tiled.first;
    if tiled.first > 0u && first >= stop {
        return;
    }
    var seen = vec4(0.0, 0.0, 0.0, 1.0);
    if tiled.first > 0u {
        seen = picture[place.pixel];
    }
    let last = min(stop, first + tiled.count);
    for (var at = first; at < last; at += 1u) {
        let entry = listed[at];
        if entry.x >= opaque_key[place.pixel] {
            break;
        }
        seen = over(seen, entry.y);
    }
    if last == stop {
        seen = vec4(seen.rgb + seen.a * behind(place.pixel), 1.0);
    }
    picture[place.pixel] = seen;
}

// The next layer under those that were seen.
fn over(seen: vec4<f32>, prim: u32) -> vec4<f32> {
    let layer = faces[prim];
    return vec4(seen.rgb + seen.a * layer.a * layer.rgb, seen.a * (1.0 - layer.a));
}

// What lies behind a pixel's layers.
fn behind(pixel: u32) -> vec3<f32> {
    let prim = opaque_prim[pixel];
    if prim == NOTHING {
        return frame.background.rgb;
    }
    return faces[prim].rgb;
}

// Stage regions: the paper's lists with a counter, and nodes of its own, for each tile.
// Node: depth key, next node, mask and triangle, colour.
@group(0) @binding(23) var<storage, read_write> nodes: array<vec4<u32>>;
@group(0) @binding(24) var<storage, read_write> heads: array<u32>;
// Nodes that each tile asked for.
@group(0) @binding(25) var<storage, read_write> attempts: array<u32>;
// Colour and opacity of each triangle, eight bits each.
@group(0) @binding(26) var<storage, read_write> packed: array<u32>;

const PRIM_BITS: u32 = 24u;

var<workgroup> asked: atomic<u32>;

@compute @workgroup_size(WORKGROUP)
fn regions(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let tile = chunk_of(group, groups);
    if tile >= tiled.items {
        return;
    }
    if lane == 0u {
        atomicStore(&asked, attempts[tile]);
    }
    let place = place_of(tile, lane);
    let sample = first_sample(tile);
    let end = end_of(place);
    let bin = bin_of(tile, lane);
    var head = EOL;
    if place.pixel != NOWHERE {
        head = heads[place.pixel];
    }
    for (var first = bin.x; first < bin.y; first += WORKGROUP) {
        let loaded = load(first, bin.y, sample, lane);
        for (var i = 0u; i < loaded; i += 1u) {
            if end > 0u && covers(i, place.at) {
                let key = key_at(i, place.at);
                if key < end {
                    head = insert(tile, head, key, edges[i].prim);
                }
            }
        }
    }
    if place.pixel != NOWHERE {
        heads[place.pixel] = head;
    }
    workgroupBarrier();
    if lane == 0u {
        attempts[tile] = atomicLoad(&asked);
    }
}

// Section 3's steps for a head that nobody else sees: its new value.
fn insert(tile: u32, head: u32, key: u32, prim: u32) -> u32 {
    let own = atomicAdd(&asked, 1u);
    if own >= tiled.capacity {
        return head;
    }
    let address = tile * tiled.capacity + own;
    nodes[address] = vec4(key, head, (1u << PRIM_BITS) | prim, packed[prim]);
    return address;
}

fn next_of(at: u32) -> u32 {
    return nodes[at].y;
}

fn set_next(at: u32, next: u32) {
    nodes[at].y = next;
}

fn prim_of(node: vec4<u32>) -> u32 {
    return node.z & ((1u << PRIM_BITS) - 1u);
}

// Total order: nearest first, ties by triangle.
fn before(a: u32, b: u32) -> bool {
    return less(vec2(nodes[a].x, prim_of(nodes[a])), vec2(nodes[b].x, prim_of(nodes[b])));
}
