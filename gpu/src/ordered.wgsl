// A-buffer whose lists are in order while they are built: a fragment goes along its pixel's list, and
// wherever it is nearer it takes the place of what is there, which goes on instead.
// Twin: spec/src/layouts/ordered.rs.
//
// Nothing is published: all nodes are made, empty, in an earlier pass, and whatever invocations tell each
// other is a value of an atomic. A minimum keeps the nearer of two and returns the other, so that no value
// is lost or held twice, and node i of a list ends with its (i + 1)-th nearest fragment, whoever comes first.
// Nobody waits: each step goes one node further, and a list has no more nodes than fragments.
//#import listing
//#import counter
//#import slots

// No node.
const EOL: u32 = 0xffffffffu;

// The first node of each list, then the next one of each node.
@group(0) @binding(7) var<storage, read_write> links: array<atomic<u32>>;

// Invocations that ran out of steps.
@group(0) @binding(12) var<storage, read_write> unfinished: atomic<u32>;

// Steps of an invocation, as in relink.wgsl: drivers end what takes too long.
const STEPS: u32 = 16384u;

// Times that an invocation finds nobody to have been first, and yet hangs no node: a weak exchange may
// fail for no reason.
const TRIES: u32 = 16u;

var<private> steps_left: u32 = STEPS;

fn may_step() -> bool {
    if steps_left == 0u {
        atomicStore(&unfinished, 1u);
        return false;
    }
    steps_left -= 1u;
    return true;
}

// First pass over the triangles.
fn insert(fragment: Fragment) {
    let mask = visible(fragment);
    if mask == 0u {
        return;
    }
    var mine = slot_of(fragment.key, face_of(fragment.prim, mask));
    var at = fragment.pixel;
    var spare = EOL;
    var tries = 0u;
    // Behind so many nearer ones nothing is shown, and nothing is kept.
    for (var i = 0u; i < listing.layers && may_step();) {
        var node = atomicLoad(&links[at]);
        if node == EOL {
            // What another invocation hung here meanwhile is followed instead; this node is kept for later.
            if spare == EOL {
                spare = claim();
                if spare >= frame.capacity {
                    return;
                }
            }
            let hung = atomicCompareExchangeWeak(&links[at], EOL, spare);
            if !hung.exchanged {
                tries += 1u;
                if tries > TRIES && atomicLoad(&links[at]) == EOL {
                    atomicStore(&unfinished, 1u);
                    return;
                }
                continue;
            }
            node = spare;
            spare = EOL;
        }
        mine = displaced(node, mine);
        if is_empty(mine) {
            return;
        }
        at = listing.links + node;
        i += 1u;
    }
}

// Second pass, where keys alone are in order by now: the triangles of equal keys.
fn settle(fragment: Fragment) {
    let mask = visible(fragment);
    if mask == 0u {
        return;
    }
    var face = face_of(fragment.prim, mask);
    var node = atomicLoad(&links[fragment.pixel]);
    while node != EOL && may_step() {
        face = displaced_face(node, fragment.key, face);
        if face == EMPTY {
            return;
        }
        node = atomicLoad(&links[listing.links + node]);
    }
}

// Stage ordered: empty lists, and empty nodes.
@compute @workgroup_size(WORKGROUP)
fn ordered_clear(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = item(id, groups);
    if i < listing.items {
        atomicStore(&links[i], EOL);
    }
    if i < frame.capacity {
        make_empty(i);
    }
    if i == 0u {
        atomicStore(&counter, 0u);
        atomicStore(&unfinished, 0u);
    }
}

@compute @workgroup_size(WORKGROUP)
fn ordered(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= frame.items {
        return;
    }
    var walk = start(id.x);
    while advance(&walk) {
        insert(walk.fragment);
    }
}

@compute @workgroup_size(WORKGROUP)
fn ordered_ties(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= frame.items {
        return;
    }
    var walk = start(id.x);
    while advance(&walk) {
        settle(walk.fragment);
    }
}

// Whether a fragment's pixel is covered. Hardware draws squares of four pixels; for those beside the
// triangle an invocation stands in whose atomics do nothing and give back anything, so that it would go
// on until it has no steps left. The hardware's coverage is that of the exact test: stage cover says so.
fn is_drawn(fragment: Fragment) -> bool {
    let lowest = min(firstTrailingBit(fragment.mask), SAMPLES_MAX - 1u);
    return key_at(fragment.prim, fragment.pixel, lowest, NOTHING) != NOTHING;
}

@fragment
fn ordered_fragment(drawn: Drawn) {
    let fragment = fragment_of(drawn);
    if is_drawn(fragment) {
        insert(fragment);
    }
}

@fragment
fn ordered_ties_fragment(drawn: Drawn) {
    let fragment = fragment_of(drawn);
    if is_drawn(fragment) {
        settle(fragment);
    }
}

// The list, listing.layers of it at most, over what lies behind it. A list that was built has at most STEPS
// nodes.
@compute @workgroup_size(WORKGROUP)
fn ordered_blend(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= band_pixels() {
        return;
    }
    let end = opaque_key[id.x];
    var seen = vec4(0.0, 0.0, 0.0, 1.0);
    var node = atomicLoad(&links[id.x]);
    for (var i = 0u; i < min(STEPS, listing.layers) && node != EOL; i += 1u) {
        let slot = slot_at(node);
        if slot.x >= end {
            break;
        }
        seen = under(seen, faces[slot.y >> MASK_BITS]);
        node = atomicLoad(&links[listing.links + node]);
    }
    picture[id.x] = vec4(seen.rgb + seen.a * behind(id.x), 1.0);
}
