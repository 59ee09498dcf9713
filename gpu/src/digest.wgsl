// What is left of lists that were blended at once, without a place in memory. Imported where there are tiles.

// Of a pixel: fragments, and a digest of them in order. In `count` of a tile's first pixel, FINISHED.
struct Digest {
    count: u32,
    words: u32,
}

struct Digests {
    // Tiles that are not finished.
    left: atomic<u32>,
    pixels: array<Digest>,
}

@group(0) @binding(33) var<storage, read_write> digests: Digests;

// The tile's pixels are done. No list is so long.
const FINISHED: u32 = 0x80000000u;

// Whether a tile is not done. Where no tile is drawn without lists, there is one digest, of zeros.
fn is_left(tile: u32) -> bool {
    let first = pixel_of(tile, 0u);
    if first >= arrayLength(&digests.pixels) {
        return true;
    }
    return (digests.pixels[first].count & FINISHED) == 0u;
}
