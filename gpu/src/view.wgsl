// From where a pixel's ray comes, and which point of a triangle it meets.
//#import surface

struct View {
    // Homogeneous pixels from lattice steps.
    x: vec4<f32>,
    y: vec4<f32>,
    z: vec4<f32>,
    w: vec4<f32>,
    // The eye, or the direction to it.
    viewpoint: vec3<f32>,
    // 1: it is a point, 0: a direction.
    near: u32,
    width: u32,
    height: u32,
    unused: vec2<u32>,
}

@group(0) @binding(1) var<uniform> view: View;

fn to_viewer(point: vec3<f32>) -> vec3<f32> {
    return select(view.viewpoint, view.viewpoint - point, view.near == 1u);
}

// Homogeneous pixels without depth.
fn homogeneous(p: vec3<f32>) -> vec3<f32> {
    let q = vec4(p, 1.0);
    return vec3(dot(view.x, q), dot(view.y, q), dot(view.w, q));
}

// From the middle of a pixel.
fn seen_from(p: vec3<f32>, middle: vec2<f32>) -> vec2<f32> {
    let h = homogeneous(p);
    return h.xy - middle * h.z;
}

fn cross2(a: vec2<f32>, b: vec2<f32>) -> f32 {
    return a.x * b.y - b.x * a.y;
}

// The nearest integer, halves up; exactly, as `floor(c + 0.5)` is not.
fn rounded(c: vec3<f32>) -> vec3<f32> {
    let below = floor(c);
    return select(below, below + 1.0, c - below >= vec3(0.5));
}

// Between two corners of a box, whatever else a number is.
fn kept_in(c: vec3<f32>, low: vec3<f32>, high: vec3<f32>) -> vec3<f32> {
    let up = select(low, c, c >= low);
    return select(high, up, up <= high);
}

// Where a pixel's ray meets a triangle: its first corner where that is seen edge-on. Within the
// triangle's box, whatever the arithmetic.
fn met(triangle: u32, middle: vec2<f32>) -> vec3<f32> {
    let a = corner(triangle, 0u);
    let b = corner(triangle, 1u);
    let c = corner(triangle, 2u);
    let from_a = seen_from(a, middle);
    let from_b = seen_from(b, middle);
    let from_c = seen_from(c, middle);
    let edges = vec3(cross2(from_b, from_c), cross2(from_c, from_a), cross2(from_a, from_b));
    let way = sign(edges.x + edges.y + edges.z);
    let weights = max(way * edges, vec3(0.0));
    let total = weights.x + weights.y + weights.z;
    if !(total > 0.0) {
        return a;
    }
    let point = a + ((weights.y / total) * (b - a) + (weights.z / total) * (c - a));
    return kept_in(rounded(point), min(a, min(b, c)), max(a, max(b, c)));
}

// What a pixel sees of a triangle, moved off it to the side that is seen.
fn surface_of(triangle: u32, pixel: u32) -> Surface {
    let place = vec2(pixel % view.width, pixel / view.width);
    var point = met(triangle, vec2<f32>(place) + 0.5);
    let away = sign_along(triangle, to_viewer(corner(triangle, 0u))) < 0;
    let axis = faces[triangle].axis;
    if axis != 0 {
        let up = (axis > 0) != away;
        point[abs(axis) - 1] += select(-1.0, 1.0, up) * f32(parameters.offset);
    }
    return Surface(point, 2u * triangle + u32(away));
}
