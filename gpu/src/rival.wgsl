// What the rivals of lists share: the opaque surfaces, which are there before, and the picture.

//#import place
//#import walk

// No opaque surface, no fragment: farther than every key, beyond every triangle.
const NOTHING: u32 = 0xffffffffu;

@group(0) @binding(5) var<storage, read> opaque_key: array<u32>;
@group(0) @binding(6) var<storage, read> opaque_prim: array<u32>;
@group(0) @binding(10) var<storage, read_write> picture: array<vec4<f32>>;

// What lies behind a pixel's layers.
fn behind(pixel: u32) -> vec3<f32> {
    let prim = opaque_prim[pixel];
    if prim == NOTHING {
        return frame.background.rgb;
    }
    return faces[prim].rgb;
}

// A layer under those before it: colour so far, and transmittance.
fn under(seen: vec4<f32>, prim: u32) -> vec4<f32> {
    let layer = faces[prim];
    return vec4(seen.rgb + seen.a * layer.a * layer.rgb, seen.a * (1.0 - layer.a));
}

// A layer over those before it.
fn over(seen: vec4<f32>, prim: u32) -> vec4<f32> {
    let layer = faces[prim];
    let through = 1.0 - layer.a;
    return vec4(layer.a * layer.rgb + through * seen.rgb, through * seen.a);
}

// Layers that are blended, over what lies behind them.
fn over_behind(pixel: u32) {
    let seen = picture[pixel];
    picture[pixel] = vec4(seen.rgb + seen.a * behind(pixel), 1.0);
}
