// A-buffer: opaque surfaces, per-pixel linked lists, sort, resolve.
// Yang et al. 2010, sections 3 and 4.1, appendix A. Twin: spec/src/abuffer.rs.
//
// Every list is read in a later pass than the one that writes it: within a pass
// nothing orders a node's payload before the exchange that publishes it.

//#import counter
//#import place
//#import walk

// End of a list, and an empty list's head.
const EOL: u32 = 0xffffffffu;
// No opaque surface: farther than every key.
const NOTHING: u32 = 0xffffffffu;

struct Node {
    key: u32,
    next: u32,
    prim: u32,
    mask: u32,
}

@group(0) @binding(5) var<storage, read_write> opaque_key: array<atomic<u32>>;
@group(0) @binding(6) var<storage, read_write> opaque_prim: array<atomic<u32>>;
@group(0) @binding(7) var<storage, read_write> heads: array<atomic<u32>>;
@group(0) @binding(8) var<storage, read_write> nodes: array<Node>;
@group(0) @binding(9) var<storage, read_write> colours: array<vec4<f32>>;
@group(0) @binding(10) var<storage, read_write> picture: array<vec4<f32>>;

// Stage opaque, first pass: the smallest key.
fn nearest(fragment: Fragment) {
    atomicMin(&opaque_key[fragment.pixel], fragment.key);
}

// Second pass: the smallest triangle with that key.
fn first(fragment: Fragment) {
    if fragment.key == atomicLoad(&opaque_key[fragment.pixel]) {
        atomicMin(&opaque_prim[fragment.pixel], fragment.prim);
    }
}

// Stage build: section 3's three steps. A fragment without an address leaves head
// and nodes alone, so overflow loses fragments, never a list.
fn insert(fragment: Fragment) {
    if frame.depth_test != 0u && fragment.key >= atomicLoad(&opaque_key[fragment.pixel]) {
        return;
    }
    let address = claim();
    if address >= frame.capacity {
        return;
    }
    let next = atomicExchange(&heads[fragment.pixel], address);
    nodes[address] = Node(fragment.key, next, fragment.prim, fragment.mask);
    colours[address] = faces[fragment.prim];
}

@compute @workgroup_size(WORKGROUP)
fn opaque_nearest(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= frame.items {
        return;
    }
    var walk = start(id.x);
    while advance(&walk) {
        nearest(walk.fragment);
    }
}

@compute @workgroup_size(WORKGROUP)
fn opaque_first(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= frame.items {
        return;
    }
    var walk = start(id.x);
    while advance(&walk) {
        first(walk.fragment);
    }
}

@compute @workgroup_size(WORKGROUP)
fn build(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= frame.items {
        return;
    }
    var walk = start(id.x);
    while advance(&walk) {
        insert(walk.fragment);
    }
}

@fragment
fn opaque_nearest_fragment(placed: Placed) {
    let pixel = vec2<u32>(placed.position.xy);
    nearest(fragment_at(placed.prim, pixel.x, pixel.y));
}

@fragment
fn opaque_first_fragment(placed: Placed) {
    let pixel = vec2<u32>(placed.position.xy);
    first(fragment_at(placed.prim, pixel.x, pixel.y));
}

@fragment
fn build_fragment(placed: Placed) {
    let pixel = vec2<u32>(placed.position.xy);
    insert(fragment_at(placed.prim, pixel.x, pixel.y));
}

// Total order: nearest first, ties by triangle.
fn before(a: u32, b: u32) -> bool {
    let x = nodes[a];
    let y = nodes[b];
    return x.key < y.key || (x.key == y.key && x.prim < y.prim);
}

// Stage sort: merges runs of 1, 2, 4, … nodes by relinking them, so that lists of
// any length are sorted in place, in n log n steps. Lists of one are left alone.
// No list is longer than the capacity: a longer walk is a damaged list, and is
// left for the comparison to find rather than followed for ever.
@compute @workgroup_size(WORKGROUP)
fn sort(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= band_pixels() {
        return;
    }
    var head = atomicLoad(&heads[id.x]);
    let length = length_of(head);
    if length > frame.capacity {
        return;
    }
    for (var run = 1u; run < length; run *= 2u) {
        head = merge_runs(head, run);
    }
    atomicStore(&heads[id.x], head);
}

// Number of nodes, or capacity + 1 for a list that does not end.
fn length_of(head: u32) -> u32 {
    var length = 0u;
    for (var at = head; at != EOL && length <= frame.capacity; at = nodes[at].next) {
        length += 1u;
    }
    return length;
}

// Merges neighbouring sorted runs of a list pairwise; gives the new head.
fn merge_runs(head: u32, run: u32) -> u32 {
    var merged = EOL;
    var tail = EOL;
    var left = head;
    while left != EOL {
        var right = left;
        var left_size = 0u;
        while left_size < run && right != EOL {
            right = nodes[right].next;
            left_size += 1u;
        }
        var right_size = run;
        while left_size > 0u || (right_size > 0u && right != EOL) {
            var taken = left;
            if left_size == 0u || (right_size > 0u && right != EOL && before(right, left)) {
                taken = right;
                right = nodes[right].next;
                right_size -= 1u;
            } else {
                left = nodes[left].next;
                left_size -= 1u;
            }
            if tail == EOL {
                merged = taken;
            } else {
                nodes[tail].next = taken;
            }
            tail = taken;
        }
        left = right;
    }
    nodes[tail].next = EOL;
    return merged;
}

// Stage resolve: the sorted list over what lies behind it, nearest first. Layers
// at or behind the opaque surface are not read.
@compute @workgroup_size(WORKGROUP)
fn resolve(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= band_pixels() {
        return;
    }
    var behind = frame.background.rgb;
    let prim = atomicLoad(&opaque_prim[id.x]);
    if prim != NOTHING {
        behind = faces[prim].rgb;
    }
    let end = atomicLoad(&opaque_key[id.x]);
    var sum = vec3(0.0);
    var transmittance = 1.0;
    var steps = 0u;
    var at = atomicLoad(&heads[id.x]);
    while at != EOL && nodes[at].key < end && steps < frame.capacity {
        let layer = colours[at];
        sum += transmittance * layer.a * layer.rgb;
        transmittance *= 1.0 - layer.a;
        at = nodes[at].next;
        steps += 1u;
    }
    picture[id.x] = vec4(sum + transmittance * behind, 1.0);
}
