// Which triangles a tile may hold. Imported where there are `counts` and `offsets`, of tiles.
//#import tile

// Triangles in more tiles than this are shared by a workgroup.
const FEW: u32 = 8u;

// Those, in whatever order invocations come.
struct Larges {
    count: atomic<u32>,
    prims: array<u32>,
}

@group(0) @binding(16) var<storage, read_write> larges: Larges;

// Tiles of which columns and rows hold a pixel whose samples span something of a triangle's box, and how
// many they are.
struct Box {
    first: vec2<u32>,
    across: u32,
    tiles: u32,
}

fn box_of(s: Setup) -> Box {
    let inner = places();
    let low = min(s.a.xy, min(s.b.xy, s.c.xy)) - reference() - inner.high;
    let high = max(s.a.xy, max(s.b.xy, s.c.xy)) - reference() - inner.low;
    let top = vec2(0, i32(frame.first_row));
    let end = vec2(i32(frame.width), i32(frame.first_row + frame.rows));
    // The first pixel at or after `low`, and the last up to `high`: shifts round down.
    let first = max(-((-low) >> vec2(frame.bits)), top);
    let last = min(high >> vec2(frame.bits), end - 1);
    if s.empty || any(first > last) {
        return Box(vec2(0u), 0u, 0u);
    }
    let begin = vec2<u32>(first - top) / SIDE;
    let size = vec2<u32>(last - top) / SIDE - begin + 1u;
    return Box(begin, size.x, size.x * size.y);
}

// Column and row of a tile of a box.
fn tile_in(box: Box, i: u32) -> vec2<u32> {
    return box.first + vec2(i % box.across, i / box.across);
}

// Whether it is transparent.
fn is_drawn(prim: u32) -> bool {
    return faces[prim].a < 1.0;
}

fn list_triangle(at: vec2<u32>, prim: u32, fill: bool) {
    let tile = at.y * tiles_across() + at.x;
    if !fill {
        atomicAdd(&counts[tile], 1u);
        return;
    }
    let address = offsets[tile + 1u] - atomicSub(&counts[tile], 1u);
    if address < tiled.capacity {
        binned[address] = prim;
    }
}

// A triangle by itself, unless it is large.
fn bin_small(prim: u32, fill: bool) {
    if !is_drawn(prim) {
        return;
    }
    let s = prepare(prim);
    let box = box_of(s);
    if box.tiles > FEW {
        if !fill {
            larges.prims[atomicAdd(&larges.count, 1u)] = prim;
        }
        return;
    }
    let reach = reach_of(s);
    for (var i = 0u; i < box.tiles; i += 1u) {
        let tile = tile_in(box, i);
        if meets(reach, tile) {
            list_triangle(tile, prim, fill);
        }
    }
}

// Large triangles, each by as many workgroups as there are for it.
fn bin_large(group: u32, lane: u32, fill: bool) {
    // There may be more workgroups than were asked for (`chunk_of`).
    if group >= tiled.groups {
        return;
    }
    let count = atomicLoad(&larges.count);
    let share = max(tiled.groups / max(count, 1u), 1u);
    for (var i = group / share; i < count; i += tiled.groups / share) {
        let prim = larges.prims[i];
        let s = prepare(prim);
        let box = box_of(s);
        let reach = reach_of(s);
        for (var at = group % share * WORKGROUP + lane; at < box.tiles; at += share * WORKGROUP) {
            let tile = tile_in(box, at);
            if meets(reach, tile) {
                list_triangle(tile, prim, fill);
            }
        }
    }
}

// A bin in the order in which its triangles lie at about the tile's middle, nearest first, so that most
// lists are filled in order. What is not exact about it costs time only. Longer bins are left as they are.
fn sort_bin(tile: u32, lane: u32) {
    if lane == 0u {
        bin_bounds = bin_of(tile);
    }
    let bin = workgroupUniformLoad(&bin_bounds);
    let length = bin.y - bin.x;
    if length < 2u || length > LONG {
        return;
    }
    let middle = first_place(tile) + ((i32(SIDE) / 2) << frame.bits);
    for (var i = lane; i < length; i += WORKGROUP) {
        let prim = binned[bin.x + i];
        own_values[i] = vec2(bitcast<u32>(key_about(prepare(prim), middle)), prim);
    }
    sort_values(length, lane);
    for (var i = lane; i < length; i += WORKGROUP) {
        binned[bin.x + i] = own_values[i].y;
    }
}
