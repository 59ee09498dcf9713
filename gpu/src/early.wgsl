// Fragment path, where an adapter tests depth before it runs a fragment: no fragment runs at a pixel of which
// all samples show something opaque in front of the whole triangle. What else is hidden the exact key decides,
// as without it.
//
// A triangle has one depth, that of its nearest corner, so that nothing follows from how a driver interpolates
// across a slope. Depths are keys as f32, which rounds them by less than 2^7.
//#import abuffer

// Keys that a triangle is taken to be nearer than it is. A driver that interpolates between three equal depths
// may be off by some units of 2^-24 if its weights do not add up to 1: this is 4,096 of them, and leaves a
// 4,096th of all depths to the exact key. What keys are rounded by is far less.
const DEPTH_MARGIN: i32 = 1 << 19u;

fn depth_of(key: u32) -> f32 {
    return f32(key) * power_of_half(31u);
}

@vertex
fn place_nearest(@builtin(vertex_index) index: u32) -> Placed {
    let prim = work[frame.work_first + index / 3u].x;
    let nearest = min(corner(prim, 0u).z, min(corner(prim, 1u).z, corner(prim, 2u).z));
    return placed(prim, index % 3u, depth_of(u32(max(nearest - DEPTH_MARGIN, 0))));
}

// A triangle over all of the target.
@vertex
fn place_everywhere(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    return vec4(select(-1.0, 3.0, index == 1u), select(-1.0, 3.0, index == 2u), 0.5, 1.0);
}

// The farthest of what is opaque at a pixel's samples.
@fragment
fn opaque_depth_fragment(@builtin(position) position: vec4<f32>) -> @builtin(frag_depth) f32 {
    let pixel = vec2<u32>(position.xy);
    // As in drawn_samples.wgsl: a driver may draw rows that lie beyond the scissor rectangle.
    if pixel.y - frame.first_row >= frame.rows {
        return 1.0;
    }
    let first = frame.samples * ((pixel.y - frame.first_row) * frame.width + pixel.x);
    var farthest = 0u;
    for (var s = 0u; s < frame.samples; s += 1u) {
        farthest = max(farthest, atomicLoad(&opaque_key[first + s]));
    }
    return select(depth_of(farthest), 1.0, farthest == NOTHING);
}

@fragment
@early_depth_test(force)
fn build_early_fragment(drawn: Drawn) {
    insert(fragment_of(drawn));
}
