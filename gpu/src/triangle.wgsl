// A triangle on the integer grid: edge functions, the top-left rule, depth keys.
// Twin: `Setup` in spec/src/raster.rs.

//#import frame
//#import depth

// Nine numbers a triangle: x, y in sub-pixels and the depth key of each corner.
@group(0) @binding(1) var<storage, read> corners: array<i32>;

// The triangles to draw: x is a triangle, y the walks over all triangles of the
// batch that come before it.
@group(0) @binding(2) var<storage, read> work: array<vec2<u32>>;

// Colour and opacity of each triangle.
@group(0) @binding(3) var<storage, read> faces: array<vec4<f32>>;

// One pixel that a triangle covers a sample of.
struct Fragment {
    pixel: u32,     // within the band, row-major
    prim: u32,
    key: u32,       // at the lowest covered sample
    mask: u32,      // bit s: sample s is covered
}

struct Setup {
    a: vec3<i32>,
    b: vec3<i32>,
    c: vec3<i32>,
    area: Wide,     // twice the area, positive unless the triangle is empty
    empty: bool,
}

fn corner(prim: u32, i: u32) -> vec3<i32> {
    let at = 9u * prim + 3u * i;
    return vec3(corners[at], corners[at + 1u], corners[at + 2u]);
}

// Twice the signed area of a, b, point.
fn edge(a: vec3<i32>, b: vec3<i32>, point: vec2<i32>) -> Wide {
    return wide_sub(
        wide_mul(b.x - a.x, point.y - a.y),
        wide_mul(b.y - a.y, point.x - a.x),
    );
}

// Corners in positive orientation.
fn prepare(prim: u32) -> Setup {
    let a = corner(prim, 0u);
    let b = corner(prim, 1u);
    let c = corner(prim, 2u);
    let area = edge(a, b, c.xy);
    if wide_negative(area) {
        return Setup(a, c, b, wide_sub(wide(0), area), false);
    }
    return Setup(a, b, c, area, wide_is_zero(area));
}

// 0 on a top or left edge, else 1: the smallest edge value of a covered sample.
fn least(a: vec3<i32>, b: vec3<i32>) -> i32 {
    let top_left = b.y < a.y || (b.y == a.y && b.x > a.x);
    return select(1, 0, top_left);
}

// Depth keys of the corners.
fn depths(s: Setup) -> vec3<u32> {
    return vec3<u32>(vec3(s.a.z, s.b.z, s.c.z));
}

// Most samples of a pixel.
const SAMPLES_MAX: u32 = 8u;

// The mask of all samples.
fn all_samples() -> u32 {
    return (1u << frame.samples) - 1u;
}

// Where a sample lies within its pixel, in sub-pixels.
fn sample_place(s: u32) -> vec2<i32> {
    let place = frame.places[s / 4u][s % 4u];
    return vec2(i32(place & 0xffffu), i32(place >> 16u));
}

// A sample of a pixel of the target, in sub-pixels.
fn sample_at(x: u32, y: u32, s: u32) -> vec2<i32> {
    return vec2<i32>(vec2(x, y) << vec2(frame.bits)) + sample_place(s);
}

// The key of `prim` at a sample of a pixel of the band; `otherwise` where it does not cover
// that, which only a kernel with a defect says it does.
fn key_at(prim: u32, pixel: u32, sample: u32, otherwise: u32) -> u32 {
    let s = prepare(prim);
    let x = pixel % frame.width;
    let point = sample_at(x, frame.first_row + pixel / frame.width, sample);
    let ea = edge(s.b, s.c, point);
    let eb = edge(s.c, s.a, point);
    let ec = edge(s.a, s.b, point);
    if s.empty || wide_negative(wide_sub(ea, wide(least(s.b, s.c))))
        || wide_negative(wide_sub(eb, wide(least(s.c, s.a))))
        || wide_negative(wide_sub(ec, wide(least(s.a, s.b)))) {
        return otherwise;
    }
    return depth_key(depths(s), s.area, ea, eb, ec);
}

// The fragment of `prim` at a pixel of which the hardware says that these samples are covered.
fn fragment_with(prim: u32, x: u32, y: u32, mask: u32) -> Fragment {
    let s = prepare(prim);
    let point = sample_at(x, y, min(firstTrailingBit(mask), SAMPLES_MAX - 1u));
    let ea = edge(s.b, s.c, point);
    let eb = edge(s.c, s.a, point);
    let ec = edge(s.a, s.b, point);
    let pixel = (y - frame.first_row) * frame.width + x;
    // Outside the triangle a key means nothing; the comparison reports coverage.
    if s.empty || wide_negative(ea) || wide_negative(eb) || wide_negative(ec) {
        return Fragment(pixel, prim, u32(s.a.z), mask);
    }
    return Fragment(pixel, prim, depth_key(depths(s), s.area, ea, eb, ec), mask);
}

// The same of a pixel with one sample.
fn fragment_at(prim: u32, x: u32, y: u32) -> Fragment {
    return fragment_with(prim, x, y, 1u);
}
