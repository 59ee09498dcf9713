// The same in one word of 64 bits, where the adapter has atomics of these: one pass over the
// triangles is enough. Twin: near.wgsl.

@group(0) @binding(14) var<storage, read_write> near_both: array<atomic<u64>>;

fn offer(fragment: Fragment) {
    atomicMin(&near_both[fragment.pixel], (u64(fragment.key) << 32u) | u64(fragment.prim));
}

// There is no second pass.
fn settle(fragment: Fragment) {}

fn take(pixel: u32) -> vec2<u32> {
    let found = atomicLoad(&near_both[pixel]);
    atomicStore(&near_both[pixel], 0xfffffffffffffffflu);
    return vec2(u32(found >> 32u), u32(found & 0xfffffffflu));
}
