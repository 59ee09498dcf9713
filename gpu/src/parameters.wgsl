// What the stages of the frame of indirect light are told (spec/src/rsm/parameters.rs).

struct Parameters {
    // Of the picture.
    width: u32,
    height: u32,
    // Of the light's map.
    map_width: u32,
    map_height: u32,
    // Of buffer B.
    coarse_width: u32,
    coarse_height: u32,
    // Texels of a kernel to each side, and from one to the next.
    radius: u32,
    stride: u32,
    // Pixels to one of buffer B, along x and y.
    divisor: u32,
    // Pixels of buffer B to each side that are averaged.
    blur: u32,
    // How far a point is moved off its face.
    offset: u32,
    // How much deeper than the map's a lit point's key may be.
    bias: u32,
    // Least squared distance.
    clamp: f32,
    // Farthest from each other's planes that two points of a surface may be.
    edge: u32,
    // Pixels, texels, pairs or rays of this dispatch.
    items: u32,
    // The first of them, or of a kernel's rows.
    first: u32,
    // Rows of a kernel in this dispatch.
    rows: u32,
    // Reference distance of a spot light.
    reference: f32,
    unused: vec2<u32>,
    strength: vec4<f32>,
    background: vec4<f32>,
}

@group(0) @binding(0) var<uniform> parameters: Parameters;
