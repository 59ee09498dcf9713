// Depth of field from the layers of sorted lists. Yang et al. 2010, section 5.
// Twin: spec/src/abuffer/defocus.rs.

//#import sorted

struct Lens {
    focus: u32,     // key
    aperture: u32,  // pixels of radius over the whole depth range
    radius: u32,    // no radius is larger
    padding: u32,
}

@group(0) @binding(13) var<uniform> lens: Lens;

// A layer: each pixel's radius, or NOTHING, and triangle.
@group(0) @binding(15) var<storage, read_write> layer: array<vec2<u32>>;

fn radius_at(key: u32) -> u32 {
    let away = max(key, lens.focus) - min(key, lens.focus);
    return min(((away >> 15u) * lens.aperture) >> 16u, lens.radius);
}

@compute @workgroup_size(WORKGROUP)
fn defocus_clear(@builtin(global_invocation_id) id: vec3<u32>) {
    begin_list(id.x);
}

// The next fragment of each list.
@compute @workgroup_size(WORKGROUP)
fn defocus_layer(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= band_pixels() {
        return;
    }
    let at = cursors[id.x];
    layer[id.x] = vec2(NOTHING, NOTHING);
    if is_visible(at, opaque_key[id.x]) {
        let node = nodes[at];
        layer[id.x] = vec2(radius_at(node.key), node.prim);
        cursors[id.x] = node.next;
    }
}

// The opaque surfaces.
@compute @workgroup_size(WORKGROUP)
fn defocus_surface(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= band_pixels() {
        return;
    }
    let prim = opaque_prim[id.x];
    layer[id.x] = vec2(select(radius_at(opaque_key[id.x]), NOTHING, prim == NOTHING), prim);
}

// Pixel p + d, at the border if beyond it.
fn inside(p: u32, d: i32, side: u32) -> u32 {
    return u32(clamp(i32(p) + d, 0, i32(side) - 1));
}

// Stage defocus: what reaches a pixel of the layer, under what is seen so far. It runs over
// whole targets.
@compute @workgroup_size(WORKGROUP)
fn defocus(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= band_pixels() {
        return;
    }
    let x = id.x % frame.width;
    let y = id.x / frame.width;
    let reach = i32(lens.radius);
    var whole = vec4(0.0);
    var reached = false;
    for (var dy = -reach; dy <= reach; dy += 1) {
        for (var dx = -reach; dx <= reach; dx += 1) {
            let from_here = layer[inside(y, dy, frame.rows) * frame.width + inside(x, dx, frame.width)];
            let away = u32(max(abs(dx), abs(dy)));
            if from_here.y != NOTHING && away <= from_here.x {
                let spot = faces[from_here.y];
                let side = f32(2u * from_here.x + 1u);
                let share = 1.0 / (side * side) * spot.a;
                whole += vec4(share * spot.rgb, share);
                reached = true;
            }
        }
    }
    if !reached {
        return;
    }
    let blurred = whole / max(whole.a, 1.0);
    let seen = picture[id.x];
    picture[id.x] = vec4(seen.rgb + seen.a * blurred.rgb, seen.a * (1.0 - blurred.a));
}

@compute @workgroup_size(WORKGROUP)
fn defocus_behind(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x < band_pixels() {
        let seen = picture[id.x];
        picture[id.x] = vec4(seen.rgb + seen.a * frame.background.rgb, 1.0);
    }
}
