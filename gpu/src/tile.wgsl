// A tile of 8 x 8 pixels, drawn by a workgroup: an invocation owns a pixel, so that what is kept of it
// needs no atomics but for small triangles, and what depends on a triangle alone is worked out once for 64
// pixels.
// Imported where there are `bins`. Twin: spec/src/tiles.rs.
//#import covered

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

fn bin_of(tile: u32) -> vec2<u32> {
    return vec2(bins[tile], bins[tile + 1u]);
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

// What a tile's first pixel is told from, in sub-pixels.
fn first_place(tile: u32) -> vec2<i32> {
    let pixel = origin_of(tile) + vec2(0u, frame.first_row);
    return vec2<i32>(pixel << vec2(frame.bits)) + reference();
}

// Of samples, from there on: the least and the largest, right and down each by itself, in sub-pixels.
struct Places {
    low: vec2<i32>,
    high: vec2<i32>,
}

// Edge functions are told in steps of the pixel grid, rounded down. From a pixel to another of the tile
// one changes by a whole number of them, so that rounding down changes no sign, and by less than 2^25
// (14 changes, each a side's length in sub-pixels, at most 2^20): a limit of 2^26 changes none either,
// and 32 bits do.
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

// Edge functions of a triangle at the band's first pixel, each less the least of a covered sample, and
// moved to the corner of what a tile's samples span where it is largest.
struct Reach {
    a: Wide,
    b: Wide,
    c: Wide,
    columns: vec3<i32>,
    rows: vec3<i32>,
}

fn reach_of(s: Setup) -> Reach {
    let place = first_place(0u);
    let columns = columns_of(s);
    let rows = rows_of(s);
    let most = (i32(SIDE) - 1) * (max(columns, vec3(0)) + max(rows, vec3(0)));
    // Within a pixel; less than 2^29.
    let inner = places();
    let more = max(columns * inner.low.x, columns * inner.high.x) + max(rows * inner.low.y, rows * inner.high.y);
    return Reach(
        farthest(s.b, s.c, place, most.x, more.x),
        farthest(s.c, s.a, place, most.y, more.y),
        farthest(s.a, s.b, place, most.z, more.z),
        columns,
        rows,
    );
}

fn farthest(a: vec3<i32>, b: vec3<i32>, place: vec2<i32>, most: i32, more: i32) -> Wide {
    let value = wide_sub(edge(a, b, place), wide(least(a, b) - more));
    return wide_add(value, wide_shift(wide(most), frame.bits));
}

// Whether an edge leaves any of what a tile's samples span to the triangle, for all three.
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

// Pixels of a tile of which samples may lie within a triangle's box, and how many.
struct Spot {
    place: vec2<i32>,
    first: vec2<i32>,
    across: i32,
    pixels: i32,
}

fn spot_of(s: Setup, place: vec2<i32>) -> Spot {
    let inner = places();
    let low = min(s.a.xy, min(s.b.xy, s.c.xy)) - place - inner.high;
    let high = max(s.a.xy, max(s.b.xy, s.c.xy)) - place - inner.low;
    // Shifts round down: the first pixel at or after `low`, and the last up to `high`.
    let first = max(-((-low) >> vec2(frame.bits)), vec2(0));
    let size = max(min(high >> vec2(frame.bits), vec2(i32(SIDE) - 1)) - first + 1, vec2(0));
    return Spot(place, first, size.x, size.x * size.y);
}
