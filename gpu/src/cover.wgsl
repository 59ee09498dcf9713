// The pixels of a map that a triangle covers. A workgroup takes 64 triangles of a map: small ones
// by an invocation each, large ones by all of it, one after another.
// Twins: spec/src/raster.rs, whose rules these are, and spec/src/ldm/layers.rs.
//
// Edge functions fit in 32 bits: they are at most the area of a map in sub-pixels, and what wraps
// around in between does so twice (spec/src/ldm/map.rs).
//#import item
//#import maps
//#import depth

// Three for each triangle, on the lattice; the fourth numbers are not used.
@group(0) @binding(2) var<storage, read> corners: array<vec4<i32>>;

// Boxes of up to so many pixels are small.
const FEW: u32 = 16u;

struct Cover {
    // In positive orientation: x, y in sub-pixels from the map's corner, and the key.
    a: vec3<i32>,
    b: vec3<i32>,
    c: vec3<i32>,
    // Twice the area, positive unless nothing is covered.
    area: i32,
    // The smallest edge values of a covered sample.
    least: vec3<i32>,
    // Number of the map's first pixel in the batch, and its pixels a row.
    first: u32,
    width: u32,
    // Pixels of the box: the first, how many, where it stands, and from one to the next.
    low: vec2<i32>,
    size: vec2<u32>,
    at: vec2<u32>,
    stride: vec2<u32>,
    // Pixels that are still to be looked at.
    left: u32,
}

// Twice the signed area of a, b, point.
fn edge(a: vec3<i32>, b: vec3<i32>, point: vec2<i32>) -> i32 {
    return (b.x - a.x) * (point.y - a.y) - (b.y - a.y) * (point.x - a.x);
}

// 0 on a top or left edge, else 1: the smallest edge value of a covered sample.
fn least(a: vec3<i32>, b: vec3<i32>) -> i32 {
    let top_left = b.y < a.y || (b.y == a.y && b.x > a.x);
    return select(1, 0, top_left);
}

fn sample(pixel: vec2<i32>) -> vec2<i32> {
    return (pixel << vec2(told.bits)) + (1 << (told.bits - 1u));
}

// Of corners in any orientation, all pixels of the box that are in the map and the rows to be drawn.
fn cover_of(map: Map, a: vec3<i32>, b: vec3<i32>, c: vec3<i32>) -> Cover {
    let half = 1 << (told.bits - 1u);
    let low = min(a.xy, min(b.xy, c.xy));
    let high = max(a.xy, max(b.xy, c.xy));
    let begin = vec2(0, i32(told.first_row));
    let end = vec2(i32(map.width), i32(min(map.height, told.first_row + told.rows)));
    // Shifts round down, also below zero: the first at or after `low`, the last up to `high`.
    let first = max(begin, (low + (half - 1)) >> vec2(told.bits));
    let last = min(end - 1, (high - half) >> vec2(told.bits));
    var cover: Cover;
    cover.low = first;
    cover.size = vec2<u32>(max(last - first + 1, vec2(0)));
    cover.left = cover.size.x * cover.size.y;
    cover.stride = vec2(1u, 0u);
    cover.first = map.first - told.first_pixel;
    cover.width = map.width;
    if cover.left == 0u {
        return cover;
    }
    cover.a = a;
    cover.b = b;
    cover.c = c;
    cover.area = edge(a, b, c.xy);
    if cover.area < 0 {
        cover.b = c;
        cover.c = b;
        cover.area = -cover.area;
    }
    if cover.area == 0 {
        cover.left = 0u;
    }
    cover.least = vec3(least(cover.b, cover.c), least(cover.c, cover.a), least(cover.a, cover.b));
    return cover;
}

fn pixel_of(cover: Cover) -> vec2<i32> {
    return cover.low + vec2<i32>(cover.at);
}

fn edges(cover: Cover) -> vec3<i32> {
    let point = sample(pixel_of(cover));
    return vec3(edge(cover.b, cover.c, point), edge(cover.c, cover.a, point), edge(cover.a, cover.b, point));
}

fn covers(cover: Cover, edges: vec3<i32>) -> bool {
    return all(edges >= cover.least);
}

// The pixel where it stands, among those of the batch.
fn number(cover: Cover) -> u32 {
    let pixel = vec2<u32>(pixel_of(cover));
    return cover.first + pixel.y * cover.width + pixel.x;
}

// Edge values of a covered sample add up to the area.
fn key_at(cover: Cover, edges: vec3<i32>) -> u32 {
    let z = vec3<u32>(vec3(cover.a.z, cover.b.z, cover.c.z));
    return depth_key(z, wide(cover.area), wide(edges.x), wide(edges.y), wide(edges.z));
}

fn onward(given: Cover) -> Cover {
    var cover = given;
    cover.left -= 1u;
    cover.at += cover.stride;
    if cover.at.x >= cover.size.x {
        cover.at.x -= cover.size.x;
        cover.at.y += 1u;
    }
    return cover;
}

// Large triangles of a workgroup.
var<workgroup> waiting: array<array<vec3<i32>, 3>, 64>;
var<workgroup> all_waiting: atomic<u32>;

// The map of a workgroup, and the triangle of an invocation: beyond all maps or triangles, nothing.
struct Share {
    map: u32,
    triangle: u32,
}

fn share_of(chunk: u32, lane: u32) -> Share {
    let chunks = (told.triangles + WORKGROUP - 1u) / WORKGROUP;
    return Share(told.first_map + chunk / chunks, chunk % chunks * WORKGROUP + lane);
}

// An invocation's own triangle, if it is small. Large ones wait for the whole workgroup, all of
// which comes along.
fn own(chunk: u32, lane: u32) -> Cover {
    let share = share_of(chunk, lane);
    var cover: Cover;
    if share.map < told.first_map + told.maps && share.triangle < told.triangles {
        let map = maps[share.map];
        var placed: array<vec3<i32>, 3>;
        for (var i = 0u; i < 3u; i += 1u) {
            let point = corners[3u * share.triangle + i].xyz;
            placed[i] = vec3(column_and_row(map, point), key_of(map, point));
        }
        cover = cover_of(map, placed[0], placed[1], placed[2]);
        if cover.left > FEW {
            waiting[atomicAdd(&all_waiting, 1u)] = placed;
            cover.left = 0u;
        }
    }
    workgroupBarrier();
    return cover;
}

// How many triangles wait for the workgroup, after that.
fn shared_ones() -> u32 {
    return atomicLoad(&all_waiting);
}

// An invocation's pixels of one of them: neighbours look at neighbours.
fn shared_one(chunk: u32, i: u32, lane: u32) -> Cover {
    let placed = waiting[i];
    var cover = cover_of(maps[share_of(chunk, lane).map], placed[0], placed[1], placed[2]);
    let total = cover.left;
    cover.left = 0u;
    if lane < total {
        cover.left = (total - lane + WORKGROUP - 1u) / WORKGROUP;
        cover.at = vec2(lane % cover.size.x, lane / cover.size.x);
        cover.stride = vec2(WORKGROUP % cover.size.x, WORKGROUP / cover.size.x);
    }
    return cover;
}
