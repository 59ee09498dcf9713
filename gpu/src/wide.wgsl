// 64-bit integers as two words, low word first, two's complement.
// Baseline WGSL has no wider integer than 32 bits. Twin: wide_native.wgsl.

alias Wide = vec2<u32>;

fn wide(value: i32) -> Wide {
    return vec2(bitcast<u32>(value), bitcast<u32>(value >> 31u));
}

fn wide_from(value: u32) -> Wide {
    return vec2(value, 0u);
}

fn wide_add(a: Wide, b: Wide) -> Wide {
    let low = a.x + b.x;
    return vec2(low, a.y + b.y + u32(low < a.x));
}

fn wide_sub(a: Wide, b: Wide) -> Wide {
    return vec2(a.x - b.x, a.y - b.y - u32(a.x < b.x));
}

fn wide_negative(a: Wide) -> bool {
    return (a.y >> 31u) != 0u;
}

// Both not negative.
fn wide_less(a: Wide, b: Wide) -> bool {
    return a.y < b.y || (a.y == b.y && a.x < b.x);
}

fn wide_is_zero(a: Wide) -> bool {
    return (a.x | a.y) == 0u;
}

// The full product of two unsigned words, from four products of half words.
fn wide_mul_words(a: u32, b: u32) -> vec2<u32> {
    let a0 = a & 0xffffu;
    let a1 = a >> 16u;
    let b0 = b & 0xffffu;
    let b1 = b >> 16u;
    let middle = a1 * b0 + ((a0 * b0) >> 16u);
    let carry = a0 * b1 + (middle & 0xffffu);
    return vec2(a * b, a1 * b1 + (middle >> 16u) + (carry >> 16u));
}

// The exact product of two signed words.
fn wide_mul(a: i32, b: i32) -> Wide {
    let product = wide_mul_words(bitcast<u32>(a), bitcast<u32>(b));
    // A negative factor was read 2^32 too large.
    let excess = select(0u, bitcast<u32>(b), a < 0) + select(0u, bitcast<u32>(a), b < 0);
    return vec2(product.x, product.y - excess);
}

// a * b modulo 2^64.
fn wide_scale(a: Wide, b: u32) -> Wide {
    let product = wide_mul_words(a.x, b);
    return vec2(product.x, product.y + a.y * b);
}

// The same for a signed word.
fn wide_times(a: Wide, b: i32) -> Wide {
    let product = wide_scale(a, bitcast<u32>(b));
    // A negative factor was read 2^32 too large.
    return vec2(product.x, product.y - select(0u, a.x, b < 0));
}

// a * 2^bits, bits in 1..31.
fn wide_shift(a: Wide, bits: u32) -> Wide {
    return vec2(a.x << bits, (a.y << bits) | (a.x >> (32u - bits)));
}

// floor(a / 2^bits), for bits in 1..63 and a result of 32 bits.
fn wide_floor(a: Wide, bits: u32) -> i32 {
    if bits < 32u {
        return bitcast<i32>((a.y << (32u - bits)) | (a.x >> bits));
    }
    return bitcast<i32>(a.y) >> (bits - 32u);
}

// a modulo 2^24.
fn wide_low24(a: Wide) -> i32 {
    return bitcast<i32>(a.x & 0xffffffu);
}

// Not negative; relative error at most 2 units (a conversion and a sum).
fn wide_to_f32(a: Wide) -> f32 {
    return f32(a.y) * 4294967296.0 + f32(a.x);
}

// Of either sign; the same error.
fn wide_signed_to_f32(a: Wide) -> f32 {
    if wide_negative(a) {
        return -wide_to_f32(wide_sub(wide(0), a));
    }
    return wide_to_f32(a);
}

// The words, low one first.
fn wide_words(a: Wide) -> vec2<u32> {
    return a;
}
