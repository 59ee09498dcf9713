// A tile of 8 x 8 pixels, drawn by a workgroup: an invocation owns a pixel, so that what is kept of it
// needs no atomics, and what depends on a triangle alone is worked out once for 64 pixels.
// Imported where there are `bins`. Twin: spec/src/tiles.rs.
//#import triangle

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
    full: u32,
    rows: vec3<i32>,
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

fn edges_of(prim: u32, s: Setup, sample: vec2<i32>) -> Edges {
    let low = vec3(
        limited(wide_sub(edge(s.b, s.c, sample), wide(least(s.b, s.c)))),
        limited(wide_sub(edge(s.c, s.a, sample), wide(least(s.c, s.a)))),
        limited(wide_sub(edge(s.a, s.b, sample), wide(least(s.a, s.b)))),
    );
    let columns = vec3(s.b.y - s.c.y, s.c.y - s.a.y, s.a.y - s.b.y);
    let rows = vec3(s.c.x - s.b.x, s.a.x - s.c.x, s.b.x - s.a.x);
    let most = i32(SIDE) - 1;
    let worst = low + most * (min(columns, vec3(0)) + min(rows, vec3(0)));
    return Edges(low, prim, columns, u32((worst.x | worst.y | worst.z) >= 0), rows);
}

// Whether an edge leaves any sample of a tile to the triangle, for all three.
fn meets(edges: Edges) -> bool {
    let most = i32(SIDE) - 1;
    let zero = vec3(0);
    let best = edges.low + most * (max(edges.columns, zero) + max(edges.rows, zero));
    return (best.x | best.y | best.z) >= 0;
}

// What depth keys take beside.
struct Plane {
    ea: Wide,       // edge functions at the tile's first sample
    eb: Wide,
    ec: Wide,
    area: Wide,
    z: vec3<u32>,
}

fn plane_of(s: Setup, sample: vec2<i32>) -> Plane {
    let ea = edge(s.b, s.c, sample);
    let eb = edge(s.c, s.a, sample);
    return Plane(ea, eb, edge(s.a, s.b, sample), s.area, depths(s));
}

// Whether a triangle covers a sample of the tile.
fn covers(edges: Edges, at: vec2<i32>) -> bool {
    let e = edges.low + edges.columns * at.x + edges.rows * at.y;
    return (e.x | e.y | e.z) >= 0;
}

// The depth key at a covered sample.
fn sample_key(edges: Edges, plane: Plane, at: vec2<i32>) -> u32 {
    let change = edges.columns * at.x + edges.rows * at.y;
    return depth_key(
        plane.z,
        plane.area,
        wide_add(plane.ea, wide_shift(wide(change.x), frame.bits)),
        wide_add(plane.eb, wide_shift(wide(change.y), frame.bits)),
        wide_add(plane.ec, wide_shift(wide(change.z), frame.bits)),
    );
}

// Pixels of a tile of which the samples lie within a triangle's box, and how many.
struct Spot {
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
    return Spot(first, size.x, size.x * size.y);
}
