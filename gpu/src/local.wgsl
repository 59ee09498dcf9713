// A-buffer whose lists never reach memory. A tile's triangles come from front to back, about; an
// invocation keeps the last eight fragments of its pixel in order, in registers, and blends the nearest
// of them whenever another one comes. If one comes that belongs in front of what was blended, the tile
// is left to lists in memory. So the picture is exact, and most tiles take no room.
// Twin: spec/src/tiles.rs.
//#import entry
//#import draw
//#import shown
//#import digest

const FROM_BACK: bool = false;

// Fragments that wait.
const WINDOW: u32 = 8u;

struct Held {
    // What waits, nearest first; at first, nothing that can be blended.
    a: Listed,
    b: Listed,
    c: Listed,
    d: Listed,
    e: Listed,
    f: Listed,
    g: Listed,
    h: Listed,
    // The last that was blended, and how many were.
    last: Listed,
    blended: u32,
    words: u32,
    behind: Behind,
    seen: Seen,
    is_out_of_order: bool,
}

// Fragments of small triangles, in a list for each pixel: at most SPOT of each of a batch.
struct Small {
    entry: Listed,
    next: u32,
}

const SMALLS: u32 = 512u;
const_assert SMALLS == u32(SPOT) * WORKGROUP;

var<workgroup> smalls: array<Small, SMALLS>;
var<workgroup> all_smalls: atomic<u32>;
var<workgroup> first_small: array<atomic<u32>, WORKGROUP>;
var<workgroup> left_over: atomic<u32>;

fn start_pixel(own: ptr<function, Pixel>, fill: bool) {
    (*own).held.seen = unseen();
    if (*own).end != 0u {
        (*own).held.behind = behind_at(pixel_of((*own).tile, (*own).lane));
    }
    atomicStore(&first_small[(*own).lane], NOTHING);
    if (*own).lane == 0u {
        atomicStore(&all_smalls, 0u);
        atomicStore(&left_over, 0u);
    }
}

fn put_small(tile: u32, pixel: u32, entry: Listed, fill: bool) {
    let at = atomicAdd(&all_smalls, 1u);
    smalls[at] = Small(entry, atomicExchange(&first_small[pixel], at));
}

fn take_small(own: ptr<function, Pixel>) {
    // In order: which tiles are left does not depend on how invocations come.
    let first = atomicLoad(&first_small[(*own).lane]);
    var next = next_small(first, false, LAST);
    while any(next != LAST) {
        put(own, next, true);
        next = next_small(first, true, next);
    }
    atomicStore(&first_small[(*own).lane], NOTHING);
    if (*own).lane == 0u {
        atomicStore(&all_smalls, 0u);
    }
}

// The nearest of a list of small triangles' fragments, or the nearest behind another one.
fn next_small(first: u32, is_behind: bool, other: Listed) -> Listed {
    var found = LAST;
    for (var at = first; at != NOTHING; at = smalls[at].next) {
        let entry = smalls[at].entry;
        if less(entry, found) && (!is_behind || less(other, entry)) {
            found = entry;
        }
    }
    return found;
}

fn leave_pixel(own: Pixel) {
}

struct Pair {
    nearer: Listed,
    farther: Listed,
}

fn pair(a: Listed, b: Listed) -> Pair {
    let rises = less(a, b);
    return Pair(select(b, a, rises), select(a, b, rises));
}

// Takes the nearest of those that wait.
fn take_nearest(own: ptr<function, Pixel>) -> Listed {
    let nearest = (*own).held.a;
    (*own).held.a = (*own).held.b;
    (*own).held.b = (*own).held.c;
    (*own).held.c = (*own).held.d;
    (*own).held.d = (*own).held.e;
    (*own).held.e = (*own).held.f;
    (*own).held.f = (*own).held.g;
    (*own).held.g = (*own).held.h;
    return nearest;
}

// One that lies behind all that wait, as most do: by itself, for 3 % of the picture's time on an H200.
fn put_last(own: ptr<function, Pixel>, entry: Listed) {
    let p = (*own).held;
    (*own).held.a = p.b;
    (*own).held.b = p.c;
    (*own).held.c = p.d;
    (*own).held.d = p.e;
    (*own).held.e = p.f;
    (*own).held.f = p.g;
    (*own).held.g = p.h;
    (*own).held.h = entry;
    if (*own).count >= WINDOW {
        blend(own, p.a);
    }
    (*own).count += 1u;
}

fn put(own: ptr<function, Pixel>, entry: Listed, fill: bool) {
    let p = (*own).held;
    if less(p.h, entry) {
        put_last(own, entry);
        return;
    }
    // It goes to its place from the far end; the nearest of nine comes out.
    let h = pair(p.h, entry);
    let g = pair(p.g, h.nearer);
    let f = pair(p.f, g.nearer);
    let e = pair(p.e, f.nearer);
    let d = pair(p.d, e.nearer);
    let c = pair(p.c, d.nearer);
    let b = pair(p.b, c.nearer);
    let a = pair(p.a, b.nearer);
    (*own).held.a = a.farther;
    (*own).held.b = b.farther;
    (*own).held.c = c.farther;
    (*own).held.d = d.farther;
    (*own).held.e = e.farther;
    (*own).held.f = f.farther;
    (*own).held.g = g.farther;
    (*own).held.h = h.farther;
    if (*own).count >= WINDOW {
        blend(own, a.nearer);
    }
    (*own).count += 1u;
}

fn blend(own: ptr<function, Pixel>, entry: Listed) {
    (*own).held.is_out_of_order = (*own).held.is_out_of_order || less(entry, (*own).held.last);
    (*own).held.last = entry;
    (*own).held.words = digested((*own).held.words, entry);
    if !is_hidden(entry.x, (*own).held.behind) && (*own).held.blended < tiled.layers {
        (*own).held.seen = over((*own).held.seen, entry, (*own).held.behind);
    }
    (*own).held.blended += 1u;
}

// FNV-1a (Fowler, Noll and Vo), by words.
fn digested(words: u32, entry: Listed) -> u32 {
    return (((words ^ entry.x) * 16777619u) ^ entry.y) * 16777619u;
}

// What waits after the last fragment, nearest first; the first of a list of fewer are nothing.
fn finish(own: ptr<function, Pixel>) {
    let waiting = min((*own).count, WINDOW);
    for (var i = 0u; i < WINDOW; i += 1u) {
        let nearest = take_nearest(own);
        if i + waiting >= WINDOW {
            blend(own, nearest);
        }
    }
}

fn draw_local(tile: u32, lane: u32) {
    var own = draw(tile, lane, true);
    finish(&own);
    let bin = bin_of(tile);
    let is_cut = bin.y - bin.x > tiled.count;
    if own.held.is_out_of_order || is_cut {
        atomicStore(&left_over, 1u);
    }
    workgroupBarrier();
    let is_other = atomicLoad(&left_over) != 0u;
    let pixel = pixel_of(tile, lane);
    if !is_other && pixel != NOWHERE {
        show(pixel, own.held.seen);
        digests.pixels[pixel] = Digest(own.count | select(0u, FINISHED, lane == 0u), own.held.words);
    }
    if is_other && lane == 0u {
        atomicAdd(&digests.left, 1u);
    }
}

// Stage local: a tile.
@compute @workgroup_size(WORKGROUP)
fn local(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let tile = chunk_of(group, groups);
    if tile < tiled.items {
        draw_local(tile, lane);
    }
}
