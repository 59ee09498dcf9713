// What is shown of a pixel. Imported where there is `opaque_prim`.

@group(0) @binding(10) var<storage, read_write> picture: array<vec4<f32>>;

fn shown(pixel: u32, seen: vec4<f32>) {
    picture[pixel] = vec4(seen.rgb + seen.a * behind(pixel), 1.0);
}

// The next layer under those that were seen.
fn over(seen: vec4<f32>, prim: u32) -> vec4<f32> {
    let layer = faces[prim];
    return vec4(seen.rgb + seen.a * layer.a * layer.rgb, seen.a * (1.0 - layer.a));
}

// What lies behind a pixel's layers.
fn behind(pixel: u32) -> vec3<f32> {
    let prim = opaque_prim[pixel];
    if prim == NOTHING {
        return frame.background.rgb;
    }
    return faces[prim].rgb;
}
