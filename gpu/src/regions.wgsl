// A-buffer with many counters, each of a region of the nodes of its own: invocations of one workgroup
// contend for a counter, not those of all. Yang et al. 2010, section 3.1. Twin: spec/src/layouts.rs.
//
// Of a region, as many nodes are stored as it has room for; its counter counts all.
//#import listing
//#import followed

struct Node {
    key: u32,
    next: u32,
    prim: u32,
    mask: u32,
}

@group(0) @binding(4) var<storage, read_write> counters: array<atomic<u32>>;
@group(0) @binding(7) var<storage, read_write> heads: array<atomic<u32>>;
@group(0) @binding(8) var<storage, read_write> nodes: array<Node>;
@group(0) @binding(9) var<storage, read_write> colours: array<vec4<f32>>;

fn next_of(at: u32) -> u32 {
    return nodes[at].next;
}

fn set_next(at: u32, next: u32) {
    nodes[at].next = next;
}

fn key_of_node(at: u32) -> u32 {
    return nodes[at].key;
}

fn colour_of_node(at: u32) -> vec4<f32> {
    return colours[at];
}

// Total order, as stage sort has it.
fn before(a: u32, b: u32) -> bool {
    return nodes[a].key < nodes[b].key || (nodes[a].key == nodes[b].key && nodes[a].prim < nodes[b].prim);
}

// frame.capacity is that of a region.
fn insert(fragment: Fragment, region: u32) {
    let mask = visible(fragment);
    if mask == 0u {
        return;
    }
    let place = atomicAdd(&counters[region], 1u);
    if place >= frame.capacity {
        return;
    }
    let address = region * frame.capacity + place;
    let next = atomicExchange(&heads[fragment.pixel], address);
    nodes[address] = Node(fragment.key, next, fragment.prim, mask);
    colours[address] = faces[fragment.prim];
}

// Empty lists.
@compute @workgroup_size(WORKGROUP)
fn regions_clear(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x < band_pixels() {
        atomicStore(&heads[id.x], EOL);
    }
    // A band may have fewer pixels than there are regions.
    for (var i = id.x; i < listing.regions; i += band_pixels()) {
        atomicStore(&counters[i], 0u);
    }
}

// Stage regions: as stage build; a workgroup has a region, which others may share.
@compute @workgroup_size(WORKGROUP)
fn regions(@builtin(global_invocation_id) id: vec3<u32>, @builtin(workgroup_id) group: vec3<u32>) {
    if id.x >= frame.items {
        return;
    }
    var walk = start(id.x);
    while advance(&walk) {
        insert(walk.fragment, group.x % listing.regions);
    }
}

// Fragments have no workgroups: squares of 8 x 8 pixels stand in for them.
@fragment
fn regions_fragment(drawn: Drawn) {
    let fragment = fragment_of(drawn);
    let column = fragment.pixel % frame.width / 8u;
    let row = fragment.pixel / frame.width / 8u;
    let across = (frame.width + 7u) / 8u;
    insert(fragment, (row * across + column) % listing.regions);
}

// Then: the picture of lists that are in order by now.
@compute @workgroup_size(WORKGROUP)
fn regions_blend(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x < band_pixels() {
        blend_list(id.x, atomicLoad(&heads[id.x]));
    }
}
