// A-buffer build as another engine might have it, with the bindings that
// `triptych replay --kernel build=?` prints. It holds a defect that is often shipped.
//
// To save memory it keeps eight fragments a pixel. It means the nearest eight and keeps
// the first eight that arrive, so what is seen depends on the order of triangles. It
// counts them by following the list that it is building, too, which nothing orders.

// The walk over a triangle's row, with frame, corners, work and faces (bindings 0 to 3).
//#import walk

@group(0) @binding(4) var<storage, read_write> next_free: atomic<u32>;
@group(0) @binding(5) var<storage, read_write> depth: array<atomic<u32>>;
@group(0) @binding(7) var<storage, read_write> heads: array<atomic<u32>>;
// x: depth, y: next, z: triangle, w: coverage
@group(0) @binding(8) var<storage, read_write> nodes: array<vec4<u32>>;
@group(0) @binding(9) var<storage, read_write> colours: array<vec4<f32>>;

const LAYERS = 8u;

fn is_full(pixel: u32) -> bool {
    var at = atomicLoad(&heads[pixel]);
    var layers = 0u;
    while at < frame.capacity && layers < LAYERS {
        at = nodes[at].y;
        layers += 1u;
    }
    return layers == LAYERS;
}

fn store(f: Fragment) {
    if frame.depth_test != 0u && f.key >= atomicLoad(&depth[f.pixel]) {
        return;
    }
    if is_full(f.pixel) {
        return;     // the defect: this fragment may be nearer than the eight
    }
    let at = atomicAdd(&next_free, 1u);
    if at >= frame.capacity {
        return;
    }
    let next = atomicExchange(&heads[f.pixel], at);
    nodes[at] = vec4(f.key, next, f.prim, f.mask);
    colours[at] = faces[f.prim];
}

@compute @workgroup_size(64)
fn build(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= frame.items {
        return;
    }
    var row = start(id.x);
    while advance(&row) {
        store(row.fragment);
    }
}

@fragment
fn build_fragment(@builtin(position) at: vec4<f32>, @location(0) @interpolate(flat) prim: u32) {
    let pixel = vec2<u32>(at.xy);
    store(fragment_at(prim, pixel.x, pixel.y));
}
