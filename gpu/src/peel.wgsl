// Depth peeling, layer by layer. Everitt 2001. Twin: spec/src/abuffer/peel.rs.
//
// A layer takes one or two passes over the triangles and one over the pixels. Those that find
// nothing change nothing, so that any number of layers may be recorded at once.

//#import rival
//#import near

// Of each pixel, the key of what was peeled last, and its triangle's number plus 1: from there
// on fragments are left.
@group(0) @binding(13) var<storage, read_write> last: array<vec2<u32>>;

// Fragments that were peeled so far.
@group(0) @binding(16) var<storage, read_write> peeled: atomic<u32>;

fn is_left(fragment: Fragment) -> bool {
    let from_here = last[fragment.pixel];
    let beyond = fragment.key > from_here.x
        || (fragment.key == from_here.x && fragment.prim >= from_here.y);
    return beyond && fragment.key < opaque_key[fragment.pixel];
}

fn nearest(fragment: Fragment) {
    if is_left(fragment) {
        offer(fragment);
    }
}

fn first(fragment: Fragment) {
    if is_left(fragment) {
        settle(fragment);
    }
}

@compute @workgroup_size(WORKGROUP)
fn peel_clear(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= band_pixels() {
        return;
    }
    take(id.x);
    last[id.x] = vec2(0u, 0u);
    picture[id.x] = vec4(0.0, 0.0, 0.0, 1.0);
    if id.x == 0u {
        atomicStore(&peeled, 0u);
    }
}

@compute @workgroup_size(WORKGROUP)
fn peel_nearest(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= frame.items {
        return;
    }
    var walk = start(id.x);
    while advance(&walk) {
        nearest(walk.fragment);
    }
}

@compute @workgroup_size(WORKGROUP)
fn peel_first(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= frame.items {
        return;
    }
    var walk = start(id.x);
    while advance(&walk) {
        first(walk.fragment);
    }
}

@fragment
fn peel_nearest_fragment(placed: Placed) {
    let pixel = vec2<u32>(placed.position.xy);
    nearest(fragment_at(placed.prim, pixel.x, pixel.y));
}

@fragment
fn peel_first_fragment(placed: Placed) {
    let pixel = vec2<u32>(placed.position.xy);
    first(fragment_at(placed.prim, pixel.x, pixel.y));
}

// Stage peel: the layer that was found, under those before it.
@compute @workgroup_size(WORKGROUP)
fn peel(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= band_pixels() {
        return;
    }
    let found = take(id.x);
    if found.y == NOTHING {
        return;
    }
    picture[id.x] = under(picture[id.x], found.y);
    last[id.x] = vec2(found.x, found.y + 1u);
    atomicAdd(&peeled, 1u);
}

@compute @workgroup_size(WORKGROUP)
fn peel_behind(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= band_pixels() {
        return;
    }
    over_behind(id.x);
}
