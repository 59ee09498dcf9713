// A-buffer without links: an array for each pixel, or runs of one array, of 8 bytes a fragment.
// Yang et al. 2010, section 2: bucket peeling's arrays (Liu et al. 2010, FreePipe), and Precalc.
// Twin: spec/src/layouts.rs.
//
// Places are handed out by atomics; entries are read in later passes.
//#import listing
//#import scan
//#import sort

// A fragment in a list: depth key, triangle and mask. Nearest first, ties by triangle.
alias Listed = vec2<u32>;

const LAST: Listed = vec2(0xffffffffu, 0xffffffffu);

fn less(a: Listed, b: Listed) -> bool {
    return a.x < b.x || (a.x == b.x && a.y < b.y);
}

@group(0) @binding(12) var<storage, read_write> unfinished: atomic<u32>;

// Layers of a list in one dispatch, as in relink.wgsl.
const STEPS: u32 = 16384u;

// Whether a pass over part of the depth range is the one for an entry.
fn in_range(entry: Listed) -> bool {
    return !less(entry, vec2(listing.from_key, listing.from_face))
        && less(entry, vec2(listing.until_key, listing.until_face));
}

// Stage bucket: into the pixel's array, if there is room; the counter counts all.
fn put(fragment: Fragment) {
    let mask = visible(fragment);
    let entry = vec2(fragment.key, face_of(fragment.prim, mask));
    if mask == 0u || !in_range(entry) {
        return;
    }
    let slot = atomicAdd(&counts[fragment.pixel], 1u);
    if slot < listing.entries {
        listed[fragment.pixel * listing.entries + slot] = entry;
    }
}

// Stage precalc, first pass over the triangles: how many there are.
fn count(fragment: Fragment) {
    if visible(fragment) != 0u {
        atomicAdd(&counts[fragment.pixel], 1u);
    }
}

// Second pass: into the pixel's run. Counts are used up.
fn fill(fragment: Fragment) {
    let mask = visible(fragment);
    if mask == 0u {
        return;
    }
    let address = offsets[fragment.pixel + 1u] - atomicSub(&counts[fragment.pixel], 1u);
    if address < frame.capacity {
        listed[address] = vec2(fragment.key, face_of(fragment.prim, mask));
    }
}

@compute @workgroup_size(WORKGROUP)
fn bucket_clear(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x < band_pixels() {
        atomicStore(&counts[id.x], 0u);
    }
}

@compute @workgroup_size(WORKGROUP)
fn bucket(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= frame.items {
        return;
    }
    var walk = start(id.x);
    while advance(&walk) {
        put(walk.fragment);
    }
}

@compute @workgroup_size(WORKGROUP)
fn precalc_count(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= frame.items {
        return;
    }
    var walk = start(id.x);
    while advance(&walk) {
        count(walk.fragment);
    }
}

@compute @workgroup_size(WORKGROUP)
fn precalc_fill(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= frame.items {
        return;
    }
    var walk = start(id.x);
    while advance(&walk) {
        fill(walk.fragment);
    }
}

@fragment
fn bucket_fragment(drawn: Drawn) {
    put(fragment_of(drawn));
}

@fragment
fn precalc_count_fragment(drawn: Drawn) {
    count(fragment_of(drawn));
}

@fragment
fn precalc_fill_fragment(drawn: Drawn) {
    fill(fragment_of(drawn));
}

// Fragments of each part of the pixels.
@compute @workgroup_size(WORKGROUP)
fn precalc_parts(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    sum_tile(chunk_of(group, groups), lane, band_pixels());
}

// Fragments of all parts before each; one workgroup.
@compute @workgroup_size(WORKGROUP)
fn precalc_sums(@builtin(local_invocation_index) lane: u32) {
    sum_tiles(lane, band_pixels());
}

// Where each pixel's run begins, and the end of the last.
@compute @workgroup_size(WORKGROUP)
fn precalc_offsets(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let own = part_of_tile(chunk_of(group, groups), lane, band_pixels());
    var start = own.before;
    for (var i = own.first; i < own.end; i += 1u) {
        offsets[i] = start;
        start = plus(start, atomicLoad(&counts[i]));
        if i + 1u == band_pixels() {
            offsets[band_pixels()] = start;
        }
    }
}

// Where a pixel's entries begin, and how many there are.
fn entries_of(pixel: u32) -> vec2<u32> {
    if listing.entries == 0u {
        return run_of(pixel, band_pixels());
    }
    if pixel >= band_pixels() {
        return vec2(0u);
    }
    return vec2(pixel * listing.entries, min(atomicLoad(&counts[pixel]), listing.entries));
}

// The same of the pixel that an entry is of.
fn entries_around(entry: u32) -> vec2<u32> {
    if listing.entries == 0u {
        return entries_of(list_of(entry, band_pixels()));
    }
    return entries_of(entry / listing.entries);
}

// Stage rank: lists in order; 64 pixels.
@compute @workgroup_size(WORKGROUP)
fn rank_lists(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let own = entries_of(chunk_of(group, groups) * WORKGROUP + lane);
    sort_lists(Run(own.x, own.y), lane);
}

// The longest lists: runs in order; one entry.
@compute @workgroup_size(WORKGROUP)
fn rank_runs(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let entry = item(id, groups);
    if entry < listing.items {
        let own = entries_around(entry);
        if entry < own.x + own.y {
            sort_run(entry, own.x, own.x + own.y);
        }
    }
}

// The same: two runs in order become one; one entry.
@compute @workgroup_size(WORKGROUP)
fn rank_merge(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let entry = item(id, groups);
    if entry < listing.items {
        let own = entries_around(entry);
        if entry < own.x + own.y {
            merge_runs(entry, own.x, own.x + own.y, listing.run);
        }
    }
}

// Entries of a list that a dispatch shows, at most `most` from listing.first on: first and end. Arrays have no
// use for offsets, which then count the layers that passes over nearer ranges of depth have shown.
fn shown_entries(pixel: u32, count: u32, most: u32) -> vec2<u32> {
    var left = listing.layers;
    if (listing.flags & FOLLOWS) != 0u {
        left -= min(left, offsets[pixel]);
    }
    if (listing.flags & GOES_ON) != 0u {
        offsets[pixel] = plus(listing.layers - left, count);
    }
    return vec2(listing.first, min(min(count, left), listing.first + most));
}

// The layers of a pixel from listing.first on, under those before. Entries at or behind the opaque
// surface are not seen.
@compute @workgroup_size(WORKGROUP)
fn rank_blend(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= band_pixels() {
        return;
    }
    var seen = vec4(0.0, 0.0, 0.0, 1.0);
    if (listing.flags & BEGINS) == 0u {
        seen = picture[id.x];
    }
    let own = entries_of(id.x);
    let end = opaque_key[id.x];
    let shown = shown_entries(id.x, own.y, STEPS);
    for (var i = shown.x; i < shown.y; i += 1u) {
        let entry = listed[own.x + i];
        if entry.x >= end {
            break;
        }
        seen = under(seen, faces[entry.y >> MASK_BITS]);
    }
    if (listing.flags & ENDS) != 0u {
        seen = vec4(seen.rgb + seen.a * behind(id.x), 1.0);
    }
    picture[id.x] = seen;
}
