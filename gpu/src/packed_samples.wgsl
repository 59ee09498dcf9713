// The kernels of packed.wgsl for pixels with several samples on the fragment path, and its picture of such
// pixels on every path.
//#import drawn_samples for drawn
//#import packed
//#import sampled

// As packed_resolve; heads are taken in the last turn, and the counter after it.
@compute @workgroup_size(WORKGROUP)
fn packed_resolve_samples(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= band_pixels() {
        return;
    }
    let is_last = turn_end() == frame.samples;
    var p = progress.pixels[id.x];
    if p.state == DONE {
        return;
    }
    if p.run == 0u {
        let head = atomicLoad(&heads[id.x]);
        if is_last {
            atomicStore(&heads[id.x], 0u);
        }
        p = Progress(EOL, EOL, head - 1u, EOL, 0u, 0u, 1u, FIND);
        begin_turn();
    } else {
        resume_turn(id.x);
    }
    for (var i = 0u; i < SAMPLED && p.left_size < listing.layers && p.left != EOL; i += 1u) {
        let node = packed_nodes[p.left];
        under_turn(id.x, node.key, node.face, unpack(node.colour));
        p.left = node.link - 1u;
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

@compute @workgroup_size(WORKGROUP)
fn packed_taken_samples(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x == 0u {
        atomicStore(&counter, 0u);
    }
}
