// A tile of 8 x 8 pixels, drawn by a workgroup: an invocation owns a pixel, so that what is kept of it
// needs no atomics, and what depends on a triangle alone is worked out once for 64 pixels.
// Imported where there are `bins`. Twin: spec/src/tiles.rs.
//#import triangle

// Pixels along a side.
const SIDE: u32 = 8u;

// What kernels of tiles are told beside the frame. Twin: `Tiled` in tiles.rs.
struct Tiled {
    items: u32,     // triangles, tiles, lists or entries of a dispatch
    opaque: u32,    // 1: opaque triangles are drawn, 0: transparent ones
    capacity: u32,  // entries that there is room for; nodes, of each region
    first: u32,     // the first triangle of each bin that a dispatch draws
    count: u32,     // and how many
    run: u32,       // entries in a row that are in order
    groups: u32,    // workgroups that share the large triangles
    rounds: u32,    // of nearest layers, in a dispatch
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

// A pixel of a tile.
struct Place {
    // Column and row within the tile.
    at: vec2<i32>,
    // Its number in the band; of a pixel beyond its edges, NOWHERE.
    pixel: u32,
}

const NOWHERE: u32 = 0xffffffffu;

// The first pixel of a tile, within the band.
fn origin_of(tile: u32) -> vec2<u32> {
    return SIDE * vec2(tile % tiles_across(), tile / tiles_across());
}

fn place_of(tile: u32, lane: u32) -> Place {
    let at = vec2(lane % SIDE, lane / SIDE);
    let pixel = origin_of(tile) + at;
    let inside = pixel.x < frame.width && pixel.y < frame.rows;
    return Place(vec2<i32>(at), select(NOWHERE, pixel.y * frame.width + pixel.x, inside));
}

// The sample of a tile's first pixel, in sub-pixels.
fn first_sample(tile: u32) -> vec2<i32> {
    let pixel = origin_of(tile);
    return vec2(sample_at(pixel.x), sample_at(pixel.y + frame.first_row));
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
    return Edges(low, prim, columns, rows);
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

// Triangles of a tile that are drawn next.
var<workgroup> edges: array<Edges, WORKGROUP>;
var<workgroup> planes: array<Plane, WORKGROUP>;
var<workgroup> bin_bounds: vec2<u32>;

// A tile's triangles of this dispatch, the same for all of a workgroup, all of which come along.
fn bin_of(tile: u32, lane: u32) -> vec2<u32> {
    if lane == 0u {
        let first = bins[tile] + tiled.first;
        bin_bounds = vec2(first, min(bins[tile + 1u], first + tiled.count));
    }
    return workgroupUniformLoad(&bin_bounds);
}

// Prepares the next triangles, an invocation each; how many there are. All of a workgroup come along.
fn load(first: u32, end: u32, sample: vec2<i32>, lane: u32) -> u32 {
    workgroupBarrier();
    if first + lane < end {
        let prim = binned[first + lane];
        let s = prepare(prim);
        edges[lane] = edges_of(prim, s, sample);
        planes[lane] = Plane(
            edge(s.b, s.c, sample),
            edge(s.c, s.a, sample),
            edge(s.a, s.b, sample),
            s.area,
            depths(s),
        );
    }
    workgroupBarrier();
    return min(WORKGROUP, end - first);
}

fn covers(i: u32, at: vec2<i32>) -> bool {
    let e = edges[i].low + edges[i].columns * at.x + edges[i].rows * at.y;
    return (e.x | e.y | e.z) >= 0;
}

// The depth key at a covered sample.
fn key_at(i: u32, at: vec2<i32>) -> u32 {
    let change = edges[i].columns * at.x + edges[i].rows * at.y;
    return depth_key(
        planes[i].z,
        planes[i].area,
        wide_add(planes[i].ea, wide_shift(wide(change.x), frame.bits)),
        wide_add(planes[i].eb, wide_shift(wide(change.y), frame.bits)),
        wide_add(planes[i].ec, wide_shift(wide(change.z), frame.bits)),
    );
}
