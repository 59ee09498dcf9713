// What triangles cover of a tile's pixels, which have several samples. Imported by `tile`, where there are
// `ends`, `edges` and `steps` of draw. Twin: covered.wgsl.
//#import steps_samples

// From a pixel's corner to what it is told from.
fn reference() -> vec2<i32> {
    return vec2(0);
}

fn places() -> Places {
    var all = Places(sample_place(0u), sample_place(0u));
    for (var s = 1u; s < frame.samples; s += 1u) {
        all = Places(min(all.low, sample_place(s)), max(all.high, sample_place(s)));
    }
    return all;
}

const MASK_BITS: u32 = 8u;

// Triangle and mask of a fragment in a word, in order of triangle.
fn packed(prim: u32, mask: u32) -> u32 {
    return (prim << MASK_BITS) | mask;
}

fn prim_of(word: u32) -> u32 {
    return word >> MASK_BITS;
}

fn mask_of(word: u32) -> u32 {
    return word & ((1u << MASK_BITS) - 1u);
}

// A triangle as a tile sees it: edge functions at the first pixel's corner, less the least of a covered
// sample, in steps of the pixel grid, rounded down; their changes to the next column and row; and what was
// left of them, in steps of the sub-pixel grid.
struct Edges {
    low: vec3<i32>,
    prim: u32,
    columns: vec3<i32>,
    // Whether it covers all of the tile.
    is_full: u32,
    rows: vec3<i32>,
    // Whether some of its fragments may lie behind what is opaque.
    is_tested: u32,
    rest: vec3<i32>,
}

fn rest_of(value: Wide) -> i32 {
    return wide_low24(value) & ((1 << frame.bits) - 1);
}

fn edges_of(prim: u32, s: Setup, corner: vec2<i32>) -> Edges {
    let a = wide_sub(edge(s.b, s.c, corner), wide(least(s.b, s.c)));
    let b = wide_sub(edge(s.c, s.a, corner), wide(least(s.c, s.a)));
    let c = wide_sub(edge(s.a, s.b, corner), wide(least(s.a, s.b)));
    let low = vec3(limited(a), limited(b), limited(c));
    var edges = Edges(low, prim, columns_of(s), 0u, rows_of(s), 1u, vec3(rest_of(a), rest_of(b), rest_of(c)));
    let most = i32(SIDE) - 1;
    let pixel = low + most * (min(edges.columns, vec3(0)) + min(edges.rows, vec3(0)));
    edges.is_full = u32(covered_from(edges, pixel) == all_samples());
    return edges;
}

// The samples that are covered of a pixel of which edge functions are these. To a sample, one changes by
// less than 2^29 sub-pixel steps.
fn covered_from(edges: Edges, pixel: vec3<i32>) -> u32 {
    var mask = 0u;
    for (var s = 0u; s < frame.samples; s += 1u) {
        let place = sample_place(s);
        let inner = edges.rest + edges.columns * place.x + edges.rows * place.y;
        let e = pixel + (inner >> vec3(frame.bits));
        mask |= select(0u, 1u << s, (e.x | e.y | e.z) >= 0);
    }
    return mask;
}

fn covered_at(edges: Edges, at: vec2<i32>) -> u32 {
    if edges.is_full != 0u {
        return all_samples();
    }
    return covered_from(edges, edges.low + edges.columns * at.x + edges.rows * at.y);
}

// The smallest and the largest of a pixel's opaque keys.
fn ends_at(pixel: u32) -> vec2<u32> {
    var ends = vec2(NOTHING, 0u);
    for (var s = 0u; s < frame.samples; s += 1u) {
        let key = opaque_key[frame.samples * pixel + s];
        ends = vec2(min(ends.x, key), max(ends.y, key));
    }
    return ends;
}

// A small triangle at a pixel of a tile. Without `fill`, no key need be right but where it is tested.
fn small_at(s: Setup, spot: Spot, edges: Edges, tile: u32, at: vec2<i32>, fill: bool) -> Covered {
    let lane = u32(at.y) * SIDE + u32(at.x);
    var mask = covered_at(edges, at);
    if mask == 0u || ends[lane] == 0u {
        return Covered(0u, 0u);
    }
    let corner = spot.place + (at << vec2(frame.bits));
    var key = 0u;
    if fill {
        key = key_of(s, corner + sample_place(firstTrailingBit(mask)));
    }
    if edges.is_tested != 0u {
        let first = frame.samples * pixel_of(tile, lane);
        for (var i = 0u; i < frame.samples; i += 1u) {
            let is_covered = (mask >> i & 1u) != 0u;
            if is_covered && key_of(s, corner + sample_place(i)) >= opaque_key[first + i] {
                mask &= ~(1u << i);
            }
        }
    }
    return Covered(mask, key);
}

// Number `i` of a batch, a larger one.
fn larger_at(i: u32, tile: u32, lane: u32, end: u32, fill: bool) -> Covered {
    var mask = covered_at(edges[i], vec2<i32>(vec2(lane % SIDE, lane / SIDE)));
    if mask == 0u || end == 0u {
        return Covered(0u, 0u);
    }
    let pixel = pixel_of(tile, lane);
    var key = 0u;
    if fill {
        key = larger_key(i, pixel, lane, firstTrailingBit(mask));
    }
    if edges[i].is_tested != 0u {
        for (var s = 0u; s < frame.samples; s += 1u) {
            let is_covered = (mask >> s & 1u) != 0u;
            if is_covered && larger_key(i, pixel, lane, s) >= opaque_key[frame.samples * pixel + s] {
                mask &= ~(1u << s);
            }
        }
    }
    return Covered(mask, key);
}

fn larger_key(i: u32, pixel: u32, lane: u32, sample: u32) -> u32 {
    let place = vec2<u32>(sample_place(sample));
    let stepped = step_key(steps[i], vec2(lane % SIDE, lane / SIDE), place);
    if stepped.is_sure {
        return stepped.key;
    }
    return key_at(edges[i].prim, pixel, sample, 0u);
}
