// Fragments at a reduced resolution, and what the full one shows of them. Yang et al. 2010, section 5;
// Kopf et al. 2007. Twin: spec/src/abuffer/reduced.rs.
//
// The first passes run over the reduced target, the others over the full one.

//#import sorted

struct Reduction {
    halvings: u32,  // a reduced pixel stands for a block of 2^halvings a side
    across: u32,    // reduced pixels in a row
    down: u32,      // and in a column
    falloff: f32,   // of weights with depth, one over the depth range
}

@group(0) @binding(13) var<uniform> reduction: Reduction;

// Of each reduced pixel: colour of its layers, and what goes through; key of its opaque surface.
@group(0) @binding(15) var<storage, read> reduced_layer: array<vec4<f32>>;
@group(0) @binding(17) var<storage, read> guide: array<u32>;

// Depth where no surface is: behind the farthest key.
const BEYOND: u32 = 0x80000000u;

@compute @workgroup_size(WORKGROUP)
fn reduced_clear(@builtin(global_invocation_id) id: vec3<u32>) {
    begin_list(id.x);
}

// The layers of a reduced pixel without what lies behind. A dispatch goes on where the one before stopped.
@compute @workgroup_size(WORKGROUP)
fn reduced_layers(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= band_pixels() {
        return;
    }
    var at = cursors[id.x];
    if at == DONE {
        return;
    }
    var seen = picture[id.x];
    let end = opaque_key[id.x];
    var i = 0u;
    while i < STEPS && is_visible(at, end) {
        let node = nodes[at];
        seen = under(seen, node.prim);
        at = node.next;
        i += 1u;
    }
    if i == STEPS {
        atomicStore(&unfinished, 1u);
    } else {
        at = DONE;
    }
    picture[id.x] = seen;
    cursors[id.x] = at;
}

// A pixel of the full resolution: that of its block.
@compute @workgroup_size(WORKGROUP)
fn reduced_nearest(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= band_pixels() {
        return;
    }
    let x = (id.x % frame.width) >> reduction.halvings;
    let y = (id.x / frame.width) >> reduction.halvings;
    let seen = reduced_layer[y * reduction.across + x];
    picture[id.x] = vec4(seen.rgb + seen.a * behind(id.x), 1.0);
}

// Along an axis, the two reduced pixels around a pixel's middle: the first, and the weight of the second, of
// two sides of a block in all.
fn around(pixel: u32) -> vec2<i32> {
    let side = 1i << reduction.halvings;
    let from_first = 2 * i32(pixel) + 1 - side;
    // The shift of a negative number rounds down.
    let first = from_first >> (reduction.halvings + 1u);
    return vec2(first, from_first - 2 * side * first);
}

fn weight_of(key: u32, other: u32) -> f32 {
    let near = min(key, BEYOND);
    let far = min(other, BEYOND);
    let distance = f32(max(near, far) - min(near, far)) * 0x1p-31f;
    return 1.0 / (1.0 + distance * reduction.falloff);
}

// Stage reduced: that of the four around it, by place and by the depths of the opaque surfaces.
@compute @workgroup_size(WORKGROUP)
fn reduced(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= band_pixels() {
        return;
    }
    let column = around(id.x % frame.width);
    let row = around(id.x / frame.width);
    let key = opaque_key[id.x];
    let whole = 2i << reduction.halvings;
    var seen = vec4(0.0);
    var weights = 0.0;
    for (var tap = 0; tap < 4; tap += 1) {
        let right = tap & 1;
        let below = tap >> 1u;
        let x = clamp(column.x + right, 0, i32(reduction.across) - 1);
        let y = clamp(row.x + below, 0, i32(reduction.down) - 1);
        let place = select(whole - column.y, column.y, right == 1) * select(whole - row.y, row.y, below == 1);
        let at = u32(y) * reduction.across + u32(x);
        let weight = f32(place) * weight_of(key, guide[at]);
        seen += weight * reduced_layer[at];
        weights += weight;
    }
    seen /= weights;
    picture[id.x] = vec4(seen.rgb + seen.a * behind(id.x), 1.0);
}
