// What triangles cover of a tile's pixels, which have one sample, in the middle. Imported by `tile`, where
// there are `ends`, `edges` and `steps` of draw. Twin: covered_samples.wgsl.
//#import steps

// From a pixel's corner to what it is told from: its sample.
fn reference() -> vec2<i32> {
    return vec2(1 << (frame.bits - 1u));
}

fn places() -> Places {
    return Places(vec2(0), vec2(0));
}

// Triangle and mask of a fragment in a word.
fn packed(prim: u32, mask: u32) -> u32 {
    return prim;
}

fn prim_of(word: u32) -> u32 {
    return word;
}

fn mask_of(word: u32) -> u32 {
    return 1u;
}

// A triangle as a tile sees it: edge functions at the first sample, less the least of a covered one,
// in steps of the pixel grid, rounded down; and their changes to the next column and row.
struct Edges {
    low: vec3<i32>,
    prim: u32,
    columns: vec3<i32>,
    // Whether it covers all of the tile.
    is_full: u32,
    rows: vec3<i32>,
    // Whether some of its fragments may lie behind what is opaque.
    is_tested: u32,
}

fn edges_of(prim: u32, s: Setup, sample: vec2<i32>) -> Edges {
    let low = vec3(
        limited(wide_sub(edge(s.b, s.c, sample), wide(least(s.b, s.c)))),
        limited(wide_sub(edge(s.c, s.a, sample), wide(least(s.c, s.a)))),
        limited(wide_sub(edge(s.a, s.b, sample), wide(least(s.a, s.b)))),
    );
    let columns = columns_of(s);
    let rows = rows_of(s);
    let most = i32(SIDE) - 1;
    let worst = low + most * (min(columns, vec3(0)) + min(rows, vec3(0)));
    return Edges(low, prim, columns, u32((worst.x | worst.y | worst.z) >= 0), rows, 1u);
}

// Whether a triangle covers a sample of the tile.
fn covers(edges: Edges, at: vec2<i32>) -> bool {
    let e = edges.low + edges.columns * at.x + edges.rows * at.y;
    return (e.x | e.y | e.z) >= 0;
}

// The smallest and the largest of a pixel's opaque keys.
fn ends_at(pixel: u32) -> vec2<u32> {
    return vec2(opaque_key[pixel]);
}

// A small triangle at a pixel of a tile. Without `fill`, no key need be right but where it is tested.
fn small_at(s: Setup, spot: Spot, edges: Edges, tile: u32, at: vec2<i32>, fill: bool) -> Covered {
    if !covers(edges, at) {
        return Covered(0u, 0u);
    }
    var key = 0u;
    if fill || edges.is_tested != 0u {
        key = key_of(s, spot.place + (at << vec2(frame.bits)));
    }
    return Covered(u32(key < ends[u32(at.y) * SIDE + u32(at.x)]), key);
}

// Number `i` of a batch, a larger one.
fn larger_at(i: u32, tile: u32, lane: u32, end: u32, fill: bool) -> Covered {
    let at = vec2(lane % SIDE, lane / SIDE);
    if edges[i].is_full == 0u && !covers(edges[i], vec2<i32>(at)) {
        return Covered(0u, 0u);
    }
    var key = 0u;
    if fill || edges[i].is_tested != 0u {
        let stepped = step_key(steps[i], at);
        key = stepped.key;
        if !stepped.is_sure {
            key = key_at(edges[i].prim, pixel_of(tile, lane), 0u, 0u);
        }
    }
    return Covered(u32(key < end), key);
}
