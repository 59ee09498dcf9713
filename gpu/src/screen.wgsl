// What an eye sees, in view space: x right, y down, z away from the viewer, in lattice steps.

struct Sight {
    width: u32,
    height: u32,
    slices: u32,
    // On either side of a slice.
    steps: u32,
    // Pixels of a step, for a perspective at depth 1; and steps of a pixel.
    scale: vec2<f32>,
    inverse: vec2<f32>,
    // 1: a perspective from the origin, 0: orthographic.
    near: u32,
    power: u32,
    // From which distance on nothing blocks; 0: whatever is met does.
    most: f32,
    // A sample 2^k pixels away is read from level k - detail.
    detail: u32,
    // Invocations of a dispatch.
    items: u32,
    // Where the levels of the pyramid begin.
    firsts: array<vec4<u32>, 2>,
}

@group(0) @binding(0) var<uniform> told: Sight;
// Unit normals, and depths; a normal of zero where nothing is seen.
@group(0) @binding(1) var<storage, read> seen: array<vec4<f32>>;
// For each of 16 pixels, its slices: cosine and sine, and where in its part a step is.
@group(0) @binding(2) var<storage, read> turns: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read_write> pyramid: array<f32>;
// The same, when it is only read.
@group(0) @binding(4) var<storage, read> depths: array<f32>;
@group(0) @binding(5) var<storage, read_write> opened: array<f32>;
@group(0) @binding(6) var<storage, read> rough: array<f32>;

const LEVELS: u32 = 8u;

// Deeper than anything.
const NOWHERE: f32 = 3e38;

fn size() -> vec2<u32> {
    return vec2(told.width, told.height);
}

fn first(level: u32) -> u32 {
    return told.firsts[level / 4u][level % 4u];
}

// The pixel whose depth a texel of a level has: each sample is a point that is seen, not a mean
// of several, which may lie where nothing is.
fn chosen(texel: vec2<u32>, level: u32) -> vec2<u32> {
    return min((texel << vec2(level)) + ((1u << level) >> 1u), size() - 1u);
}

// Texels of a level along a side.
fn levelled(side: u32, level: u32) -> u32 {
    return ((side - 1u) >> level) + 1u;
}

fn is_nothing(surface: vec4<f32>) -> bool {
    return all(surface.xyz == vec3(0.0));
}

// The point in the middle of a pixel.
fn point(pixel: vec2<u32>, depth: f32) -> vec3<f32> {
    let off = (vec2<f32>(pixel) + 0.5 - 0.5 * vec2<f32>(size())) * told.inverse;
    return vec3(off * select(1.0, depth, told.near == 1u), depth);
}
