// What is shown of a pixel's list, and entries of the longest. Imported where there are `opaque_key`,
// `opaque_prim` and `picture`.
//#import jagged

// An entry of one of the longest lists.
struct Deep {
    at: u32,
    start: u32,
    end: u32,
}

// Of the longest lists there are `items`; there may be more workgroups than they need.
fn long_entry(group: u32, lane: u32) -> Deep {
    if group / tiled.groups >= tiled.items {
        return Deep(0u, 0u, 0u);
    }
    let list = longest.lists[group / tiled.groups];
    let run = run_at(list / WORKGROUP, list % WORKGROUP);
    let at = run.start + group % tiled.groups * WORKGROUP + lane;
    return Deep(at, run.start, run.start + run.length);
}

// A pixel, its list, and the key of what is opaque there.
struct Own {
    pixel: u32,
    run: Run,
    end: u32,
}

fn pixel_at(tile: u32, lane: u32) -> Own {
    if tile >= tiled.items {
        return Own(NOWHERE, Run(0u, 0u, 0u), 0u);
    }
    let pixel = pixel_of(tile, lane);
    if pixel == NOWHERE {
        return Own(NOWHERE, Run(0u, 0u, 0u), 0u);
    }
    return Own(pixel, run_at(tile, lane), opaque_key[pixel]);
}

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
