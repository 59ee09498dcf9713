// 64-bit integers where the adapter has them (SHADER_INT64). Twin: wide.wgsl.

alias Wide = i64;

fn wide(value: i32) -> Wide {
    return i64(value);
}

fn wide_from(value: u32) -> Wide {
    return i64(value);
}

fn wide_add(a: Wide, b: Wide) -> Wide {
    return a + b;
}

fn wide_sub(a: Wide, b: Wide) -> Wide {
    return a - b;
}

fn wide_negative(a: Wide) -> bool {
    return a < 0li;
}

// Both not negative.
fn wide_less(a: Wide, b: Wide) -> bool {
    return a < b;
}

fn wide_is_zero(a: Wide) -> bool {
    return a == 0li;
}

// The exact product of two signed words.
fn wide_mul(a: i32, b: i32) -> Wide {
    return i64(a) * i64(b);
}

// a * b modulo 2^64.
fn wide_scale(a: Wide, b: u32) -> Wide {
    return a * i64(b);
}

// The same for a signed word.
fn wide_times(a: Wide, b: i32) -> Wide {
    return a * i64(b);
}

// a * 2^bits, bits in 1..31.
fn wide_shift(a: Wide, bits: u32) -> Wide {
    return a << bits;
}

// floor(a / 2^bits), for bits in 1..63 and a result of 32 bits.
fn wide_floor(a: Wide, bits: u32) -> i32 {
    return i32(a >> bits);
}

// a modulo 2^24.
fn wide_low24(a: Wide) -> i32 {
    return i32(a & 0xffffffli);
}

// Not negative; relative error at most 2 units.
fn wide_to_f32(a: Wide) -> f32 {
    return f32(a);
}

// Of either sign; the same error.
fn wide_signed_to_f32(a: Wide) -> f32 {
    return f32(a);
}

// The words, low one first.
fn wide_words(a: Wide) -> vec2<u32> {
    let words = u64(a);
    return vec2(u32(words & 0xfffffffflu), u32(words >> 32u));
}

// The full product of two unsigned words.
fn wide_mul_words(a: u32, b: u32) -> vec2<u32> {
    let product = u64(a) * u64(b);
    return vec2(u32(product & 0xfffffffflu), u32(product >> 32u));
}
