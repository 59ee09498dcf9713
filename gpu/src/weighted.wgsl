// Weighted blended order-independent transparency. McGuire and Bavoil 2013.
// Twin: spec/src/abuffer/weighted.rs.

//#import rival

// Equation 10 of the paper.
const WEIGHT_LEAST: f32 = 0.01;
const WEIGHT_MOST: f32 = 3000.0;

// A sum of weights is at least this, 2^-64.
const SUM_LEAST: f32 = 0x1p-64f;

// Five numbers a pixel, by their bits: weighted colour, weights, and what goes through.
const SUMS: u32 = 5u;
@group(0) @binding(13) var<storage, read_write> sums: array<atomic<u32>>;

// What the hardware added up: rows begin at multiples of 256 bytes.
@group(0) @binding(17) var<storage, read> blended: array<vec4<f32>>;
@group(0) @binding(18) var<storage, read> revealed: array<f32>;

// Colour times weight, and the weight.
fn weighed(fragment: Fragment) -> vec4<f32> {
    let layer = faces[fragment.prim];
    let near = f32(0x80000000u - fragment.key) * 0x1p-31f;
    let weight = layer.a * max(WEIGHT_LEAST, WEIGHT_MOST * (near * near * near));
    return layer.a * weight * vec4(layer.rgb, 1.0);
}

// WGSL has no atomic sums of floats: one is tried until nobody came between.
fn add(at: u32, term: f32) {
    var old = atomicLoad(&sums[at]);
    loop {
        let next = bitcast<u32>(bitcast<f32>(old) + term);
        let tried = atomicCompareExchangeWeak(&sums[at], old, next);
        if tried.exchanged {
            break;
        }
        old = tried.old_value;
    }
}

fn reveal(at: u32, through: f32) {
    var old = atomicLoad(&sums[at]);
    loop {
        let next = bitcast<u32>(bitcast<f32>(old) * through);
        let tried = atomicCompareExchangeWeak(&sums[at], old, next);
        if tried.exchanged {
            break;
        }
        old = tried.old_value;
    }
}

@compute @workgroup_size(WORKGROUP)
fn weighted_clear(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= band_pixels() {
        return;
    }
    let at = SUMS * id.x;
    for (var i = 0u; i < 4u; i += 1u) {
        atomicStore(&sums[at + i], 0u);
    }
    atomicStore(&sums[at + 4u], bitcast<u32>(1.0f));
}

// Stage weighted: every fragment in front of the opaque surface, in any order.
@compute @workgroup_size(WORKGROUP)
fn weighted(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= frame.items {
        return;
    }
    var walk = start(id.x);
    while advance(&walk) {
        let fragment = walk.fragment;
        if fragment.key < opaque_key[fragment.pixel] {
            let at = SUMS * fragment.pixel;
            let term = weighed(fragment);
            add(at, term.r);
            add(at + 1u, term.g);
            add(at + 2u, term.b);
            add(at + 3u, term.a);
            reveal(at + 4u, 1.0 - faces[fragment.prim].a);
        }
    }
}

struct Weighed {
    @location(0) term: vec4<f32>,       // added
    @location(1) opacity: vec4<f32>,    // of what is there, 1 less this stays
}

@fragment
fn weighted_fragment(placed: Placed) -> Weighed {
    let pixel = vec2<u32>(placed.position.xy);
    let fragment = fragment_at(placed.prim, pixel.x, pixel.y);
    if fragment.key >= opaque_key[fragment.pixel] {
        discard;
    }
    return Weighed(weighed(fragment), vec4(faces[fragment.prim].a));
}

// The mean colour, over what lies behind it as far as that shows through.
fn mean(pixel: u32, whole: vec4<f32>, through: f32) {
    let colour = whole.rgb / max(whole.a, SUM_LEAST);
    picture[pixel] = vec4(colour * (1.0 - through) + behind(pixel) * through, 1.0);
}

fn sum_at(at: u32) -> f32 {
    return bitcast<f32>(atomicLoad(&sums[at]));
}

@compute @workgroup_size(WORKGROUP)
fn weighted_behind(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= band_pixels() {
        return;
    }
    let at = SUMS * id.x;
    let whole = vec4(sum_at(at), sum_at(at + 1u), sum_at(at + 2u), sum_at(at + 3u));
    mean(id.x, whole, sum_at(at + 4u));
}

@compute @workgroup_size(WORKGROUP)
fn weighted_blended(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= band_pixels() {
        return;
    }
    let row = id.x / frame.width;
    let x = id.x % frame.width;
    let whole = blended[row * ((frame.width + 15u) / 16u * 16u) + x];
    mean(id.x, whole, revealed[row * ((frame.width + 63u) / 64u * 64u) + x]);
}
