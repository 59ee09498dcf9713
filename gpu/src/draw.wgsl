// The fragments of a tile's transparent triangles, in the order of its bin as far as triangles are not
// small; in the reverse if FROM_BACK is set. What becomes of them is the importer's: it has that,
// `opaque_key`, a struct `Held` in which an invocation keeps what it needs, and
//   start_pixel   before the first fragment,
//   put_small     a fragment of a small triangle, at any pixel of the tile,
//   take_small    those of a batch of triangles, at the invocation's own pixel,
//   put           a fragment of a larger triangle, at the invocation's own pixel,
//   leave_pixel   after all of a batch.
//#import tile

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

// Of each pixel of a tile, the key from which on fragments are not kept; the least and the largest.
var<workgroup> ends: array<u32, WORKGROUP>;
var<workgroup> first_end: atomic<u32>;
var<workgroup> last_end: atomic<u32>;

// A tile's triangles of this dispatch.
var<workgroup> bin_bounds: vec2<u32>;

// What an invocation knows of its pixel.
struct Pixel {
    tile: u32,
    lane: u32,
    // The key from which on fragments are not kept.
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
        draw_some(&own, select(all.x, all.y, FROM_BACK), select(0u, 32u, FROM_BACK), fill);
        draw_some(&own, select(all.y, all.x, FROM_BACK), select(32u, 0u, FROM_BACK), fill);
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
        own.end = end_at(pixel);
        atomicMin(&first_end, own.end);
        atomicMax(&last_end, own.end);
    }
    ends[lane] = own.end;
    start_pixel(&own, fill);
    return own;
}

fn end_at(pixel: u32) -> u32 {
    if frame.depth_test == 0u {
        return NOTHING;
    }
    return opaque_key[pixel];
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
    let sample = first_sample(tile);
    let s = prepare(prim);
    // A key lies between those of the corners.
    let z = depths(s);
    if min(z.x, min(z.y, z.z)) >= atomicLoad(&last_end) {
        return;
    }
    let is_tested = fill || max(z.x, max(z.y, z.z)) >= atomicLoad(&first_end);
    var own = edges_of(prim, s, sample);
    if own.is_full != 0u && !is_tested {
        atomicAdd(&everywhere, 1u);
        return;
    }
    let spot = spot_of(s, sample);
    if spot.pixels <= SPOT {
        draw_spot(tile, s, spot, own, is_tested, fill);
        return;
    }
    atomicOr(&larger[lane / 32u], 1u << (lane % 32u));
    own.is_tested = u32(is_tested);
    edges[lane] = own;
    if is_tested {
        steps[lane] = steps_of(s, sample, own.columns, own.rows);
    }
}

// A triangle by itself.
fn draw_spot(tile: u32, s: Setup, spot: Spot, edges: Edges, is_tested: bool, fill: bool) {
    for (var i = 0; i < spot.pixels; i += 1) {
        let at = spot.first + vec2(i % spot.across, i / spot.across);
        if covers(edges, at) {
            var key = 0u;
            if is_tested {
                key = key_of(s, spot.sample + (at << vec2(frame.bits)));
            }
            let pixel = u32(at.y) * SIDE + u32(at.x);
            if key < ends[pixel] {
                put_small(tile, pixel, vec2(key, edges.prim), fill);
            }
        }
    }
}

fn key_of(s: Setup, point: vec2<i32>) -> u32 {
    return depth_key(depths(s), s.area, edge(s.b, s.c, point), edge(s.c, s.a, point), edge(s.a, s.b, point));
}

// A larger triangle, at this invocation's pixel.
fn draw_larger(own: ptr<function, Pixel>, i: u32, fill: bool) {
    let at = vec2((*own).lane % SIDE, (*own).lane / SIDE);
    if edges[i].is_full == 0u && !covers(edges[i], vec2<i32>(at)) {
        return;
    }
    var entry = vec2(0u, edges[i].prim);
    if fill || edges[i].is_tested != 0u {
        let stepped = step_key(steps[i], at);
        entry.x = stepped.key;
        if !stepped.is_sure {
            entry.x = key_at(entry.y, pixel_of((*own).tile, (*own).lane), 0u, 0u);
        }
    }
    if entry.x < (*own).end {
        put(own, entry, fill);
    }
}
