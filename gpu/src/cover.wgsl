// The pixels of a map that triangles cover. A workgroup takes 64 triangles of a map: it leaves out
// those whose box holds no middle of a pixel, as most are small; of what is left, its invocations
// share the pixels of all boxes.
// Twins: spec/src/raster.rs, whose rules these are, and spec/src/ldm/layers.rs.
//
// Edge functions fit in 32 bits: they are at most the area of a map in sub-pixels, and what wraps
// around in between does so twice (spec/src/ldm/map.rs).
//#import item
//#import maps
//#import depth
//#import scan

// Three for each triangle, on the lattice; the fourth numbers are not used.
@group(0) @binding(2) var<storage, read> corners: array<vec4<i32>>;

// A triangle in positive orientation: x, y in sub-pixels from the map's corner, and the key.
struct Held {
    a: vec3<i32>,
    // The first pixel of its box, and pixels a row.
    column: i32,
    b: vec3<i32>,
    row: i32,
    c: vec3<i32>,
    width: u32,
}

var<workgroup> held: array<Held, 64>;

// Pixels of the boxes of all triangles before each, and of all.
var<workgroup> firsts: array<u32, 64>;
var<workgroup> all_pixels: u32;

// Triangles whose boxes may hold the middle of a pixel.
var<workgroup> chosen: array<u32, 64>;
var<workgroup> all_chosen: atomic<u32>;

// What a workgroup draws into which maps.
struct Job {
    first_map: u32,
    end: u32,
    // The triangle of an invocation, if there is one.
    triangle: u32,
    exists: bool,
}

// Corners are read once for all maps of a job.
fn job_of(chunk: u32, lane: u32) -> Job {
    let chunks = max((told.triangles + WORKGROUP - 1u) / WORKGROUP, 1u);
    let first = chunk / chunks * told.at_once;
    let triangle = chunk % chunks * WORKGROUP + lane;
    return Job(
        told.first_map + min(first, told.maps),
        told.first_map + min(first + told.at_once, told.maps),
        triangle,
        triangle < told.triangles,
    );
}

struct Triangle {
    a: vec3<i32>,
    b: vec3<i32>,
    c: vec3<i32>,
}

fn triangle_of(job: Job) -> Triangle {
    let at = 3u * min(job.triangle, told.triangles - 1u);
    return Triangle(corners[at].xyz, corners[at + 1u].xyz, corners[at + 2u].xyz);
}

// Pixels of which a box from `low` to `high`, in sub-pixels, holds the middle.
struct Box {
    first: vec2<i32>,
    last: vec2<i32>,
}

fn half_pixel() -> i32 {
    return 1 << (told.bits - 1u);
}

// Shifts round down, also below zero: the first middle at or after `low`, the last up to `high`.
fn box_of(map: Map, low: vec2<i32>, high: vec2<i32>) -> Box {
    let begin = vec2(0, i32(told.first_row));
    let end = vec2(i32(map.width), i32(min(map.height, told.first_row + told.rows)));
    let first = (low + (half_pixel() - 1)) >> vec2(told.bits);
    let last = (high - half_pixel()) >> vec2(told.bits);
    return Box(max(first, begin), min(last, end - 1));
}

fn is_empty(box: Box) -> bool {
    return any(box.first > box.last);
}

// Whether a triangle's box may hold a middle: in f32, and one sub-pixel wider to each side.
//
// Corners less the lowest one drawn are exact. The products of a place add up to at most the scene's
// diagonal, 46,340 sub-pixels, and so does the base; conversions, products and sums are off by at most
// 6 U of both together, 0.07 sub-pixels for U = 2^-23, the base by 0.01. An exact place is rounded by
// half. Floor takes less than one more off, below, and two are added above.
fn may_cover(map: Map, triangle: Triangle) -> bool {
    let scale = ldexp(1.0, -i32(told.shift));
    let columns = vec3<f32>(map.columns) * scale;
    let rows = vec3<f32>(map.rows) * scale;
    let lowest = vec3(told.low_x, told.low_y, told.low_z);
    let a = vec3<f32>(triangle.a - lowest);
    let b = vec3<f32>(triangle.b - lowest);
    let c = vec3<f32>(triangle.c - lowest);
    let x = vec3(dot(columns, a), dot(columns, b), dot(columns, c)) + map.base.x;
    let y = vec3(dot(rows, a), dot(rows, b), dot(rows, c)) + map.base.y;
    let low = vec2(min(x.x, min(x.y, x.z)), min(y.x, min(y.y, y.z)));
    let high = vec2(max(x.x, max(x.y, x.z)), max(y.x, max(y.y, y.z)));
    return !is_empty(box_of(map, vec2<i32>(floor(low)) - 1, vec2<i32>(floor(high)) + 2));
}

