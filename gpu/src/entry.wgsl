// A fragment in a list of a tile, and what lies behind all lists.

// Depth key and triangle. Nearest first, ties by triangle.
alias Listed = vec2<u32>;

const LAST: Listed = vec2(0xffffffffu, 0xffffffffu);

fn less(a: Listed, b: Listed) -> bool {
    return a.x < b.x || (a.x == b.x && a.y < b.y);
}

@group(0) @binding(21) var<storage, read_write> opaque_key: array<u32>;
@group(0) @binding(22) var<storage, read_write> opaque_prim: array<u32>;
