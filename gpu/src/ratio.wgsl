// Quotients of a triangle's depth, as whole numbers and fractions. M / area, with
// M = eb (zb - za) + ec (zc - za), is what a key lies beyond za: edge functions add up to the area.
//#import triangle

const PART_BITS: u32 = 22u;
const PART_ONE: u32 = 1u << PART_BITS;

// A whole number, modulo 2^32, and a fraction in units of 1 / PART_ONE.
struct Ratio {
    whole: u32,
    part: u32,
    // Whether the fraction is 0.
    is_whole: bool,
    is_known: bool,
}

// How depth changes over a triangle.
struct Slope {
    b: i32,     // zb - za
    c: i32,
    area: Wide,
    size: f32,  // the area, about
}

// (eb b + ec c) / area for |eb| and |ec| up to 8 areas. U = 2^-23.
//
// Edge functions are off by at most 2 U in f32, depths by 1 U, the products by 1 U more and the sum by
// another, all of at most 2^35 areas together: 5 U. The quotient is off by 4.5 U more. That is less
// than 2^16, and 32 are lost to rounding. So the first remainder is under 2^16 areas, and 64 bits hold
// it whatever was lost above them. Its own quotient is off by 6.5 U of it, 0.06: one area more or less
// remains. A fraction is off by 6.5 U, 3.25 units, and 1 more by rounding down.
fn ratio(eb: Wide, ec: Wide, slope: Slope) -> Ratio {
    let b = wide_signed_to_f32(eb);
    let c = wide_signed_to_f32(ec);
    if max(abs(b), abs(c)) > 7.5 * slope.size {
        return Ratio(0u, 0u, false, false);
    }
    let first = i32(about(b, c, slope) * 0.03125);
    var rest = wide_add(wide_times(eb, slope.b), wide_times(ec, slope.c));
    rest = wide_sub(rest, wide_shift(wide_times(slope.area, first), 5u));
    let second = i32(floor(wide_signed_to_f32(rest) / slope.size));
    rest = wide_sub(rest, wide_times(slope.area, second));
    var whole = 32 * first + second;
    if wide_negative(rest) {
        rest = wide_add(rest, slope.area);
        whole -= 1;
    } else if !wide_less(rest, slope.area) {
        rest = wide_sub(rest, slope.area);
        whole += 1;
    }
    let part = u32(wide_to_f32(rest) / slope.size * f32(PART_ONE));
    return Ratio(bitcast<u32>(whole), part, wide_is_zero(rest), true);
}

fn about(b: f32, c: f32, slope: Slope) -> f32 {
    return (b * f32(slope.b) + c * f32(slope.c)) / slope.size;
}

fn slope_of(s: Setup) -> Slope {
    return Slope(s.b.z - s.a.z, s.c.z - s.a.z, s.area, wide_to_f32(s.area));
}

// About the key at a point, which the triangle need not cover: within those of its corners.
fn key_about(s: Setup, point: vec2<i32>) -> f32 {
    let b = wide_signed_to_f32(edge(s.c, s.a, point));
    let c = wide_signed_to_f32(edge(s.a, s.b, point));
    let z = vec3(f32(s.a.z), f32(s.b.z), f32(s.c.z));
    return clamp(z.x + about(b, c, slope_of(s)), min(z.x, min(z.y, z.z)), max(z.x, max(z.y, z.z)));
}
