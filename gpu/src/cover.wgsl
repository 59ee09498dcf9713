// The pixels of a map that triangles cover. Small triangles are drawn by an invocation each, large
// ones by a workgroup each; which is which does not depend on the map.
// Twins: spec/src/raster.rs, whose rules these are, and spec/src/ldm/layers.rs.
//#import item
//#import maps
//#import depth

// Three for each triangle, on the lattice; the fourth numbers are not used.
@group(0) @binding(2) var<storage, read> corners: array<vec4<i32>>;

// Large triangles, in whatever order invocations come; `unfinished` counts them.
@group(0) @binding(18) var<storage, read_write> larges: array<u32>;

struct Triangle {
    a: vec3<i32>,
    b: vec3<i32>,
    c: vec3<i32>,
}

fn triangle_of(number: u32) -> Triangle {
    return Triangle(corners[3u * number].xyz, corners[3u * number + 1u].xyz, corners[3u * number + 2u].xyz);
}

// Whether its box is longer than told.small along an axis of the lattice.
fn is_large(triangle: Triangle) -> bool {
    let low = min(triangle.a, min(triangle.b, triangle.c));
    let high = max(triangle.a, max(triangle.b, triangle.c));
    return any(high - low > vec3(told.small));
}

// A triangle in a map.
struct Cover {
    // In positive orientation: x, y in sub-pixels from the map's corner, and the key.
    a: vec3<i32>,
    // The first pixel of its box, and pixels a row; none if nothing is covered.
    column: i32,
    b: vec3<i32>,
    row: i32,
    c: vec3<i32>,
    width: u32,
    // Pixels of its box.
    pixels: u32,
}

// Pixels of which a box, in sub-pixels, holds the middle.
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
    let lowest = vec3(told.low_x, told.low_y, told.low_z);
    let a = vec3<f32>(triangle.a - lowest);
    let b = vec3<f32>(triangle.b - lowest);
    let c = vec3<f32>(triangle.c - lowest);
    let x = vec3(dot(map.about_columns, a), dot(map.about_columns, b), dot(map.about_columns, c)) + map.about_left;
    let y = vec3(dot(map.about_rows, a), dot(map.about_rows, b), dot(map.about_rows, c)) + map.about_top;
    let low = vec2(min(x.x, min(x.y, x.z)), min(y.x, min(y.y, y.z)));
    let high = vec2(max(x.x, max(x.y, x.z)), max(y.x, max(y.y, y.z)));
    return !is_empty(box_of(map, vec2<i32>(floor(low)) - 1, vec2<i32>(floor(high)) + 2));
}

// Twice the signed area of a, b, point. It fits in 32 bits: at most the area of the scene in
// sub-pixels; what wraps around in between does so twice (spec/src/ldm/map.rs).
fn edge(a: vec3<i32>, b: vec3<i32>, point: vec2<i32>) -> i32 {
    return (b.x - a.x) * (point.y - a.y) - (b.y - a.y) * (point.x - a.x);
}

fn cover_of(map: Map, triangle: Triangle, with_keys: bool) -> Cover {
    var a = vec3(column_and_row(map, triangle.a), 0);
    var b = vec3(column_and_row(map, triangle.b), 0);
    var c = vec3(column_and_row(map, triangle.c), 0);
    let area = edge(a, b, c.xy);
    let box = box_of(map, min(a.xy, min(b.xy, c.xy)), max(a.xy, max(b.xy, c.xy)));
    if area == 0 || is_empty(box) {
        return Cover(a, 0, b, 0, c, 0u, 0u);
    }
    if with_keys {
        a.z = key_of(map, triangle.a);
        b.z = key_of(map, triangle.b);
        c.z = key_of(map, triangle.c);
    }
    let size = vec2<u32>(box.last - box.first + 1);
    let pixels = size.x * size.y;
    if area < 0 {
        return Cover(a, box.first.x, c, box.first.y, b, size.x, pixels);
    }
    return Cover(a, box.first.x, b, box.first.y, c, size.x, pixels);
}

// A pixel of a triangle's box.
struct Sample {
    is_covered: bool,
    // Among those of the batch.
    pixel: u32,
    edges: vec3<i32>,
}

