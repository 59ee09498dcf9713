// Fragment path: what the hardware tells of a pixel that a triangle covers samples of. An
// invocation stands for all of them; naga's GLSL has no mask as an input, so that one sample,
// which needs none, has drawn.wgsl.

struct Drawn {
    @builtin(position) position: vec4<f32>,
    @location(0) @interpolate(flat) prim: u32,
    @builtin(sample_mask) mask: u32,
}

fn fragment_of(drawn: Drawn) -> Fragment {
    let pixel = vec2<u32>(drawn.position.xy);
    // llvmpipe draws rows beyond a scissor rectangle where pixels have several samples.
    let inside = pixel.y - frame.first_row < frame.rows;
    return fragment_with(drawn.prim, pixel.x, pixel.y, select(0u, drawn.mask, inside));
}
