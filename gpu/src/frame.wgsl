// What every kernel of a frame is told. Twin: `Frame` in frame.rs.
//#import item

struct Frame {
    width: u32,         // of the target, pixels
    height: u32,
    bits: u32,          // of the sub-pixel grid
    capacity: u32,      // nodes
    first_row: u32,     // of the band
    rows: u32,          // in the band
    work_first: u32,    // of the batch, in `work`
    work_count: u32,
    items: u32,         // walks over rows of triangles in the batch
    guard_x: i32,       // first column of the guard rectangle, pixels
    guard_y: i32,
    depth_test: u32,    // 0: fragments behind opaque surfaces are kept
    background: vec4<f32>,
    samples: u32,       // of a pixel
    sample: u32,        // whose turn it is, in kernels for one sample
    order: u32,         // 1: layers lie by their keys at each sample, 0: by those of the list
    once: u32,          // 1: pixels whose samples are all alike are shaded once
    places: array<vec4<u32>, 2>,    // right + down * 2^16 of each sample, in sub-pixels
}

@group(0) @binding(0) var<uniform> frame: Frame;

// Side of the guard rectangle, pixels.
const GUARD: i32 = 4096;

// Columns of a row that an invocation walks at most.
const WALKED: u32 = 64u;

// How many invocations share each row of a triangle that lies between two sub-pixels; each takes one
// column of so many. A power of two, and 0 if no column of the target is between them. Twin: `stride`
// in raster/work.rs.
fn stride_of(low: i32, high: i32) -> u32 {
    let begin = clamp(low >> frame.bits, 0, i32(frame.width));
    let end = clamp((high >> frame.bits) + 1, 0, i32(frame.width));
    if end <= begin {
        return 0u;
    }
    return 1u << (32u - countLeadingZeros((u32(end - begin) - 1u) / WALKED));
}

fn band_pixels() -> u32 {
    return frame.width * frame.rows;
}
