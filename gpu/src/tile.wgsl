// A tile of 8 x 8 pixels, drawn by a workgroup: an invocation owns a pixel, so that what is kept of it
// needs no atomics, and what depends on a triangle alone is worked out once for 64 pixels.
// Imported where there are `bins`. Twin: spec/src/tiles.rs.
//#import steps

// Pixels along a side.
const SIDE: u32 = 8u;

// What kernels of tiles are told beside the frame. Twin: `Tiled` in tiles.rs.
struct Tiled {
    items: u32,     // triangles, tiles or lists of a dispatch
    capacity: u32,  // entries that there is room for; nodes, of each region
    first: u32,     // the first triangle of each bin that a dispatch draws
    count: u32,     // and how many
    run: u32,       // entries in a row that are in order
    groups: u32,    // workgroups that share the large triangles
    layers: u32,    // layers that are shown, at most
    stored: u32,    // whether lists are written back in order
}

@group(0) @binding(20) var<uniform> tiled: Tiled;

// Where the triangles of each tile begin, and the end of the last; and the triangles.
@group(0) @binding(14) var<storage, read_write> bins: array<u32>;
@group(0) @binding(15) var<storage, read_write> binned: array<u32>;

// In `bins`: the tile's pixels are done. No bin begins so far on.
const FINISHED: u32 = 0x80000000u;

fn bin_of(tile: u32) -> vec2<u32> {
    return vec2(bins[tile], bins[tile + 1u]) & vec2(~FINISHED);
}

// Whether there is such a tile that is not done.
fn is_left(tile: u32) -> bool {
    return tile < tiled.items && (bins[tile] & FINISHED) == 0u;
}

fn tiles_across() -> u32 {
    return (frame.width + SIDE - 1u) / SIDE;
}

fn tiles_down() -> u32 {
    return (frame.rows + SIDE - 1u) / SIDE;
}

// The first pixel of a tile, within the band.
fn origin_of(tile: u32) -> vec2<u32> {
    return SIDE * vec2(tile % tiles_across(), tile / tiles_across());
}

// No pixel: beyond the edges of the band.
const NOWHERE: u32 = 0xffffffffu;

// The number of a tile's pixel in the band.
fn pixel_of(tile: u32, lane: u32) -> u32 {
    let pixel = origin_of(tile) + vec2(lane % SIDE, lane / SIDE);
    let inside = pixel.x < frame.width && pixel.y < frame.rows;
    return select(NOWHERE, pixel.y * frame.width + pixel.x, inside);
}

// The sample of a tile's first pixel, in sub-pixels.
fn first_sample(tile: u32) -> vec2<i32> {
    let pixel = origin_of(tile);
    return sample_at(pixel.x, pixel.y + frame.first_row, 0u);
}

// A triangle as a tile sees it: edge functions at the first sample, less the least of a covered one,
// in steps of the pixel grid, rounded down; and their changes to the next column and row.
//
// From one sample to another of the tile an edge function changes by a whole number of such steps,
// so that rounding down changes no sign. It changes by less than 2^25 of them (14 changes, each a
// side's length in sub-pixels, at most 2^20), so that neither does a limit of 2^26: 32 bits do.
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

const EDGE_MOST: i32 = 1 << 26u;
const EDGE_BITS: u32 = 26u;

fn limited(value: Wide) -> i32 {
    let beyond = wide_floor(value, frame.bits + EDGE_BITS);
    if beyond > 0 {
        return EDGE_MOST;
    }
    if beyond < -1 {
        return -EDGE_MOST;
    }
    return wide_floor(value, frame.bits);
}

// Changes of edge functions from a column to the next.
fn columns_of(s: Setup) -> vec3<i32> {
    return vec3(s.b.y - s.c.y, s.c.y - s.a.y, s.a.y - s.b.y);
}

// From a row to the next.
fn rows_of(s: Setup) -> vec3<i32> {
    return vec3(s.c.x - s.b.x, s.a.x - s.c.x, s.b.x - s.a.x);
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

// Edge functions of a triangle at the band's first sample, each less the least of a covered one, and
// moved to the corner of a tile where it is largest.
struct Reach {
    a: Wide,
    b: Wide,
    c: Wide,
    columns: vec3<i32>,
    rows: vec3<i32>,
}

fn reach_of(s: Setup) -> Reach {
    let sample = first_sample(0u);
    let columns = columns_of(s);
    let rows = rows_of(s);
    let most = (i32(SIDE) - 1) * (max(columns, vec3(0)) + max(rows, vec3(0)));
    return Reach(
        farthest(s.b, s.c, sample, most.x),
        farthest(s.c, s.a, sample, most.y),
        farthest(s.a, s.b, sample, most.z),
        columns,
        rows,
    );
}

fn farthest(a: vec3<i32>, b: vec3<i32>, sample: vec2<i32>, most: i32) -> Wide {
    let value = wide_sub(edge(a, b, sample), wide(least(a, b)));
    return wide_add(value, wide_shift(wide(most), frame.bits));
}

// Whether an edge leaves any sample of a tile to the triangle, for all three.
fn meets(reach: Reach, tile: vec2<u32>) -> bool {
    let pixel = vec2<i32>(SIDE * tile);
    return !(wide_negative(moved(reach.a, reach.columns.x, reach.rows.x, pixel))
        || wide_negative(moved(reach.b, reach.columns.y, reach.rows.y, pixel))
        || wide_negative(moved(reach.c, reach.columns.z, reach.rows.z, pixel)));
}

fn moved(value: Wide, column: i32, row: i32, pixel: vec2<i32>) -> Wide {
    let change = wide_add(wide_mul(column, pixel.x), wide_mul(row, pixel.y));
    return wide_add(value, wide_shift(change, frame.bits));
}

// Whether a triangle covers a sample of the tile.
fn covers(edges: Edges, at: vec2<i32>) -> bool {
    let e = edges.low + edges.columns * at.x + edges.rows * at.y;
    return (e.x | e.y | e.z) >= 0;
}

// Pixels of a tile of which the samples lie within a triangle's box, and how many.
struct Spot {
    sample: vec2<i32>,
    first: vec2<i32>,
    across: i32,
    pixels: i32,
}

fn spot_of(s: Setup, sample: vec2<i32>) -> Spot {
    let low = min(s.a.xy, min(s.b.xy, s.c.xy)) - sample;
    let high = max(s.a.xy, max(s.b.xy, s.c.xy)) - sample;
    // Shifts round down: the first sample at or after `low`, and the last up to `high`.
    let first = max(-((-low) >> vec2(frame.bits)), vec2(0));
    let size = max(min(high >> vec2(frame.bits), vec2(i32(SIDE) - 1)) - first + 1, vec2(0));
    return Spot(sample, first, size.x, size.x * size.y);
}
