// Light in units of 2^-24, and sums of it that do not depend on their order: integers of 64 bits
// in two words (spec/src/dispatch/deposit.rs).
//#import task
//#import wide

// Low and high words of red, green and blue, pixel by pixel.
@group(0) @binding(11) var<storage, read_write> sums: array<atomic<u32>>;

// whole 2^exponent, rounded to the nearest integer, halves up, for whole up to 2^24 and a result
// below 2^56. Low word first.
fn rounded(whole: u32, exponent: i32) -> vec2<u32> {
    if exponent > 0 {
        let by = u32(min(exponent, 31));
        return vec2(whole << by, whole >> (32u - by));
    }
    if exponent == 0 {
        return vec2(whole, 0u);
    }
    // What is below half a unit is 0.
    let by = u32(min(-exponent, 26));
    return vec2((whole + (1u << (by - 1u))) >> by, 0u);
}

// An f32 that is not negative, 24 bits and a power of two; subnormal ones are below half a unit.
fn units(light: f32) -> vec2<u32> {
    let bits = bitcast<u32>(light);
    let exponent = i32((bits >> 23u) & 0xffu);
    return rounded((bits & 0x7fffffu) | 0x800000u, exponent - 126);
}

// Units of a part of the background that is rounded to f32 first, to nearest, ties to even: WGSL
// leaves open how it rounds products.
fn units_behind(background: f32, weight: u32) -> vec2<u32> {
    let bits = bitcast<u32>(background);
    let exponent = i32((bits >> 23u) & 0xffu) - 126 - 15;
    let product = wide_mul_words((bits & 0x7fffffu) | 0x800000u, weight);
    let size = select(32u - countLeadingZeros(product.x), 64u - countLeadingZeros(product.y), product.y != 0u);
    if size <= 24u {
        return rounded(product.x, exponent);
    }
    // Below 2^40: at most 16 bits too many.
    let by = size - 24u;
    let lost = product.x & ((1u << by) - 1u);
    var whole = (product.y << (32u - by)) | (product.x >> by);
    let half = 1u << (by - 1u);
    whole += u32(lost > half || (lost == half && (whole & 1u) == 1u));
    return rounded(whole, exponent + i32(by));
}

// To a sum of two words: whoever makes the low one wrap around carries to the high one.
fn deposited(place: u32, amount: vec2<u32>) {
    let before = atomicAdd(&sums[place], amount.x);
    let more = amount.y + u32(before + amount.x < before);
    if more != 0u {
        atomicAdd(&sums[place + 1u], more);
    }
}
