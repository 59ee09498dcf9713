// Vertex stages: transform, clip, snap. Twin: spec/src/vertex.rs.
//
// One invocation per vertex, then one per triangle of the batch. Polygons are
// written to slots of fixed size; the host turns their counts into offsets, and
// `snap` compacts them, so that the result does not depend on who ran first.

//#import frame

// A triangle clipped by six planes has at most this many corners.
const CORNERS_MAX: u32 = 9u;

// Depth 1: the paper's int(saturate(z) * 0x7fffffff) overflows where f32 rounds the
// factor to 2^31.
const DEPTH_ONE: i32 = 0x7fffffff;
const DEPTH_SCALE: f32 = 2147483648.0;

// Smallest normal number.
const NORMAL_MIN: f32 = 0x1p-126;

struct Vertex {
    x: f32,
    y: f32,
    z: f32,
    instance: u32,
}

// Homogeneous pixels from object space, four rows an instance.
@group(0) @binding(1) var<storage, read> matrices: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read> vertices: array<Vertex>;
@group(0) @binding(3) var<storage, read_write> positions: array<vec4<f32>>;

// Three rows of `positions` for each triangle of the batch.
@group(0) @binding(4) var<storage, read> triangles: array<u32>;

// Corners of each triangle after clipping; more than CORNERS_MAX: it did not fit.
@group(0) @binding(5) var<storage, read_write> counts: array<u32>;

// CORNERS_MAX slots a triangle.
@group(0) @binding(6) var<storage, read_write> polygons: array<vec4<f32>>;

// Where each triangle's corners go.
@group(0) @binding(7) var<storage, read> offsets: array<u32>;

// x and y in sub-pixels and the depth key of each corner.
@group(0) @binding(8) var<storage, read_write> snapped: array<i32>;

fn row_times(row: vec4<f32>, v: Vertex) -> f32 {
    return row.x * v.x + row.y * v.y + row.z * v.z + row.w;
}

@compute @workgroup_size(WORKGROUP)
fn transform(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= frame.items {
        return;
    }
    let at = frame.work_first + id.x;
    let v = vertices[at];
    let m = 4u * v.instance;
    positions[at] = vec4(
        row_times(matrices[m], v),
        row_times(matrices[m + 1u], v),
        row_times(matrices[m + 2u], v),
        row_times(matrices[m + 3u], v),
    );
}

// Signed distance from a plane, up to a positive factor; kept where not negative.
// Near comes first: behind it w is positive and the others are meaningful.
fn distance_to(plane: u32, p: vec4<f32>) -> f32 {
    switch plane {
        case 0u: { return p.z; }
        case 1u: { return p.w - p.z; }
        case 2u: { return p.x - f32(frame.guard_x) * p.w; }
        case 3u: { return f32(frame.guard_x + GUARD) * p.w - p.x; }
        case 4u: { return p.y - f32(frame.guard_y) * p.w; }
        default: { return f32(frame.guard_y + GUARD) * p.w - p.y; }
    }
}

// A total order of positions by their numbers alone.
fn precedes(a: vec4<f32>, b: vec4<f32>) -> bool {
    if a.x != b.x { return a.x < b.x; }
    if a.y != b.y { return a.y < b.y; }
    if a.z != b.z { return a.z < b.z; }
    return a.w < b.w;
}

// The point between a and b where the distance is zero. da and db have different
// signs, so that the fraction lies in [0, 1]; WGSL promises no quotient by subnormal
// numbers, and there any point of the edge will do.
fn crossing(a: vec4<f32>, da: f32, b: vec4<f32>, db: f32) -> vec4<f32> {
    let apart = da - db;
    let defined = abs(apart) >= NORMAL_MIN;
    let t = select(0.0, clamp(da / select(1.0, apart, defined), 0.0, 1.0), defined);
    return a + t * (b - a);
}

// The same point whichever of two neighbours asks.
fn canonical_crossing(a: vec4<f32>, da: f32, b: vec4<f32>, db: f32) -> vec4<f32> {
    if precedes(a, b) {
        return crossing(a, da, b, db);
    }
    return crossing(b, db, a, da);
}

// Most triangles need no cutting: 3 corners are left of what lies inside all planes,
// none of what lies outside one; CUT stands for the others.
const CUT: u32 = 0xffffffffu;

