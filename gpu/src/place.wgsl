// Fragment path: hands the snapped triangles to the hardware rasteriser.

//#import triangle

struct Placed {
    @builtin(position) position: vec4<f32>,
    @location(0) @interpolate(flat) prim: u32,
}

// The viewport is the guard rectangle: a power of two on a side, so normalised
// device coordinates of grid points are exact, and the driver, which snaps to the
// same grid or a finer one, neither rounds nor clips. Depth is not used.
@vertex
fn place(@builtin(vertex_index) index: u32) -> Placed {
    let prim = work[frame.work_first + index / 3u].x;
    let at = corner(prim, index % 3u);
    let middle = (vec2(frame.guard_x, frame.guard_y) + GUARD / 2) << vec2(frame.bits);
    let scale = 2.0 / f32(GUARD << frame.bits);
    let ndc = vec2<f32>(at.xy - middle) * vec2(scale, -scale);
    return Placed(vec4(ndc, 0.5, 1.0), prim);
}
