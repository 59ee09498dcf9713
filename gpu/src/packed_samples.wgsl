// The kernels of packed.wgsl for pixels with several samples on the fragment path, and its picture of such
// pixels on every path.
//#import drawn_samples for drawn
//#import packed
//#import sampled
//#import followed_samples

fn face_of_node(at: u32) -> u32 {
    return packed_nodes[at].face;
}

fn layer_of_node(at: u32) -> vec4<f32> {
    return colour_of_node(at);
}

// As packed_resolve; heads are taken in the last turn, and the counter after it.
@compute @workgroup_size(WORKGROUP)
fn packed_resolve_samples(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= band_pixels() {
        return;
    }
    var head = EOL;
    if progress.pixels[id.x].run == 0u {
        head = atomicLoad(&heads[id.x]) - 1u;
        if turn_end() == frame.samples {
            atomicStore(&heads[id.x], 0u);
        }
    }
    blend_list_samples(id.x, head);
}

@compute @workgroup_size(WORKGROUP)
fn packed_taken_samples(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x == 0u {
        atomicStore(&counter, 0u);
    }
}
