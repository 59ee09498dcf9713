// Plain alpha blending, in the order of the triangles. Twin: spec/src/abuffer/alpha.rs.
//
// The hardware blends in that order by itself. Where a kernel covers the pixels, layers are
// peeled as in peel.wgsl, but in the order of the triangles' numbers.

//#import rival

// Of each pixel, the triangle from which on fragments are left.
@group(0) @binding(13) var<storage, read_write> last: array<u32>;
@group(0) @binding(15) var<storage, read_write> near_prim: array<atomic<u32>>;

// Fragments that were peeled so far.
@group(0) @binding(16) var<storage, read_write> peeled: atomic<u32>;

// What the hardware blended: rows begin at multiples of 256 bytes.
@group(0) @binding(17) var<storage, read> blended: array<vec4<f32>>;
@group(0) @binding(18) var<storage, read> blended_half: array<vec2<u32>>;

@compute @workgroup_size(WORKGROUP)
fn alpha_clear(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= band_pixels() {
        return;
    }
    atomicStore(&near_prim[id.x], NOTHING);
    last[id.x] = 0u;
    picture[id.x] = vec4(0.0, 0.0, 0.0, 1.0);
    if id.x == 0u {
        atomicStore(&peeled, 0u);
    }
}

@compute @workgroup_size(WORKGROUP)
fn alpha_next(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= frame.items {
        return;
    }
    var walk = start(id.x);
    while advance(&walk) {
        let fragment = walk.fragment;
        if fragment.prim >= last[fragment.pixel] && fragment.key < opaque_key[fragment.pixel] {
            atomicMin(&near_prim[fragment.pixel], fragment.prim);
        }
    }
}

// Stage alpha: the next triangle over those before it.
@compute @workgroup_size(WORKGROUP)
fn alpha(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= band_pixels() {
        return;
    }
    let prim = atomicLoad(&near_prim[id.x]);
    if prim == NOTHING {
        return;
    }
    atomicStore(&near_prim[id.x], NOTHING);
    picture[id.x] = over(picture[id.x], prim);
    last[id.x] = prim + 1u;
    atomicAdd(&peeled, 1u);
}

// Blended over what is there, by the fixed function; what goes through is in alpha.
@fragment
fn alpha_fragment(placed: Placed) -> @location(0) vec4<f32> {
    let pixel = vec2<u32>(placed.position.xy);
    let fragment = fragment_at(placed.prim, pixel.x, pixel.y);
    if fragment.key >= opaque_key[fragment.pixel] {
        discard;
    }
    return faces[fragment.prim];
}

// Where a pixel is in a target whose rows begin at multiples of so many.
fn in_rows(pixel: u32, multiple: u32) -> u32 {
    let stride = (frame.width + multiple - 1u) / multiple * multiple;
    return pixel / frame.width * stride + pixel % frame.width;
}

// What the hardware blended is the picture, but for what lies behind.
@compute @workgroup_size(WORKGROUP)
fn alpha_single(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x < band_pixels() {
        picture[id.x] = blended[in_rows(id.x, 16u)];
    }
}

// The number that the low 16 bits of a word are; `unpack2x16float` is not everywhere. Infinity
// and NaN are infinite here: both are in no interval.
fn from_half(word: u32) -> f32 {
    let sign = (word & 0x8000u) << 16u;
    let exponent = (word >> 10u) & 31u;
    let fraction = word & 0x3ffu;
    if exponent == 0u {
        let size = f32(fraction) * 0x1p-24f;
        return select(size, -size, sign != 0u);
    }
    let wide = select(exponent + 112u, 255u, exponent == 31u);
    let digits = select(fraction << 13u, 0u, exponent == 31u);
    return bitcast<f32>(sign | (wide << 23u) | digits);
}

@compute @workgroup_size(WORKGROUP)
fn alpha_half(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x < band_pixels() {
        let words = blended_half[in_rows(id.x, 32u)];
        picture[id.x] = vec4(
            from_half(words.x),
            from_half(words.x >> 16u),
            from_half(words.y),
            from_half(words.y >> 16u),
        );
    }
}

@compute @workgroup_size(WORKGROUP)
fn alpha_behind(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x < band_pixels() {
        over_behind(id.x);
    }
}
