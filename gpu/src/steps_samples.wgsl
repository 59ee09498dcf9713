// Depth keys of a tile's samples, by steps, where pixels have several. Twin: steps.wgsl.
//
// Quotients are taken at the corner of the tile's first pixel, for a pixel to the right and down, and for
// a sub-pixel: of those, a sample is up to 255 away. Fractions are off by less than 4.25 units, a sum of
// 1 + 7 + 7 + 255 + 255 of them by less than 2,304. The sum is less than 525 PART_ONE, and 32 bits hold it.
//#import ratio

// For the first corner, a pixel to the right, a pixel down; a sub-pixel to the right, and down.
struct Steps {
    whole: vec3<u32>,
    // How near to a whole number a sum may not be; PART_ONE where no sum is known.
    margin: u32,
    part: vec3<u32>,
    unused: u32,
    inner_whole: vec2<u32>,
    inner_part: vec2<u32>,
}

const MARGIN: u32 = 2304u;

// Of a triangle, from a corner of pixels on; `right` and `down` are the changes of its edge functions from
// pixel to pixel, in sub-pixels.
fn steps_of(s: Setup, corner: vec2<i32>, right: vec3<i32>, down: vec3<i32>) -> Steps {
    let slope = slope_of(s);
    let first = ratio(edge(s.c, s.a, corner), edge(s.a, s.b, corner), slope);
    let x = ratio(wide_shift(wide(right.y), frame.bits), wide_shift(wide(right.z), frame.bits), slope);
    let y = ratio(wide_shift(wide(down.y), frame.bits), wide_shift(wide(down.z), frame.bits), slope);
    let u = ratio(wide(right.y), wide(right.z), slope);
    let v = ratio(wide(down.y), wide(down.z), slope);
    var margin = MARGIN;
    if first.is_whole && x.is_whole && y.is_whole && u.is_whole && v.is_whole {
        margin = 0u;
    }
    if !(first.is_known && x.is_known && y.is_known && u.is_known && v.is_known) {
        margin = PART_ONE;
    }
    return Steps(
        vec3(u32(s.a.z) + first.whole, x.whole, y.whole),
        margin,
        vec3(first.part, x.part, y.part),
        0u,
        vec2(u.whole, v.whole),
        vec2(u.part, v.part),
    );
}

struct Stepped {
    key: u32,
    is_sure: bool,
}

// The key at a sample that the triangle covers, which lies at `place` in its pixel.
fn step_key(steps: Steps, at: vec2<u32>, place: vec2<u32>) -> Stepped {
    let pixel = steps.part.x + at.x * steps.part.y + at.y * steps.part.z;
    let part = pixel + place.x * steps.inner_part.x + place.y * steps.inner_part.y;
    let inner = place.x * steps.inner_whole.x + place.y * steps.inner_whole.y;
    let whole = steps.whole.x + at.x * steps.whole.y + at.y * steps.whole.z + inner;
    let sure = (part & (PART_ONE - 1u)) - steps.margin < PART_ONE - 2u * steps.margin;
    return Stepped(whole + (part >> PART_BITS), sure);
}
