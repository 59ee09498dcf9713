// Fragment path: hands the snapped triangles to the hardware rasteriser, or leaves the
// snapping to it as well.

//#import triangle

struct Placed {
    @builtin(position) position: vec4<f32>,
    @location(0) @interpolate(flat) prim: u32,
}

// Half the guard in sub-pixels, the length 1 of normalised device coordinates, is
// 2^(11 + bits).
const HALF_GUARD_EXPONENT: u32 = 11u;
const_assert GUARD == 2i << HALF_GUARD_EXPONENT;

// 2^-n for n up to 126, from the bits of an f32. WGSL lets a quotient be off by 2.5
// units even where it has an exact value; a bitcast is exact by definition.
fn power_of_half(n: u32) -> f32 {
    return bitcast<f32>((127u - n) << 23u);
}

// The viewport is the guard rectangle: a power of two on a side. So normalised
// device coordinates of grid points are exact: integers of 20 bits, which convert
// exactly, times a power of two, and WGSL rounds a product to the exact value if
// there is one. The driver, which snaps to the same grid or a finer one, neither
// rounds nor clips.
fn placed(prim: u32, number: u32, depth: f32) -> Placed {
    let at = corner(prim, number);
    let middle = (vec2(frame.guard_x, frame.guard_y) + GUARD / 2) << vec2(frame.bits);
    let scale = power_of_half(HALF_GUARD_EXPONENT + frame.bits);
    let ndc = vec2<f32>(at.xy - middle) * vec2(scale, -scale);
    return Placed(vec4(ndc, depth, 1.0), prim);
}

// Depth is not used.
@vertex
fn place(@builtin(vertex_index) index: u32) -> Placed {
    return placed(work[frame.work_first + index / 3u].x, index % 3u, 0.5);
}

// Clip space for the same viewport, three corners a triangle: the driver divides, clips
// and snaps.
@group(0) @binding(12) var<storage, read> handed: array<vec4<f32>>;

@vertex
fn place_handed(@builtin(vertex_index) index: u32) -> Placed {
    let prim = work[frame.work_first + index / 3u].x;
    return Placed(handed[3u * prim + index % 3u], prim);
}
