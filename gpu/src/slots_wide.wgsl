// The same in one word of 64 bits, where the adapter has all atomics of these: one pass over the triangles
// is enough. Twin: slots.wgsl.

const EMPTY: u32 = 0xffffffffu;

alias Slot = u64;

@group(0) @binding(8) var<storage, read_write> both: array<atomic<u64>>;

fn slot_of(key: u32, face: u32) -> Slot {
    return (u64(key) << 32u) | u64(face);
}

fn is_empty(slot: Slot) -> bool {
    return slot == 0xfffffffffffffffflu;
}

fn displaced(node: u32, mine: Slot) -> Slot {
    return max(atomicMin(&both[node], mine), mine);
}

// There is no second pass.
fn displaced_face(node: u32, key: u32, mine: u32) -> u32 {
    return mine;
}

fn make_empty(node: u32) {
    atomicStore(&both[node], 0xfffffffffffffffflu);
}

fn slot_at(node: u32) -> vec2<u32> {
    let slot = atomicLoad(&both[node]);
    return vec2(u32(slot >> 32u), u32(slot & 0xfffffffflu));
}
