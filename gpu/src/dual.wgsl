// Dual depth peeling, from both ends at once. Bavoil and Myers 2008.
// Twin: spec/src/abuffer/dual.rs.

//#import rival

// Of each pixel, where fragments are left: from a key and a triangle on, and before others.
@group(0) @binding(13) var<storage, read_write> between: array<vec4<u32>>;

// Four words a pixel: the smallest key, the smallest triangle with it, the largest key, the
// largest triangle with that.
@group(0) @binding(14) var<storage, read_write> ends: array<atomic<u32>>;

// The back halves, each over what lies behind it.
@group(0) @binding(15) var<storage, read_write> back: array<vec4<f32>>;

// Fragments that were peeled so far.
@group(0) @binding(16) var<storage, read_write> peeled: atomic<u32>;

fn is_left(fragment: Fragment) -> bool {
    let ends = between[fragment.pixel];
    let from_front = fragment.key > ends.x || (fragment.key == ends.x && fragment.prim >= ends.y);
    let from_back = fragment.key < ends.z || (fragment.key == ends.z && fragment.prim < ends.w);
    return from_front && from_back;
}

fn nearest(fragment: Fragment) {
    if is_left(fragment) {
        atomicMin(&ends[4u * fragment.pixel], fragment.key);
        atomicMax(&ends[4u * fragment.pixel + 2u], fragment.key);
    }
}

fn first(fragment: Fragment) {
    let at = 4u * fragment.pixel;
    if !is_left(fragment) {
        return;
    }
    if fragment.key == atomicLoad(&ends[at]) {
        atomicMin(&ends[at + 1u], fragment.prim);
    }
    if fragment.key == atomicLoad(&ends[at + 2u]) {
        atomicMax(&ends[at + 3u], fragment.prim);
    }
}

// What was found, if anything, and nothing from now on.
fn take(pixel: u32) -> vec4<u32> {
    let at = 4u * pixel;
    let found = vec4(
        atomicLoad(&ends[at]),
        atomicLoad(&ends[at + 1u]),
        atomicLoad(&ends[at + 2u]),
        atomicLoad(&ends[at + 3u]),
    );
    atomicStore(&ends[at], NOTHING);
    atomicStore(&ends[at + 1u], NOTHING);
    atomicStore(&ends[at + 2u], 0u);
    atomicStore(&ends[at + 3u], 0u);
    return found;
}

@compute @workgroup_size(WORKGROUP)
fn dual_clear(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= band_pixels() {
        return;
    }
    take(id.x);
    between[id.x] = vec4(0u, 0u, opaque_key[id.x], 0u);
    picture[id.x] = vec4(0.0, 0.0, 0.0, 1.0);
    back[id.x] = vec4(behind(id.x), 1.0);
    if id.x == 0u {
        atomicStore(&peeled, 0u);
    }
}

@compute @workgroup_size(WORKGROUP)
fn dual_nearest(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= frame.items {
        return;
    }
    var walk = start(id.x);
    while advance(&walk) {
        nearest(walk.fragment);
    }
}

@compute @workgroup_size(WORKGROUP)
fn dual_first(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= frame.items {
        return;
    }
    var walk = start(id.x);
    while advance(&walk) {
        first(walk.fragment);
    }
}

@fragment
fn dual_nearest_fragment(placed: Placed) {
    let pixel = vec2<u32>(placed.position.xy);
    nearest(fragment_at(placed.prim, pixel.x, pixel.y));
}

@fragment
fn dual_first_fragment(placed: Placed) {
    let pixel = vec2<u32>(placed.position.xy);
    first(fragment_at(placed.prim, pixel.x, pixel.y));
}

// Stage dual: the nearest under those before it, the farthest over those behind it; one
// fragment that is both, once.
@compute @workgroup_size(WORKGROUP)
fn dual(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= band_pixels() {
        return;
    }
    let found = take(id.x);
    if found.y == NOTHING {
        return;
    }
    picture[id.x] = under(picture[id.x], found.y);
    let two = found.y != found.w;
    if two {
        back[id.x] = over(back[id.x], found.w);
    }
    between[id.x] = vec4(found.x, found.y + 1u, found.z, found.w);
    atomicAdd(&peeled, select(1u, 2u, two));
}

@compute @workgroup_size(WORKGROUP)
fn dual_behind(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= band_pixels() {
        return;
    }
    let seen = picture[id.x];
    picture[id.x] = vec4(seen.rgb + seen.a * back[id.x].rgb, 1.0);
}
