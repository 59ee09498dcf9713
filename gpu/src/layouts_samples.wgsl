// The kernels of layouts.wgsl for pixels with several samples on the fragment path, and its picture of such
// pixels on every path.
//#import drawn_samples for drawn
//#import layouts
//#import sampled

// As rank_blend.
@compute @workgroup_size(WORKGROUP)
fn rank_blend_samples(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= band_pixels() {
        return;
    }
    enter_turn(id.x, (listing.flags & BEGINS) != 0u);
    let own = entries_of(id.x);
    let shown = shown_entries(id.x, own.y, SAMPLED);
    for (var i = shown.x; i < shown.y; i += 1u) {
        let entry = listed[own.x + i];
        under_turn(id.x, entry.x, entry.y, faces[entry.y >> MASK_BITS]);
    }
    leave_turn(id.x, (listing.flags & ENDS) != 0u);
}
