// The kernels of ordered.wgsl for pixels with several samples on the fragment path, and its picture of such
// pixels on every path.
//#import drawn_samples for drawn
//#import ordered
//#import sampled

// As ordered_blend. A dispatch goes on from listing.first on.
@compute @workgroup_size(WORKGROUP)
fn ordered_blend_samples(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= band_pixels() {
        return;
    }
    enter_turn(id.x, (listing.flags & BEGINS) != 0u);
    var node = atomicLoad(&links[id.x]);
    for (var i = 0u; i < min(listing.first + SAMPLED, listing.layers) && node != EOL; i += 1u) {
        if i >= listing.first {
            let slot = slot_at(node);
            under_turn(id.x, slot.x, slot.y, faces[slot.y >> MASK_BITS]);
        }
        node = atomicLoad(&links[listing.links + node]);
    }
    leave_turn(id.x, (listing.flags & ENDS) != 0u);
}
