// The smallest (key, triangle) of each pixel, in two words: one pass over the triangles finds
// the keys, another the triangles. Twin: near_wide.wgsl.

@group(0) @binding(14) var<storage, read_write> near_key: array<atomic<u32>>;
@group(0) @binding(15) var<storage, read_write> near_prim: array<atomic<u32>>;

// First pass: the smallest key.
fn offer(fragment: Fragment) {
    atomicMin(&near_key[fragment.pixel], fragment.key);
}

// Second pass: the smallest triangle with that key.
fn settle(fragment: Fragment) {
    if fragment.key == atomicLoad(&near_key[fragment.pixel]) {
        atomicMin(&near_prim[fragment.pixel], fragment.prim);
    }
}

// What was found, if anything, and nothing from now on.
fn take(pixel: u32) -> vec2<u32> {
    let found = vec2(atomicLoad(&near_key[pixel]), atomicLoad(&near_prim[pixel]));
    atomicStore(&near_key[pixel], NOTHING);
    atomicStore(&near_prim[pixel], NOTHING);
    return found;
}
