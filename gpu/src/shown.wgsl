// What is seen of a pixel with one sample: colour so far, and transmittance. Imported where there are
// `opaque_key`, `opaque_prim` and what `tile` imports. Twin: shown_samples.wgsl.

@group(0) @binding(10) var<storage, read_write> picture: array<vec4<f32>>;

alias Seen = vec4<f32>;

// What ends a pixel's layers: the key of what is opaque.
alias Behind = u32;

fn behind_at(pixel: u32) -> Behind {
    return opaque_key[pixel];
}

fn unseen() -> Seen {
    return vec4(0.0, 0.0, 0.0, 1.0);
}

// Whether all that comes from here on is hidden.
fn is_hidden(key: u32, behind: Behind) -> bool {
    return key >= behind;
}

// Whether nothing that comes is seen any more.
fn is_covered_up(seen: Seen) -> bool {
    return seen.a == 0.0;
}

// The next layer, which is not hidden, under those that were seen.
fn over(seen: Seen, entry: Listed, behind: Behind) -> Seen {
    let layer = faces[entry.y];
    return vec4(seen.rgb + seen.a * layer.a * layer.rgb, seen.a * (1.0 - layer.a));
}

// What was seen of a pixel, for a dispatch that goes on.
fn keep(pixel: u32, seen: Seen) {
    picture[pixel] = seen;
}

fn kept_of(pixel: u32) -> Seen {
    return picture[pixel];
}

fn show(pixel: u32, seen: Seen) {
    picture[pixel] = vec4(seen.rgb + seen.a * colour_behind(pixel), 1.0);
}

// What lies behind a pixel's layers.
fn colour_behind(pixel: u32) -> vec3<f32> {
    let prim = opaque_prim[pixel];
    if prim == NOTHING {
        return frame.background.rgb;
    }
    return faces[prim].rgb;
}
