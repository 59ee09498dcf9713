// From clipped triangles to those that are rasterised, without the host, for `triptych bench`: the
// fan of each, snapped, where `corners` has it, and the walks over the rows of each triangle.
// Twin: `append_fans` in vertex.rs and `sampled_rows` and `stride` in raster/work.rs.

//#import vertex
//#import stride

// Triangles of the fan of each.
@group(0) @binding(9) var<storage, read_write> fans: array<u32>;

// Nine numbers of each.
@group(0) @binding(10) var<storage, read_write> fanned: array<i32>;

// Colour and opacity of each triangle before, and of each of a fan.
@group(0) @binding(11) var<storage, read> colours: array<vec4<f32>>;
@group(0) @binding(12) var<storage, read_write> painted: array<vec4<f32>>;

// Walks over each that is transparent, then over each that is opaque.
@group(0) @binding(13) var<storage, read_write> walks: array<u32>;

@compute @workgroup_size(WORKGROUP)
fn fan_count(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x < frame.items {
        fans[id.x] = max(counts[id.x], 2u) - 2u;
    }
}

fn snapped_corner(p: vec4<f32>) -> vec3<i32> {
    return vec3(
        snapped_to(p.x / p.w, frame.guard_x),
        snapped_to(p.y / p.w, frame.guard_y),
        depth_key(p.z / p.w),
    );
}

// Rows of the target of which a sample lies within a triangle's height.
fn rows_of(low: i32, high: i32) -> u32 {
    var highest = 0x7fffffff;
    var lowest = 0;
    for (var s = 0u; s < frame.samples; s += 1u) {
        let down = i32(frame.places[s / 4u][s % 4u] >> 16u);
        highest = min(highest, down);
        lowest = max(lowest, down);
    }
    let top = max(-((lowest - low) >> frame.bits), 0);
    let bottom = min((high - highest) >> frame.bits, i32(frame.height) - 1);
    return u32(max(bottom - top + 1, 0));
}

fn double_area(a: vec3<i32>, b: vec3<i32>, c: vec3<i32>) -> Wide {
    let area = wide_sub(wide_mul(b.x - a.x, c.y - a.y), wide_mul(b.y - a.y, c.x - a.x));
    if wide_negative(area) {
        return wide_sub(wide(0), area);
    }
    return area;
}

fn walks_of(a: vec3<i32>, b: vec3<i32>, c: vec3<i32>) -> u32 {
    let low = min(a.y, min(b.y, c.y));
    let high = max(a.y, max(b.y, c.y));
    return rows_of(low, high) * stride_of(double_area(a, b, c), high - low);
}

// Each triangle's fan, from where `offsets` has it begin. `work_count` is all that there are.
@compute @workgroup_size(WORKGROUP)
fn fan_snap(@builtin(global_invocation_id) id: vec3<u32>) {
    let t = id.x;
    if t >= frame.items {
        return;
    }
    let count = counts[t];
    if count < 3u {
        return;
    }
    let colour = colours[t];
    let opaque = select(0u, frame.work_count, colour.a >= 1.0);
    let a = snapped_corner(polygons[CORNERS_MAX * t]);
    var b = snapped_corner(polygons[CORNERS_MAX * t + 1u]);
    for (var i = 2u; i < count; i++) {
        let c = snapped_corner(polygons[CORNERS_MAX * t + i]);
        let at = offsets[t] + i - 2u;
        let first = 9u * at;
        fanned[first] = a.x;
        fanned[first + 1u] = a.y;
        fanned[first + 2u] = a.z;
        fanned[first + 3u] = b.x;
        fanned[first + 4u] = b.y;
        fanned[first + 5u] = b.z;
        fanned[first + 6u] = c.x;
        fanned[first + 7u] = c.y;
        fanned[first + 8u] = c.z;
        painted[at] = colour;
        walks[at] = 0u;
        walks[frame.work_count + at] = 0u;
        walks[opaque + at] = walks_of(a, b, c);
        b = c;
    }
}
