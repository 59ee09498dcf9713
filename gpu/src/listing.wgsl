// What lists in other layouts than build's share: which fragments are stored, as which words, and what
// lies behind them. Twin: spec/src/layouts.rs.
//#import drawn
//#import place
//#import walk

// No opaque surface: farther than every key.
const NOTHING: u32 = 0xffffffffu;

// What kernels of a layout are told beside the frame. Twin: `Listing` in layouts.rs.
struct Listing {
    entries: u32,       // of each pixel's array; 0: runs of one array, from offsets
    regions: u32,       // of nodes, each with a counter
    items: u32,         // entries of a dispatch
    run: u32,           // entries in a row that are in order
    first: u32,         // the first entry of each list that a dispatch blends
    flags: u32,         // of a dispatch that blends
    from_key: u32,      // entries before this one are left out,
    from_face: u32,
    until_key: u32,     // and this one and those behind it
    until_face: u32,
    links: u32,         // heads of lists, before the links of nodes
    layers: u32,        // that are shown of each list, the nearest ones
    sample: u32,        // the first of each pixel in a dispatch that blends several,
    samples: u32,       // and how many
}

@group(0) @binding(20) var<uniform> listing: Listing;

// What a dispatch that blends does beside: it begins with nothing, or ends with what lies behind.
const BEGINS: u32 = 1u;
const ENDS: u32 = 2u;
// Passes over nearer ranges of depth have shown layers before; others are to come.
const FOLLOWS: u32 = 4u;
const GOES_ON: u32 = 8u;

@group(0) @binding(21) var<storage, read> opaque_key: array<u32>;
@group(0) @binding(22) var<storage, read> opaque_prim: array<u32>;
@group(0) @binding(10) var<storage, read_write> picture: array<vec4<f32>>;

// The key of a fragment at one of its samples.
fn key_of(fragment: Fragment, sample: u32) -> u32 {
    if frame.samples == 1u {
        return fragment.key;
    }
    return key_at(fragment.prim, fragment.pixel, sample, fragment.key);
}

// The samples of a fragment in front of the opaque surfaces there.
fn visible(fragment: Fragment) -> u32 {
    if frame.depth_test == 0u {
        return fragment.mask;
    }
    var mask = fragment.mask;
    for (var s = 0u; s < frame.samples; s += 1u) {
        let end = opaque_key[frame.samples * fragment.pixel + s];
        if end != NOTHING && key_of(fragment, s) >= end {
            mask &= ~(1u << s);
        }
    }
    return mask;
}

// Bits of a mask below a triangle's number.
const MASK_BITS: u32 = 8u;

// Triangle and mask in a word.
fn face_of(prim: u32, mask: u32) -> u32 {
    return (prim << MASK_BITS) | mask;
}

// What lies behind a pixel's layers.
fn behind(pixel: u32) -> vec3<f32> {
    let prim = opaque_prim[pixel];
    if prim == NOTHING {
        return frame.background.rgb;
    }
    return faces[prim].rgb;
}

// A layer under those before it: colour so far, and transmittance.
fn under(seen: vec4<f32>, layer: vec4<f32>) -> vec4<f32> {
    return vec4(seen.rgb + seen.a * layer.a * layer.rgb, seen.a * (1.0 - layer.a));
}
