// The kernels of regions.wgsl for pixels with several samples on the fragment path, and its picture of such
// pixels on every path.
//#import drawn_samples for drawn
//#import regions
//#import sampled
//#import followed_samples

fn face_of_node(at: u32) -> u32 {
    return face_of(nodes[at].prim, nodes[at].mask);
}

// The colour of its triangle, as samples leave no binding for colours of nodes.
fn layer_of_node(at: u32) -> vec4<f32> {
    return faces[nodes[at].prim];
}

// As regions_blend.
@compute @workgroup_size(WORKGROUP)
fn regions_blend_samples(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x < band_pixels() {
        blend_list_samples(id.x, atomicLoad(&heads[id.x]));
    }
}