fn place_of(a: vec4<f32>, b: vec4<f32>, c: vec4<f32>) -> u32 {
    var inside = a.w > 0.0 && b.w > 0.0 && c.w > 0.0;
    for (var plane = 0u; plane < 6u; plane++) {
        let da = distance_to(plane, a);
        let db = distance_to(plane, b);
        let dc = distance_to(plane, c);
        if da < 0.0 && db < 0.0 && dc < 0.0 {
            return 0u;
        }
        inside = inside && da >= 0.0 && db >= 0.0 && dc >= 0.0;
    }
    return select(CUT, 3u, inside);
}

struct Polygon {
    count: u32,
    corners: array<vec4<f32>, CORNERS_MAX>,
}

// Counts what it has no room for.
fn push(polygon: ptr<function, Polygon>, corner: vec4<f32>) {
    let at = (*polygon).count;
    if at < CORNERS_MAX {
        (*polygon).corners[at] = corner;
    }
    (*polygon).count = at + 1u;
}

// Sutherland and Hodgman 1974: the part of a polygon on the plane's inner side.
fn cut(plane: u32, polygon: ptr<function, Polygon>) {
    let count = (*polygon).count;
    var distances: array<f32, CORNERS_MAX>;
    var outside = false;
    for (var i = 0u; i < count; i++) {
        let d = distance_to(plane, (*polygon).corners[i]);
        distances[i] = d;
        outside = outside || d < 0.0;
    }
    if !outside {
        return;
    }
    var kept: Polygon;
    for (var i = 0u; i < count; i++) {
        let j = select(i + 1u, 0u, i + 1u == count);
        let a = (*polygon).corners[i];
        let b = (*polygon).corners[j];
        let da = distances[i];
        let db = distances[j];
        if da >= 0.0 {
            push(&kept, a);
        }
        if (da >= 0.0) != (db >= 0.0) {
            push(&kept, canonical_crossing(a, da, b, db));
        }
    }
    *polygon = kept;
}

@compute @workgroup_size(WORKGROUP)
fn clip(@builtin(global_invocation_id) id: vec3<u32>) {
    let t = id.x;
    if t >= frame.items {
        return;
    }
    let a = positions[triangles[3u * t]];
    let b = positions[triangles[3u * t + 1u]];
    let c = positions[triangles[3u * t + 2u]];
    let place = place_of(a, b, c);
    if place != CUT {
        polygons[CORNERS_MAX * t] = a;
        polygons[CORNERS_MAX * t + 1u] = b;
        polygons[CORNERS_MAX * t + 2u] = c;
        counts[t] = place;
        return;
    }
    var polygon: Polygon;
    push(&polygon, a);
    push(&polygon, b);
    push(&polygon, c);
    for (var plane = 0u; plane < 6u && polygon.count <= CORNERS_MAX; plane++) {
        cut(plane, &polygon);
    }
    var count = polygon.count;
    // Fewer than three corners are left only of a triangle without area.
    var visible = count >= 3u;
    for (var i = 0u; i < min(count, CORNERS_MAX); i++) {
        let corner = polygon.corners[i];
        visible = visible && corner.w > 0.0;
        polygons[CORNERS_MAX * t + i] = corner;
    }
    counts[t] = select(0u, count, visible);
}

// The nearest sub-pixel, ties to even, within the guard. Both ends of the guard
// are multiples of a sub-pixel below 2^24, exact in f32.
fn snapped_to(pixels: f32, guard: i32) -> i32 {
    let first = f32(guard << frame.bits);
    let last = f32((guard + GUARD) << frame.bits);
    return i32(clamp(round(pixels * f32(1u << frame.bits)), first, last));
}

fn depth_key(depth: f32) -> i32 {
    if depth >= 1.0 {
        return DEPTH_ONE;
    }
    return i32(max(depth, 0.0) * DEPTH_SCALE);
}

@compute @workgroup_size(WORKGROUP)
fn snap(@builtin(global_invocation_id) id: vec3<u32>) {
    let t = id.x;
    if t >= frame.items {
        return;
    }
    for (var i = 0u; i < counts[t]; i++) {
        let p = polygons[CORNERS_MAX * t + i];
        let at = 3u * (offsets[t] + i);
        snapped[at] = snapped_to(p.x / p.w, frame.guard_x);
        snapped[at + 1u] = snapped_to(p.y / p.w, frame.guard_y);
        snapped[at + 2u] = depth_key(p.z / p.w);
    }
}
