// The kernels of regions.wgsl for pixels with several samples on the fragment path, and its picture of such
// pixels on every path.
//#import drawn_samples for drawn
//#import regions
//#import sampled

// As regions_blend.
@compute @workgroup_size(WORKGROUP)
fn regions_blend_samples(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= band_pixels() {
        return;
    }
    let begins = progress.pixels[id.x].run == 0u;
    var p = under_way(id.x);
    if p.state == DONE {
        return;
    }
    if begins {
        begin_turn();
    } else {
        resume_turn(id.x);
    }
    for (var i = 0u; i < SAMPLED && p.left_size < listing.layers && p.left != EOL; i += 1u) {
        let node = nodes[p.left];
        under_turn(id.x, node.key, face_of(node.prim, node.mask), faces[node.prim]);
        p.left = node.next;
        p.left_size += 1u;
    }
    if p.left_size < listing.layers && p.left != EOL {
        atomicStore(&progress.unfinished, 1u);
        leave_turn(id.x);
    } else {
        end_turn(id.x);
        p.state = DONE;
    }
    progress.pixels[id.x] = p;
}
