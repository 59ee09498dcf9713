// The fragments of a tile's transparent triangles, in the order of its bin as far as triangles are not
// small; in the reverse if FROM_BACK is set. What becomes of them is the importer's: it has that,
// `opaque_key`, a struct `Held` in which an invocation keeps what it needs, and
//   start_pixel   before the first fragment,
//   put_small     a fragment of a small triangle, at any pixel of the tile,
//   take_small    those of a batch of triangles, at the invocation's own pixel,
//   put           a fragment of a larger triangle, at the invocation's own pixel,
//   leave_pixel   after all of a batch.
//#import tile

// The samples at which a fragment shows, none where there is no fragment; and its key.
struct Covered {
    mask: u32,
    key: u32,
}

// No opaque surface: farther than every key.
const NOTHING: u32 = 0xffffffffu;

// A triangle of no more pixels than this in a tile is drawn by the invocation that looks at it.
const SPOT: i32 = 8;

// The larger triangles of a batch, which are drawn by all of a workgroup.
var<workgroup> edges: array<Edges, WORKGROUP>;
var<workgroup> steps: array<Steps, WORKGROUP>;
// Which of a batch these are, a bit each.
var<workgroup> larger: array<atomic<u32>, 2>;
var<workgroup> batch: vec2<u32>;
// Triangles that leave a fragment at all pixels.
var<workgroup> everywhere: atomic<u32>;

// Of each pixel of a tile, the key from which on fragments are not kept at any sample; the least of those
// of all samples, and the largest.
var<workgroup> ends: array<u32, WORKGROUP>;
var<workgroup> first_end: atomic<u32>;
var<workgroup> last_end: atomic<u32>;

// A tile's triangles of this dispatch.
var<workgroup> bin_bounds: vec2<u32>;

// What an invocation knows of its pixel.
struct Pixel {
    tile: u32,
    lane: u32,
    // The key from which on fragments are not kept at any sample.
    end: u32,
    // Fragments so far.
    count: u32,
    held: Held,
}

// Draws a tile; all of a workgroup come along. Without `fill`, fragments are only counted: no key need
// be right but where it is compared with an opaque surface's.
fn draw(tile: u32, lane: u32, fill: bool) -> Pixel {
    let bin = begin_tile(tile, lane);
    var own = pixel_in(tile, lane, fill);
    let batches = (max(bin.x, bin.y) - bin.x + WORKGROUP - 1u) / WORKGROUP;
    for (var k = 0u; k < batches; k += 1u) {
        let first = bin.x + WORKGROUP * select(k, batches - 1u - k, FROM_BACK);
        if lane == 0u {
            atomicStore(&larger[0], 0u);
            atomicStore(&larger[1], 0u);
        }
        workgroupBarrier();
        let all = draw_small(first, bin, tile, lane, fill);
        take_small(&own);
        // In a loop, so that drivers that put every call's text in its place have it once.
        for (var half = 0u; half < 2u; half += 1u) {
            let later = (half == 1u) != FROM_BACK;
            draw_some(&own, select(all.x, all.y, later), select(0u, 32u, later), fill);
        }
        leave_pixel(own);
    }
    if !fill && own.end != 0u {
        own.count += atomicLoad(&everywhere);
    }
    return own;
}

// Larger triangles of a batch, a bit each, the first of them number `first`.
fn draw_some(own: ptr<function, Pixel>, which: u32, first: u32, fill: bool) {
    var bits = which;
    while bits != 0u {
        let i = select(firstTrailingBit(bits), firstLeadingBit(bits), FROM_BACK);
        bits &= ~(1u << i);
        draw_larger(own, first + i, fill);
    }
}

// What a workgroup shares; a tile's triangles of this dispatch.
fn begin_tile(tile: u32, lane: u32) -> vec2<u32> {
    if lane == 0u {
        let all = bin_of(tile);
        let first = all.x + tiled.first;
        bin_bounds = vec2(first, min(all.y, first + tiled.count));
        atomicStore(&everywhere, 0u);
        atomicStore(&first_end, NOTHING);
        atomicStore(&last_end, 0u);
    }
    return workgroupUniformLoad(&bin_bounds);
}

fn pixel_in(tile: u32, lane: u32, fill: bool) -> Pixel {
    let pixel = pixel_of(tile, lane);
    var own: Pixel;
    own.tile = tile;
    own.lane = lane;
    if pixel != NOWHERE {
        let ends = kept_up_to(pixel);
        own.end = ends.y;
        atomicMin(&first_end, ends.x);
        atomicMax(&last_end, ends.y);
    }
    ends[lane] = own.end;
    start_pixel(&own, fill);
    // What it stored comes before what anybody puts, of a tile without triangles too.
    workgroupBarrier();
    return own;
}

fn kept_up_to(pixel: u32) -> vec2<u32> {
    if frame.depth_test == 0u {
        return vec2(NOTHING);
    }
    return ends_at(pixel);
}

// The smaller triangles of a batch; which of it are larger, a bit each.
fn draw_small(first: u32, bin: vec2<u32>, tile: u32, lane: u32, fill: bool) -> vec2<u32> {
    if first + lane < bin.y {
        draw_triangle(binned[first + lane], tile, lane, fill);
    }
    workgroupBarrier();
    if lane == 0u {
        batch = vec2(atomicLoad(&larger[0]), atomicLoad(&larger[1]));
    }
    return workgroupUniformLoad(&batch);
}

fn draw_triangle(prim: u32, tile: u32, lane: u32, fill: bool) {
    let place = first_place(tile);
    let s = prepare(prim);
    // A key lies between those of the corners.
    let z = depths(s);
    if min(z.x, min(z.y, z.z)) >= atomicLoad(&last_end) {
        return;
    }
    let is_tested = max(z.x, max(z.y, z.z)) >= atomicLoad(&first_end);
    var own = edges_of(prim, s, place);
    if own.is_full != 0u && !is_tested && !fill {
        atomicAdd(&everywhere, 1u);
        return;
    }
    own.is_tested = u32(is_tested);
    let spot = spot_of(s, place);
    if spot.pixels <= SPOT {
        draw_spot(tile, s, spot, own, fill);
        return;
    }
    atomicOr(&larger[lane / 32u], 1u << (lane % 32u));
    edges[lane] = own;
    if fill || is_tested {
        steps[lane] = steps_of(s, place, own.columns, own.rows);
    }
}

// A triangle by itself.
fn draw_spot(tile: u32, s: Setup, spot: Spot, edges: Edges, fill: bool) {
    for (var i = 0; i < spot.pixels; i += 1) {
        let at = spot.first + vec2(i % spot.across, i / spot.across);
        let covered = small_at(s, spot, edges, tile, at, fill);
        if covered.mask != 0u {
            let pixel = u32(at.y) * SIDE + u32(at.x);
            put_small(tile, pixel, vec2(covered.key, packed(edges.prim, covered.mask)), fill);
        }
    }
}

fn key_of(s: Setup, point: vec2<i32>) -> u32 {
    return depth_key(depths(s), s.area, edge(s.b, s.c, point), edge(s.c, s.a, point), edge(s.a, s.b, point));
}

// A larger triangle, at this invocation's pixel.
fn draw_larger(own: ptr<function, Pixel>, i: u32, fill: bool) {
    let covered = larger_at(i, (*own).tile, (*own).lane, (*own).end, fill);
    if covered.mask != 0u {
        put(own, vec2(covered.key, packed(edges[i].prim, covered.mask)), fill);
    }
}