// 0 on a top or left edge, else 1: the smallest edge value of a covered sample.
fn least(a: vec3<i32>, b: vec3<i32>) -> i32 {
    let top_left = b.y < a.y || (b.y == a.y && b.x > a.x);
    return select(1, 0, top_left);
}

// Of a box of at most 726 x 726 pixels: a quotient below 726 is off by 2.5 units of its last
// place, less than 2^-12, and at least 0.5 / 726 off the next integer.
fn sample_of(map: Map, cover: Cover, i: u32) -> Sample {
    let down = u32((f32(i) + 0.5) / f32(cover.width));
    let pixel = vec2(cover.column + i32(i - down * cover.width), cover.row + i32(down));
    let middle = (pixel << vec2(told.bits)) + half_pixel();
    let edges = vec3(
        edge(cover.b, cover.c, middle),
        edge(cover.c, cover.a, middle),
        edge(cover.a, cover.b, middle),
    );
    let least = vec3(least(cover.b, cover.c), least(cover.c, cover.a), least(cover.a, cover.b));
    let first = map.first - told.first_pixel;
    return Sample(all(edges >= least), first + u32(pixel.y) * map.width + u32(pixel.x), edges);
}

// Edge values of a covered sample add up to the area.
fn key_at(cover: Cover, sample: Sample) -> u32 {
    let z = vec3<u32>(vec3(cover.a.z, cover.b.z, cover.c.z));
    let area = sample.edges.x + sample.edges.y + sample.edges.z;
    return depth_key(z, wide(area), wide(sample.edges.x), wide(sample.edges.y), wide(sample.edges.z));
}

// Maps of a workgroup that draws small triangles: corners are read once for all.
const MAPS_AT_ONCE: u32 = 8u;

// Of 64 small triangles and those maps, the pairs that may cover something: most do not, and the
// others are shared among the workgroup. Map and triangle, six bits.
var<workgroup> pairs: array<u32, 512>;
var<workgroup> all_pairs: atomic<u32>;

// The first map and the first triangle of a workgroup.
struct Job {
    map: u32,
    triangle: u32,
}

fn small_job(chunk: u32) -> Job {
    let chunks = (told.triangles + WORKGROUP - 1u) / WORKGROUP;
    return Job(chunk / chunks * MAPS_AT_ONCE, chunk % chunks * WORKGROUP);
}

// Finds pairs; all of a workgroup come along.
fn find_pairs(job: Job, lane: u32) {
    if lane == 0u {
        atomicStore(&all_pairs, 0u);
    }
    workgroupBarrier();
    if job.triangle + lane < told.triangles {
        let triangle = triangle_of(job.triangle + lane);
        let end = select(min(MAPS_AT_ONCE, told.maps - min(told.maps, job.map)), 0u, is_large(triangle));
        for (var number = 0u; number < end; number += 1u) {
            if may_cover(maps[told.first_map + job.map + number], triangle) {
                pairs[atomicAdd(&all_pairs, 1u)] = number * WORKGROUP + lane;
            }
        }
    }
    workgroupBarrier();
}

fn map_of(job: Job, pair: u32) -> Map {
    return maps[told.first_map + job.map + pair / WORKGROUP];
}

fn small_cover(map: Map, job: Job, pair: u32, with_keys: bool) -> Cover {
    return cover_of(map, triangle_of(job.triangle + pair % WORKGROUP), with_keys);
}

// Large triangles of a workgroup, in one map.
const LARGE_AT_ONCE: u32 = 16u;

var<workgroup> held: array<Cover, LARGE_AT_ONCE>;

fn large_job(chunk: u32) -> Job {
    let chunks = (told.larges + LARGE_AT_ONCE - 1u) / LARGE_AT_ONCE;
    return Job(chunk / chunks, chunk % chunks * LARGE_AT_ONCE);
}

// How many there are; all of a workgroup come along.
fn hold(job: Job, lane: u32, with_keys: bool) -> u32 {
    let count = select(0u, min(LARGE_AT_ONCE, told.larges - job.triangle), job.map < told.maps);
    if lane < count {
        let triangle = triangle_of(larges[job.triangle + lane]);
        held[lane] = cover_of(maps[told.first_map + job.map], triangle, with_keys);
    }
    workgroupBarrier();
    return count;
}
