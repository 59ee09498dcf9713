// A-buffer: opaque surfaces, per-pixel linked lists, sort, resolve.
// Yang et al. 2010, sections 3 and 4.1, appendix A. Twin: spec/src/abuffer.rs.
//
// Every list is read in a later pass than the one that writes it: within a pass
// nothing orders a node's payload before the exchange that publishes it.

//#import counter
//#import drawn
//#import place
//#import walk
//#import relink

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

// The key of a fragment at one of its samples.
fn key_of(fragment: Fragment, sample: u32) -> u32 {
    if frame.samples == 1u {
        return fragment.key;
    }
    return key_at(fragment.prim, fragment.pixel, sample, fragment.key);
}

// Stage opaque, first pass: the smallest key at each sample.
fn nearest(fragment: Fragment) {
    for (var s = 0u; s < frame.samples; s += 1u) {
        if (fragment.mask >> s & 1u) != 0u {
            atomicMin(&opaque_key[frame.samples * fragment.pixel + s], key_of(fragment, s));
        }
    }
}

// Second pass: the smallest triangle with that key.
fn first(fragment: Fragment) {
    for (var s = 0u; s < frame.samples; s += 1u) {
        let at = frame.samples * fragment.pixel + s;
        if (fragment.mask >> s & 1u) != 0u && key_of(fragment, s) == atomicLoad(&opaque_key[at]) {
            atomicMin(&opaque_prim[at], fragment.prim);
        }
    }
}

// The samples of a fragment in front of the opaque surfaces there.
fn visible(fragment: Fragment) -> u32 {
    if frame.depth_test == 0u || fragment.mask == 0u {
        return fragment.mask;
    }
    var mask = fragment.mask;
    for (var s = 0u; s < frame.samples; s += 1u) {
        let end = atomicLoad(&opaque_key[frame.samples * fragment.pixel + s]);
        if end != NOTHING && key_of(fragment, s) >= end {
            mask &= ~(1u << s);
        }
    }
    return mask;
}

// Stage build: section 3's three steps. A fragment without an address leaves head
// and nodes alone, so overflow loses fragments, never a list.
fn insert(fragment: Fragment) {
    let mask = visible(fragment);
    if mask == 0u {
        return;
    }
    let address = claim();
    if address >= frame.capacity {
        return;
    }
    let next = atomicExchange(&heads[fragment.pixel], address);
    nodes[address] = Node(fragment.key, next, fragment.prim, mask);
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
fn opaque_nearest_fragment(drawn: Drawn) {
    nearest(fragment_of(drawn));
}

@fragment
fn opaque_first_fragment(drawn: Drawn) {
    first(fragment_of(drawn));
}

@fragment
fn build_fragment(drawn: Drawn) {
    insert(fragment_of(drawn));
}

fn next_of(at: u32) -> u32 {
    return nodes[at].next;
}

fn set_next(at: u32, next: u32) {
    nodes[at].next = next;
}

// Total order: nearest first, ties by triangle.
fn before(a: u32, b: u32) -> bool {
    let x = nodes[a];
    let y = nodes[b];
    return x.key < y.key || (x.key == y.key && x.prim < y.prim);
}

// Pixels that are not done yet ask for another dispatch.
struct Work {
    unfinished: atomic<u32>,
    pixels: array<Progress>,
}

@group(0) @binding(11) var<storage, read_write> progress: Work;

// Stage sort: merges runs of 1, 2, 4, … nodes by relinking them, so that lists of
// any length are sorted in place, in n log n steps. Lists of one are left alone.
@compute @workgroup_size(WORKGROUP)
fn sort(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= band_pixels() {
        return;
    }
    let p = relinked(progress.pixels[id.x], atomicLoad(&heads[id.x]));
    progress.pixels[id.x] = p;
    if p.state == DONE {
        atomicStore(&heads[id.x], p.merged);
    } else {
        atomicStore(&progress.unfinished, 1u);
    }
}

// Stage resolve: the sorted list over what lies behind it, nearest first. Layers
// at or behind the opaque surface are not read. Between dispatches the picture
// holds the sum so far and the transmittance.
@compute @workgroup_size(WORKGROUP)
fn resolve(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= band_pixels() {
        return;
    }
    var p = progress.pixels[id.x];
    var seen = picture[id.x];
    if p.run == 0u {
        p = Progress(EOL, EOL, atomicLoad(&heads[id.x]), EOL, 0u, 0u, 1u, FIND);
        seen = vec4(0.0, 0.0, 0.0, 1.0);
    }
    if p.state == DONE {
        return;
    }
    let end = atomicLoad(&opaque_key[id.x]);
    var i = 0u;
    while i < STEPS && p.left != EOL && nodes[p.left].key < end {
        let layer = colours[p.left];
        seen = vec4(seen.rgb + seen.a * layer.a * layer.rgb, seen.a * (1.0 - layer.a));
        p.left = nodes[p.left].next;
        i += 1u;
    }
    if i == STEPS {
        atomicStore(&progress.unfinished, 1u);
    } else {
        seen = vec4(seen.rgb + seen.a * behind(id.x), 1.0);
        p.state = DONE;
    }
    picture[id.x] = seen;
    progress.pixels[id.x] = p;
}

// What lies behind a pixel's layers.
fn behind(pixel: u32) -> vec3<f32> {
    let prim = atomicLoad(&opaque_prim[pixel]);
    if prim == NOTHING {
        return frame.background.rgb;
    }
    return faces[prim].rgb;
}
