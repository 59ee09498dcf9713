// Depth keys of a tile's samples, by steps. A key is za + floor(M / area), and from one sample to the
// next M / area changes by a number that is the same all over the triangle. So quotients are taken once
// for a tile, at its first sample and for a step to the right and down. A sample adds them up.
// Twin: steps_samples.wgsl.
//
// A fraction is off by less than 4.25 units (`ratio`), a sum of 15 of them by less than 64. A sum that
// is no nearer than that to a whole number rounds down as the exact one does; at others the caller
// takes the exact key.
//#import ratio

// For the first sample, a step to the right, a step down.
struct Steps {
    whole: vec3<u32>,
    // How near to a whole number a sum may not be; PART_ONE where no sum is known.
    margin: u32,
    part: vec3<u32>,
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
