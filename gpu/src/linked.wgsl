// Linked lists by tiles: each tile has a region of the nodes and a counter of its own, which lies in
// workgroup memory. Yang et al. 2010, section 3.1 ("one counter for each workgroup"). Of a region, as
// many nodes are stored as it has room for; its counter counts all.
//
// Triangles come from back to front, about, and a node goes before those that are there: most lists
// are in order when they are built. Twin: spec/src/tiles.rs.
//#import entry
//#import draw
//#import shown
//#import relink

const FROM_BACK: bool = true;

struct Node {
    key: u32,
    next: u32,
    prim: u32,
    mask: u32,
}

// A tile's nodes: the first, and how many there is room for; how many there would be; the lists that
// are in order, a bit each.
struct Region {
    first: u32,
    capacity: u32,
    attempts: u32,
    unused: u32,
    in_order: vec2<u32>,
}

@group(0) @binding(7) var<storage, read_write> heads: array<u32>;
@group(0) @binding(8) var<storage, read_write> nodes: array<Node>;
@group(0) @binding(33) var<storage, read_write> regions: array<Region>;

// Pixels that are not done yet ask for another dispatch.
struct Work {
    unfinished: atomic<u32>,
    pixels: array<Progress>,
}

@group(0) @binding(11) var<storage, read_write> progress: Work;

struct Held {
    first: u32,
    capacity: u32,
    head: u32,
    // What the head holds, and whether each node is nearer than the next.
    last: Listed,
    in_order: bool,
}

var<workgroup> attempts: atomic<u32>;
var<workgroup> first_nodes: array<atomic<u32>, WORKGROUP>;
var<workgroup> ordered: array<atomic<u32>, 2>;

fn start_pixel(own: ptr<function, Pixel>, fill: bool) {
    let region = regions[(*own).tile];
    let pixel = pixel_of((*own).tile, (*own).lane);
    var head = EOL;
    var drawn = 0u;
    if tiled.first > 0u {
        drawn = region.attempts;
        if pixel != NOWHERE {
            head = heads[pixel];
        }
    }
    (*own).held = Held(region.first, region.capacity, head, LAST, tiled.first == 0u);
    atomicStore(&first_nodes[(*own).lane], head);
    if (*own).lane == 0u {
        atomicStore(&attempts, drawn);
        atomicStore(&ordered[0], 0u);
        atomicStore(&ordered[1], 0u);
    }
}

// Of any pixel: invocations do not know of one another's fragments.
fn put_small(tile: u32, pixel: u32, entry: Listed, fill: bool) {
    let i = atomicAdd(&attempts, 1u);
    if i < regions[tile].capacity {
        let address = regions[tile].first + i;
        let next = atomicExchange(&first_nodes[pixel], address);
        nodes[address] = Node(entry.x, next, prim_of(entry.y), mask_of(entry.y));
    }
}

fn take_small(own: ptr<function, Pixel>) {
    let head = atomicLoad(&first_nodes[(*own).lane]);
    (*own).held.in_order = (*own).held.in_order && head == (*own).held.head;
    (*own).held.head = head;
}

fn put(own: ptr<function, Pixel>, entry: Listed, fill: bool) {
    let i = atomicAdd(&attempts, 1u);
    if i >= (*own).held.capacity {
        return;
    }
    let address = (*own).held.first + i;
    nodes[address] = Node(entry.x, (*own).held.head, prim_of(entry.y), mask_of(entry.y));
    (*own).held.head = address;
    (*own).held.in_order = (*own).held.in_order && less(entry, (*own).held.last);
    (*own).held.last = entry;
}

fn leave_pixel(own: Pixel) {
    atomicStore(&first_nodes[own.lane], own.held.head);
}

fn link_tile(tile: u32, lane: u32) {
    let own = draw(tile, lane, true);
    if own.held.in_order {
        atomicOr(&ordered[lane / 32u], 1u << (lane % 32u));
    }
    workgroupBarrier();
    let pixel = pixel_of(tile, lane);
    if pixel != NOWHERE {
        heads[pixel] = own.held.head;
    }
    if lane == 0u {
        regions[tile].attempts = atomicLoad(&attempts);
        regions[tile].in_order = vec2(atomicLoad(&ordered[0]), atomicLoad(&ordered[1]));
    }
}

fn is_in_order(tile: u32, lane: u32) -> bool {
    return (regions[tile].in_order[lane / 32u] >> (lane % 32u) & 1u) != 0u;
}

// Stage linked: a tile.
@compute @workgroup_size(WORKGROUP)
fn linked(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let tile = chunk_of(group, groups);
    if tile < tiled.items {
        link_tile(tile, lane);
    }
}

fn next_of(at: u32) -> u32 {
    return nodes[at].next;
}

fn set_next(at: u32, next: u32) {
    nodes[at].next = next;
}

fn before(a: u32, b: u32) -> bool {
    return less(vec2(nodes[a].key, nodes[a].prim), vec2(nodes[b].key, nodes[b].prim));
}

// Lists that are not in order, sorted by relinking their nodes.
@compute @workgroup_size(WORKGROUP)
fn linked_sort(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let tile = chunk_of(group, groups);
    if tile >= tiled.items || is_in_order(tile, lane) {
        return;
    }
    let pixel = pixel_of(tile, lane);
    if pixel == NOWHERE {
        return;
    }
    let p = relinked(progress.pixels[pixel], heads[pixel]);
    progress.pixels[pixel] = p;
    if p.state == DONE {
        heads[pixel] = p.merged;
    } else {
        atomicStore(&progress.unfinished, 1u);
    }
}

// Lists in order, blended. What nothing is seen through ends one. A dispatch goes on where the one
// before stopped: the picture holds the sum so far and the transmittance.
@compute @workgroup_size(WORKGROUP)
fn linked_blend(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let tile = chunk_of(group, groups);
    if tile >= tiled.items {
        return;
    }
    let pixel = pixel_of(tile, lane);
    if pixel == NOWHERE {
        return;
    }
    let behind = behind_at(pixel);
    var at = heads[pixel];
    var seen = unseen();
    if tiled.first > 0u {
        at = progress.pixels[pixel].left;
        if progress.pixels[pixel].state == DONE {
            return;
        }
        seen = kept_of(pixel);
    }
    for (var i = 0u; i < tiled.count; i += 1u) {
        let is_end = at == EOL || tiled.first + i >= tiled.layers || is_covered_up(seen);
        if is_end || is_hidden(nodes[at].key, behind) {
            progress.pixels[pixel].state = DONE;
            show(pixel, seen);
            return;
        }
        let node = nodes[at];
        seen = over(seen, vec2(node.key, packed(node.prim, node.mask)), behind);
        at = node.next;
    }
    progress.pixels[pixel].left = at;
    progress.pixels[pixel].state = FIND;
    keep(pixel, seen);
    atomicStore(&progress.unfinished, 1u);
}
