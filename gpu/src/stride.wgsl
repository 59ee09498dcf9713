// How many invocations share the rows of a triangle. Twin: `stride` in raster/work.rs.
//#import frame
//#import wide

// Columns of its longest row that an invocation walks at most.
const WALKED: u32 = 64u;

// Of a triangle of this height, in sub-pixels, and twice this area: a power of two, and each takes one
// column of so many. Its longest row is twice the area over the height; more than the target's width is
// never shared out.
fn stride_of(double_area: Wide, height: i32) -> u32 {
    let most = wide_mul(height, i32(WALKED << frame.bits));
    var stride = 1u;
    while stride * WALKED < frame.width && wide_less(wide_scale(most, stride), double_area) {
        stride *= 2u;
    }
    return stride;
}
