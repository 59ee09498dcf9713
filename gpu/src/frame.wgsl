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

fn band_pixels() -> u32 {
    return frame.width * frame.rows;
}
