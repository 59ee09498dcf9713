// A node's key and face in two words: one pass over the triangles puts keys in order, another the faces
// of each key. Twin: slots_wide.wgsl.

// Nothing: behind every fragment.
const EMPTY: u32 = 0xffffffffu;

alias Slot = u32;

@group(0) @binding(8) var<storage, read_write> keys: array<atomic<u32>>;
@group(0) @binding(9) var<storage, read_write> in_order: array<atomic<u32>>;

fn slot_of(key: u32, face: u32) -> Slot {
    return key;
}

fn is_empty(slot: Slot) -> bool {
    return slot == EMPTY;
}

// The nearer one stays; the other.
fn displaced(node: u32, mine: Slot) -> Slot {
    return max(atomicMin(&keys[node], mine), mine);
}

// The same of faces, in the nodes of their key.
fn displaced_face(node: u32, key: u32, mine: u32) -> u32 {
    if atomicLoad(&keys[node]) != key {
        return mine;
    }
    return max(atomicMin(&in_order[node], mine), mine);
}

fn make_empty(node: u32) {
    atomicStore(&keys[node], EMPTY);
    atomicStore(&in_order[node], EMPTY);
}

fn slot_at(node: u32) -> vec2<u32> {
    return vec2(atomicLoad(&keys[node]), atomicLoad(&in_order[node]));
}
