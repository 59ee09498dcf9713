// What is seen of a pixel with several samples: colour so far, and transmittance, of each. Imported where
// there are `opaque_key`, `opaque_prim` and what `tile` imports. Twin: shown.wgsl.
//#import mean

// The mean of a pixel at its first sample; while a dispatch waits for the next, all of its samples.
@group(0) @binding(10) var<storage, read_write> picture: array<vec4<f32>>;

// A variable each, so that they lie in registers; those that a pixel does not have are not read.
struct Seen {
    a: vec4<f32>,
    b: vec4<f32>,
    c: vec4<f32>,
    d: vec4<f32>,
    e: vec4<f32>,
    f: vec4<f32>,
    g: vec4<f32>,
    h: vec4<f32>,
}

// The pixel itself: what is opaque is told of each sample.
alias Behind = u32;

fn behind_at(pixel: u32) -> Behind {
    return pixel;
}

fn unseen() -> Seen {
    let start = vec4(0.0, 0.0, 0.0, 1.0);
    return Seen(start, start, start, start, start, start, start, start);
}

// A fragment may lie before what is opaque at some samples alone: nothing hides all that come, but the
// end of a list.
fn is_hidden(key: u32, behind: Behind) -> bool {
    return key == NOTHING;
}

// Whether nothing that comes is seen any more.
fn is_covered_up(seen: Seen) -> bool {
    var most = max(seen.a.a, seen.b.a);
    if frame.samples > 2u {
        most = max(most, max(seen.c.a, seen.d.a));
    }
    if frame.samples > 4u {
        most = max(most, max(max(seen.e.a, seen.f.a), max(seen.g.a, seen.h.a)));
    }
    return most == 0.0;
}

fn blended(seen: vec4<f32>, layer: vec4<f32>, mask: u32, sample: u32) -> vec4<f32> {
    let next = vec4(seen.rgb + seen.a * layer.a * layer.rgb, seen.a * (1.0 - layer.a));
    return select(seen, next, (mask >> sample & 1u) != 0u);
}

// The next layer under those that were seen, at the samples at which it shows.
fn over(seen: Seen, entry: Listed, behind: Behind) -> Seen {
    let prim = prim_of(entry.y);
    let mask = showing(entry, behind);
    let layer = faces[prim];
    var next = seen;
    next.a = blended(seen.a, layer, mask, 0u);
    next.b = blended(seen.b, layer, mask, 1u);
    if frame.samples > 2u {
        next.c = blended(seen.c, layer, mask, 2u);
        next.d = blended(seen.d, layer, mask, 3u);
    }
    if frame.samples > 4u {
        next.e = blended(seen.e, layer, mask, 4u);
        next.f = blended(seen.f, layer, mask, 5u);
        next.g = blended(seen.g, layer, mask, 6u);
        next.h = blended(seen.h, layer, mask, 7u);
    }
    return next;
}

// The samples of an entry's mask at which it is not hidden. With a depth test, no others are in it.
fn showing(entry: Listed, pixel: u32) -> u32 {
    var mask = mask_of(entry.y);
    if frame.depth_test != 0u {
        return mask;
    }
    for (var s = 0u; s < frame.samples; s += 1u) {
        let end = opaque_key[frame.samples * pixel + s];
        let is_covered = (mask >> s & 1u) != 0u;
        if is_covered && end != NOTHING && key_at(prim_of(entry.y), pixel, s, entry.x) >= end {
            mask &= ~(1u << s);
        }
    }
    return mask;
}

// What was seen of a pixel, for a dispatch that goes on.
fn keep(pixel: u32, seen: Seen) {
    var samples = array(seen.a, seen.b, seen.c, seen.d, seen.e, seen.f, seen.g, seen.h);
    for (var s = 0u; s < frame.samples; s += 1u) {
        picture[frame.samples * pixel + s] = samples[s];
    }
}

fn kept_of(pixel: u32) -> Seen {
    var samples: array<vec4<f32>, SAMPLES_MAX>;
    for (var s = 0u; s < frame.samples; s += 1u) {
        samples[s] = picture[frame.samples * pixel + s];
    }
    return Seen(
        samples[0],
        samples[1],
        samples[2],
        samples[3],
        samples[4],
        samples[5],
        samples[6],
        samples[7],
    );
}

fn show(pixel: u32, seen: Seen) {
    var samples = array(seen.a, seen.b, seen.c, seen.d, seen.e, seen.f, seen.g, seen.h);
    var colours: array<vec3<f32>, SAMPLES_MAX>;
    for (var s = 0u; s < frame.samples; s += 1u) {
        let own = samples[s];
        colours[s] = own.rgb + own.a * colour_behind(frame.samples * pixel + s);
    }
    picture[frame.samples * pixel] = mean(&colours);
}

// What lies behind the layers of a sample.
fn colour_behind(at: u32) -> vec3<f32> {
    let prim = opaque_prim[at];
    if prim == NOTHING {
        return frame.background.rgb;
    }
    return faces[prim].rgb;
}
