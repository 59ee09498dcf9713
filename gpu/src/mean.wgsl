// What a pixel shows of its samples. Twin: spec/src/abuffer/multisample.rs.
//#import triangle

// The mean of all samples: by halves, so that the mean of equal colours is that colour, and
// by a power of two from its bits, as WGSL's quotients may be off.
fn mean(colours: ptr<function, array<vec3<f32>, SAMPLES_MAX>>) -> vec4<f32> {
    for (var half = 1u; half < frame.samples; half *= 2u) {
        for (var s = 0u; s < frame.samples; s += 2u * half) {
            (*colours)[s] += (*colours)[s + half];
        }
    }
    let share = bitcast<f32>((127u - firstTrailingBit(frame.samples)) << 23u);
    return vec4(share * (*colours)[0], 1.0);
}
