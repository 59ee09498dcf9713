// Raster stage: every pixel with a covered sample of every triangle, as a stream, on two paths.
//
// Compute: an invocation walks a row of a triangle, or shares it. Fragment: the hardware
// rasterises the same snapped triangles, the shader evaluates only the key.
// Twin: spec/src/raster.rs.

//#import counter
//#import drawn
//#import place
//#import walk

// Covered pixels, in no particular order.
@group(0) @binding(6) var<storage, read_write> stream: array<Fragment>;

fn append(fragment: Fragment) {
    let address = claim();
    if address < frame.capacity {
        stream[address] = fragment;
    }
}

@compute @workgroup_size(WORKGROUP)
fn cover(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= frame.items {
        return;
    }
    var walk = start(id.x);
    while advance(&walk) {
        append(walk.fragment);
    }
}

@fragment
fn cover_fragment(drawn: Drawn) {
    let fragment = fragment_of(drawn);
    // What lies in no row of the band was not asked for.
    if fragment.pixel < band_pixels() {
        append(fragment);
    }
}
