// A-buffer with nodes of 16 bytes: a colour of four bytes, the depth key, triangle and mask in a word,
// and the link. Yang et al. 2010, section 4.1 ("packed node formats"). Twin: spec/src/layouts/packed.rs.
//
// Links and heads are addresses plus 1, and 0 ends a list: the heads of a new buffer need no clearing.
// Nor do those of a later frame, as stage resolve's part takes each head that it reads, and the counter.
//#import listing
//#import counter
//#import followed

struct PackedNode {
    colour: u32,
    key: u32,
    face: u32,
    link: u32,
}

@group(0) @binding(7) var<storage, read_write> heads: array<atomic<u32>>;
@group(0) @binding(8) var<storage, read_write> packed_nodes: array<PackedNode>;

// To the nearest of 256 steps. Whatever lies outside of 0 to 1 is cut.
fn byte_of(channel: f32) -> u32 {
    return u32(clamp(channel, 0.0, 1.0) * 255.0 + 0.5);
}

fn pack(colour: vec4<f32>) -> u32 {
    return byte_of(colour.r)
        | (byte_of(colour.g) << 8u)
        | (byte_of(colour.b) << 16u)
        | (byte_of(colour.a) << 24u);
}

fn unpack(colour: u32) -> vec4<f32> {
    let bytes = vec4(colour & 255u, (colour >> 8u) & 255u, (colour >> 16u) & 255u, colour >> 24u);
    return vec4<f32>(bytes) / 255.0;
}

fn insert(fragment: Fragment) {
    let mask = visible(fragment);
    if mask == 0u {
        return;
    }
    let address = claim();
    if address >= frame.capacity {
        return;
    }
    let link = atomicExchange(&heads[fragment.pixel], address + 1u);
    let colour = pack(faces[fragment.prim]);
    packed_nodes[address] = PackedNode(colour, fragment.key, face_of(fragment.prim, mask), link);
}

// Stage packed, first pass: as stage build.
@compute @workgroup_size(WORKGROUP)
fn packed(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= frame.items {
        return;
    }
    var walk = start(id.x);
    while advance(&walk) {
        insert(walk.fragment);
    }
}

@fragment
fn packed_fragment(drawn: Drawn) {
    insert(fragment_of(drawn));
}

// 0 - 1 is EOL.
fn next_of(at: u32) -> u32 {
    return packed_nodes[at].link - 1u;
}

fn set_next(at: u32, next: u32) {
    packed_nodes[at].link = next + 1u;
}

fn key_of_node(at: u32) -> u32 {
    return packed_nodes[at].key;
}

fn colour_of_node(at: u32) -> vec4<f32> {
    return unpack(packed_nodes[at].colour);
}

fn before(a: u32, b: u32) -> bool {
    let x = packed_nodes[a];
    let y = packed_nodes[b];
    return x.key < y.key || (x.key == y.key && x.face < y.face);
}

// Second: as stage sort.
@compute @workgroup_size(WORKGROUP)
fn packed_sort(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= band_pixels() {
        return;
    }
    let p = relinked(progress.pixels[id.x], atomicLoad(&heads[id.x]) - 1u);
    progress.pixels[id.x] = p;
    if p.state == DONE {
        atomicStore(&heads[id.x], p.merged + 1u);
    } else {
        atomicStore(&progress.unfinished, 1u);
    }
}

// Third: as stage resolve, of listing.layers layers at most. Lists are empty afterwards.
@compute @workgroup_size(WORKGROUP)
fn packed_resolve(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= band_pixels() {
        return;
    }
    if id.x == 0u {
        atomicStore(&counter, 0u);
    }
    // Heads of pixels that are under way have been taken.
    var head = EOL;
    if progress.pixels[id.x].run == 0u {
        head = atomicExchange(&heads[id.x], 0u) - 1u;
    }
    blend_list(id.x, head);
}
