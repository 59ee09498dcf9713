// Depth keys of samples in a triangle.
//#import wide

// floor(sum(E_i Z_i) / area) for E_i >= 0 with sum(E_i) = area.
//
// The numerator has up to 72 bits, but residuals are small, so 64 suffice. With
// U = 2^-23: the numerator in f32 is off by at most 6 U (conversions 2 + 1,
// product 1, sums 2), the area by 2 U, the quotient by 2.5 U, the product with
// LOWER by 1 U: together under 2^-19.4, less than the 2^-19 that LOWER takes off.
// An estimate is therefore never too large, and too small by at most
// q (2^-19 + 2^-19.4) + 1: after the first, whose q is below 2^31, the residual is
// under 2^13 areas (54 bits); after the second it is under 1.03; one subtraction
// remains.
const LOWER: f32 = 1.0 - 1.0 / 524288.0;

fn depth_key(z: vec3<u32>, area: Wide, ea: Wide, eb: Wide, ec: Wide) -> u32 {
    let size = wide_to_f32(area);
    let numerator = wide_to_f32(ea) * f32(z.x) + wide_to_f32(eb) * f32(z.y) + wide_to_f32(ec) * f32(z.z);
    var rest = wide_add(wide_add(wide_scale(ea, z.x), wide_scale(eb, z.y)), wide_scale(ec, z.z));
    let first = u32(numerator / size * LOWER);
    rest = wide_sub(rest, wide_scale(area, first));
    let second = u32(wide_to_f32(rest) / size * LOWER);
    rest = wide_sub(rest, wide_scale(area, second));
    if wide_less(rest, area) {
        return first + second;
    }
    return first + second + 1u;
}
