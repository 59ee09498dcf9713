// Where mirrors send rays, and with what weight (spec/src/dispatch/reflect.rs).
//#import task
//#import wide

// Bits of the longest component of a mirror direction.
const DIRECTION_BITS: u32 = 23u;

fn bits_of(a: Wide) -> u32 {
    var size = a;
    if wide_negative(a) {
        size = wide_sub(wide(0), a);
    }
    let words = wide_words(size);
    return select(32u - countLeadingZeros(words.x), 64u - countLeadingZeros(words.y), words.y != 0u);
}

// a / 2^shift, rounded to the nearest integer, halves up, for shift in 1..32 and |a| below 2^55: half
// of what one shift less leaves, rounded up.
fn halved(a: Wide, shift: u32) -> i32 {
    return (wide_floor(wide_shift(a, 1u), shift) + 1) >> 1u;
}

// (n . n) d - 2 (n . d) n, of 23 bits. For components of n of at most 2^14 and of d of at most 2^24,
// n . n is below 2^29, n . d below 2^39 and the vector below 2^55. A triangle that is met has a normal,
// of length 2^14 but for rounding, so the vector is above 2^27 and is always shifted.
fn mirrored(n: vec3<i32>, d: vec3<i32>) -> vec3<i32> {
    let square = n.x * n.x + n.y * n.y + n.z * n.z;
    let along = wide_add(wide_mul(n.x, d.x), wide_add(wide_mul(n.y, d.y), wide_mul(n.z, d.z)));
    let x = wide_sub(wide_mul(square, d.x), wide_times(along, 2 * n.x));
    let y = wide_sub(wide_mul(square, d.y), wide_times(along, 2 * n.y));
    let z = wide_sub(wide_mul(square, d.z), wide_times(along, 2 * n.z));
    let bits = max(bits_of(x), max(bits_of(y), bits_of(z)));
    let shift = max(bits, DIRECTION_BITS + 1u) - DIRECTION_BITS;
    return vec3(halved(x, shift), halved(y, shift), halved(z, shift));
}

// Each colour of a product of weights, rounded to the nearest unit, halves up; at most 2^30.
fn weighted(weight: vec3<u32>, mirror: vec3<u32>) -> vec3<u32> {
    return (weight * mirror + WEIGHT_ONE / 2u) / WEIGHT_ONE;
}