fn place_of(map: Map, point: vec3<i32>) -> vec3<i32> {
    return vec3(column_and_row(map, point), 0);
}

// Twice the signed area of a, b, point.
fn edge(a: vec3<i32>, b: vec3<i32>, point: vec2<i32>) -> i32 {
    return (b.x - a.x) * (point.y - a.y) - (b.y - a.y) * (point.x - a.x);
}

// Holds a triangle, if it has an area, and gives the number of pixels of its box.
fn hold(map: Map, number: u32, lane: u32, with_keys: bool) -> u32 {
    let points = Triangle(corners[3u * number].xyz, corners[3u * number + 1u].xyz, corners[3u * number + 2u].xyz);
    var a = place_of(map, points.a);
    var b = place_of(map, points.b);
    var c = place_of(map, points.c);
    let area = edge(a, b, c.xy);
    let box = box_of(map, min(a.xy, min(b.xy, c.xy)), max(a.xy, max(b.xy, c.xy)));
    if area == 0 || is_empty(box) {
        return 0u;
    }
    if with_keys {
        a.z = key_of(map, points.a);
        b.z = key_of(map, points.b);
        c.z = key_of(map, points.c);
    }
    let size = vec2<u32>(box.last - box.first + 1);
    held[lane] = Held(a, box.first.x, b, box.first.y, c, size.x);
    if area < 0 {
        held[lane].b = c;
        held[lane].c = b;
    }
    return size.x * size.y;
}

// Looks at the triangles of a job, and gives the number of pixels to be shared. All of a workgroup
// come along.
fn look(map: Map, job: Job, triangle: Triangle, lane: u32, with_keys: bool) -> u32 {
    if lane == 0u {
        atomicStore(&all_chosen, 0u);
    }
    workgroupBarrier();
    if job.exists {
        if may_cover(map, triangle) {
            chosen[atomicAdd(&all_chosen, 1u)] = job.triangle;
        }
    }
    workgroupBarrier();
    var pixels = 0u;
    if lane < atomicLoad(&all_chosen) {
        pixels = hold(map, chosen[lane], lane, with_keys);
    }
    let before = parts_before(lane, pixels);
    firsts[lane] = before;
    if lane == WORKGROUP - 1u {
        all_pixels = before + pixels;
    }
    return workgroupUniformLoad(&all_pixels);
}

// A pixel of a triangle's box.
struct Sample {
    is_covered: bool,
    // Among those of the batch.
    pixel: u32,
    // The triangle, and its edge values there.
    held: u32,
    edges: vec3<i32>,
}

// Of all triangles held, the last that begins at or before a pixel.
fn holder(i: u32) -> u32 {
    var at = 0u;
    at += select(0u, 32u, firsts[at + 32u] <= i);
    at += select(0u, 16u, firsts[at + 16u] <= i);
    at += select(0u, 8u, firsts[at + 8u] <= i);
    at += select(0u, 4u, firsts[at + 4u] <= i);
    at += select(0u, 2u, firsts[at + 2u] <= i);
    at += select(0u, 1u, firsts[at + 1u] <= i);
    return at;
}

// 0 on a top or left edge, else 1: the smallest edge value of a covered sample.
fn least(a: vec3<i32>, b: vec3<i32>) -> i32 {
    let top_left = b.y < a.y || (b.y == a.y && b.x > a.x);
    return select(1, 0, top_left);
}

fn sample_of(map: Map, i: u32) -> Sample {
    let at = holder(i);
    let own = held[at];
    let number = i - firsts[at];
    let pixel = vec2(own.column, own.row) + vec2<i32>(vec2(number % own.width, number / own.width));
    let middle = (pixel << vec2(told.bits)) + half_pixel();
    let edges = vec3(
        edge(own.b, own.c, middle),
        edge(own.c, own.a, middle),
        edge(own.a, own.b, middle),
    );
    let least = vec3(least(own.b, own.c), least(own.c, own.a), least(own.a, own.b));
    let first = map.first - told.first_pixel;
    return Sample(all(edges >= least), first + u32(pixel.y) * map.width + u32(pixel.x), at, edges);
}

// Edge values of a covered sample add up to the area.
fn key_at(sample: Sample) -> u32 {
    let own = held[sample.held];
    let z = vec3<u32>(vec3(own.a.z, own.b.z, own.c.z));
    let area = sample.edges.x + sample.edges.y + sample.edges.z;
    return depth_key(z, wide(area), wide(sample.edges.x), wide(sample.edges.y), wide(sample.edges.z));
}
