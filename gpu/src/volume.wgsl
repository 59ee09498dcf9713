// Signed volumes of the boxes that three differences of lattice points span, in f32 where
// that is certain and in integers where it is not. Every sign is exact.
//
// Differences are integers of at most 2^24 in size, as f32: subtracting two points is exact.
// A volume takes products of three, whose partial results round: with u = 2^-23 for a
// rounding in any direction, cross(y, z) is off by 2u of its terms' sizes and the dot product
// by 3u more, in any order and fused or not. The terms' sizes are at most
// 2 |x|_1 |y|_max |z|_max together, so the error is below 5.01u times that; the norms
// themselves, rounded, take the rest of 12u. Nothing is subnormal: integers are 0 or at least
// 1, and their products stay below 2^75.
//#import wide

const VOLUME_ERROR: f32 = 12.0 / 8388608.0;

struct Volume {
    // Relative error at most 1 / least (see `volume`), or 4u.
    value: f32,
    // -1, 0 or 1; exact.
    sign: i32,
}

struct Factors {
    x: vec3<f32>,
    y: vec3<f32>,
    z: vec3<f32>,
    // How many times its error the volume must be; 1 for a sign alone.
    least: f32,
}

// x . (y x z). Where the error could exceed 1 / least of the value, it is worked out again in
// integers.
fn volume(factors: Factors) -> Volume {
    let value = dot(factors.x, cross(factors.y, factors.z));
    let sizes = sum_norm(factors.x) * largest(factors.y) * largest(factors.z);
    if abs(value) > VOLUME_ERROR * factors.least * sizes {
        return Volume(value, select(-1, 1, value > 0.0));
    }
    return exact_volume(vec3<i32>(factors.x), vec3<i32>(factors.y), vec3<i32>(factors.z));
}

fn sum_norm(v: vec3<f32>) -> f32 {
    return abs(v.x) + abs(v.y) + abs(v.z);
}

fn largest(v: vec3<f32>) -> f32 {
    return max(abs(v.x), max(abs(v.y), abs(v.z)));
}

// Components of the cross product are at most 2^49. Split at bit 24, their parts times
// components of x sum up within 64 bits: total = high * 2^24 + low.
fn exact_volume(x: vec3<i32>, y: vec3<i32>, z: vec3<i32>) -> Volume {
    let a = wide_sub(wide_mul(y.y, z.z), wide_mul(y.z, z.y));
    let b = wide_sub(wide_mul(y.z, z.x), wide_mul(y.x, z.z));
    let c = wide_sub(wide_mul(y.x, z.y), wide_mul(y.y, z.x));
    var high = wide_mul(x.x, wide_floor(a, 24u));
    high = wide_add(high, wide_mul(x.y, wide_floor(b, 24u)));
    high = wide_add(high, wide_mul(x.z, wide_floor(c, 24u)));
    var low = wide_mul(x.x, wide_low24(a));
    low = wide_add(low, wide_mul(x.y, wide_low24(b)));
    low = wide_add(low, wide_mul(x.z, wide_low24(c)));
    high = wide_add(high, wide(wide_floor(low, 24u)));
    let rest = wide_low24(low);
    if !wide_negative(high) {
        let value = wide_to_f32(high) * 16777216.0 + f32(rest);
        return Volume(value, i32(!(wide_is_zero(high) && rest == 0)));
    }
    // -(high * 2^24 + rest), both parts not negative.
    let borrow = i32(rest != 0);
    let size = wide_sub(wide(-borrow), high);
    let value = wide_to_f32(size) * 16777216.0 + f32(borrow * 16777216 - rest);
    return Volume(-value, -1);
}
