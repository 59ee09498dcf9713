// Blending where pixels have several samples: a dispatch has a turn of them, which is all of a pixel's, or
// one, as in a multisampled target, whose mean a last pass takes. Yang et al. 2010, section 4.1.2.
// Imported where there is `listing`. Twin: spec/src/abuffer/multisample.rs.
//#import mean

// Layers of a list in one dispatch: an inner loop has all samples of each.
const SAMPLED: u32 = 2048u;

// Colour so far and transmittance of each sample; `picture` holds them between dispatches.
var<private> seen_at: array<vec4<f32>, SAMPLES_MAX>;

fn turn_end() -> u32 {
    return listing.sample + listing.samples;
}

// Nothing has been seen of a pixel, or what an earlier dispatch left.
fn enter_turn(pixel: u32, begins: bool) {
    for (var s = listing.sample; s < turn_end(); s += 1u) {
        if begins {
            seen_at[s] = vec4(0.0, 0.0, 0.0, 1.0);
        } else {
            seen_at[s] = picture[frame.samples * pixel + s];
        }
    }
}

// Whether a fragment shows at a sample: it covers that, in front of the opaque surface there.
fn shows(pixel: u32, s: u32, key: u32, face: u32) -> bool {
    if (face >> s & 1u) == 0u {
        return false;
    }
    let end = opaque_key[frame.samples * pixel + s];
    return end == NOTHING || key_at(face >> MASK_BITS, pixel, s, key) < end;
}

// A layer under those before it, at the samples where it shows.
fn under_turn(pixel: u32, key: u32, face: u32, layer: vec4<f32>) {
    for (var s = listing.sample; s < turn_end(); s += 1u) {
        if shows(pixel, s, key, face) {
            seen_at[s] = under(seen_at[s], layer);
        }
    }
}

// If more is to come, what has been seen; else samples over what lies behind each, and the mean of all of
// them if the turn has all.
fn leave_turn(pixel: u32, ends: bool) {
    let first = frame.samples * pixel;
    if !ends {
        for (var s = listing.sample; s < turn_end(); s += 1u) {
            picture[first + s] = seen_at[s];
        }
        return;
    }
    var colours: array<vec3<f32>, SAMPLES_MAX>;
    for (var s = listing.sample; s < turn_end(); s += 1u) {
        colours[s] = seen_at[s].rgb + seen_at[s].a * behind(first + s);
        picture[first + s] = vec4(colours[s], 1.0);
    }
    if listing.samples == frame.samples {
        picture[first] = mean(&colours);
    }
}
