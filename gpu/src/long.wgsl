// 96-bit integers as three words, low word first, two's complement: signed volumes of boxes between
// lattice points, which are below 2^76 (volume.wgsl), and small multiples of them.
//#import wide

alias Long = vec3<u32>;

fn long_from(a: Wide) -> Long {
    let words = wide_words(a);
    return vec3(words, bitcast<u32>(bitcast<i32>(words.y) >> 31u));
}

fn long_add(a: Long, b: Long) -> Long {
    let x = a.x + b.x;
    let y = a.y + b.y;
    let carried = y + u32(x < a.x);
    return vec3(x, carried, a.z + b.z + u32(y < a.y) + u32(carried < y));
}

fn long_minus(a: Long) -> Long {
    return long_add(~a, vec3(1u, 0u, 0u));
}

fn long_sub(a: Long, b: Long) -> Long {
    return long_add(a, long_minus(b));
}

fn long_negative(a: Long) -> bool {
    return (a.z >> 31u) != 0u;
}

fn long_size(a: Long) -> Long {
    return select(a, long_minus(a), long_negative(a));
}

// Both not negative.
fn long_less(a: Long, b: Long) -> bool {
    if a.z != b.z {
        return a.z < b.z;
    }
    return a.y < b.y || (a.y == b.y && a.x < b.x);
}

// a * b modulo 2^96.
fn long_times(a: Long, b: i32) -> Long {
    let word = bitcast<u32>(b);
    let low = wide_mul_words(a.x, word);
    let high = wide_mul_words(a.y, word);
    let y = low.y + high.x;
    let product = vec3(low.x, y, a.z * word + high.y + u32(y < low.y));
    // A negative factor was read 2^32 too large.
    return select(product, long_sub(product, vec3(0u, a.xy)), b < 0);
}

// Not negative; relative error at most 3 units (a conversion and two sums).
fn long_to_f32(a: Long) -> f32 {
    return f32(a.z) * 18446744073709551616.0 + (f32(a.y) * 4294967296.0 + f32(a.x));
}

// x . (y x z), exactly. Components of differences are at most 2^24, those of the cross product at
// most 2^49.
fn long_volume(x: vec3<i32>, y: vec3<i32>, z: vec3<i32>) -> Long {
    let a = wide_sub(wide_mul(y.y, z.z), wide_mul(y.z, z.y));
    let b = wide_sub(wide_mul(y.z, z.x), wide_mul(y.x, z.z));
    let c = wide_sub(wide_mul(y.x, z.y), wide_mul(y.y, z.x));
    let sum = long_add(long_times(long_from(a), x.x), long_times(long_from(b), x.y));
    return long_add(sum, long_times(long_from(c), x.z));
}
