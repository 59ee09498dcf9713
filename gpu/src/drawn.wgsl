// Fragment path: what the hardware tells of a pixel that a triangle covers, with one sample.

struct Drawn {
    @builtin(position) position: vec4<f32>,
    @location(0) @interpolate(flat) prim: u32,
}

fn fragment_of(drawn: Drawn) -> Fragment {
    let pixel = vec2<u32>(drawn.position.xy);
    return fragment_at(drawn.prim, pixel.x, pixel.y);
}
