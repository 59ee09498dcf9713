// Depth keys of a tile's samples, by steps. A key is za + floor(M / area), with
// M = eb (zb - za) + ec (zc - za), as the edge functions of a sample add up to the area; from one
// sample to the next, M / area changes by a number that is the same all over the triangle. So
// quotients are taken once for a tile, at its first sample and for a step to the right and down: a
// whole number, modulo 2^32, and a fraction in units of 2^-22. A sample adds them up.
//
// A fraction is off by less than 4.25 units (`ratio`), a sum of 15 of them by less than 64. A sum that
// is no nearer than that to a whole number rounds down as the exact one does; at others the caller
// takes the exact key.
//#import triangle

const PART_BITS: u32 = 22u;
const PART_ONE: u32 = 1u << PART_BITS;

// For the first sample, a step to the right, a step down.
struct Steps {
    whole: vec3<u32>,
    // How near to a whole number a sum may not be; PART_ONE where no sum is known.
    margin: u32,
    part: vec3<u32>,
}

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

// Of a triangle, from its sample at `sample` on; `right` and `down` are the changes of its edge
// functions from pixel to pixel, in sub-pixels.
fn steps_of(s: Setup, sample: vec2<i32>, right: vec3<i32>, down: vec3<i32>) -> Steps {
    let slope = slope_of(s);
    let first = ratio(edge(s.c, s.a, sample), edge(s.a, s.b, sample), slope);
    let x = ratio(wide_shift(wide(right.y), frame.bits), wide_shift(wide(right.z), frame.bits), slope);
    let y = ratio(wide_shift(wide(down.y), frame.bits), wide_shift(wide(down.z), frame.bits), slope);
    var margin = 64u;
    if first.is_whole && x.is_whole && y.is_whole {
        margin = 0u;
    }
    if !(first.is_known && x.is_known && y.is_known) {
        margin = PART_ONE;
    }
    return Steps(
        vec3(u32(s.a.z) + first.whole, x.whole, y.whole),
        margin,
        vec3(first.part, x.part, y.part),
    );
}

struct Stepped {
    key: u32,
    is_sure: bool,
}

// The key at a sample that the triangle covers.
fn step_key(steps: Steps, at: vec2<u32>) -> Stepped {
    let part = steps.part.x + at.x * steps.part.y + at.y * steps.part.z;
    let key = steps.whole.x + at.x * steps.whole.y + at.y * steps.whole.z + (part >> PART_BITS);
    let sure = (part & (PART_ONE - 1u)) - steps.margin < PART_ONE - 2u * steps.margin;
    return Stepped(key, sure);
}

// About the key at a point, which the triangle need not cover: within those of its corners.
fn key_about(s: Setup, point: vec2<i32>) -> f32 {
    let b = wide_signed_to_f32(edge(s.c, s.a, point));
    let c = wide_signed_to_f32(edge(s.a, s.b, point));
    let z = vec3(f32(s.a.z), f32(s.b.z), f32(s.c.z));
    return clamp(z.x + about(b, c, slope_of(s)), min(z.x, min(z.y, z.z)), max(z.x, max(z.y, z.z)));
}
