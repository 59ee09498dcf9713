// A-buffer by tiles: triangles are put in bins, and each tile of the target is drawn by a workgroup.
// Yang et al. 2010, sections 2, 3.1 and 4.1, with other ways to lay lists out. Twin: spec/src/tiles.rs.
//
// Bins and lists are counted, filled and sorted in passes of their own, and read in later ones. Lists of
// a tile are written by one workgroup, each of their words once in a pass.
//#import jagged_run for run
//#import entry
//#import bin
//#import scan
//#import sort
//#import jagged
//#import shade
//#import network

// The longest list that stage shade leaves to other kernels, which know it already.
@group(0) @binding(12) var<storage, read_write> unfinished: atomic<u32>;

// Stage bin: one triangle.
@compute @workgroup_size(WORKGROUP)
fn bin_count(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let prim = item(id, groups);
    if prim < tiled.items {
        bin_small(prim, false);
    }
}

@compute @workgroup_size(WORKGROUP)
fn bin_count_large(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    bin_large(chunk_of(group, groups), lane, false);
}

@compute @workgroup_size(WORKGROUP)
fn bin_fill(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let prim = item(id, groups);
    if prim < tiled.items {
        bin_small(prim, true);
    }
}

@compute @workgroup_size(WORKGROUP)
fn bin_fill_large(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    bin_large(chunk_of(group, groups), lane, true);
}

// The triangles of a tile, from front to back.
@compute @workgroup_size(WORKGROUP)
fn bin_sort(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let tile = chunk_of(group, groups);
    if tile < tiled.items {
        sort_bin(tile, lane);
    }
}

// Of bins or of lists: entries of each part of them.
@compute @workgroup_size(WORKGROUP)
fn bin_parts(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    sum_tile(chunk_of(group, groups), lane, tiled.items);
}

// Entries of all parts before each; one workgroup.
@compute @workgroup_size(WORKGROUP)
fn bin_sums(@builtin(local_invocation_index) lane: u32) {
    sum_tiles(lane, tiled.items);
}

// Where each begins, and the end of the last.
@compute @workgroup_size(WORKGROUP)
fn bin_offsets(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let own = part_of_tile(chunk_of(group, groups), lane, tiled.items);
    var start = own.before;
    for (var i = own.first; i < own.end; i += 1u) {
        offsets[i] = start;
        start = plus(start, atomicLoad(&counts[i]));
        if i + 1u == tiled.items {
            offsets[tiled.items] = start;
        }
    }
}

// Stage jagged: how long the list of each pixel of a tile will be.
@compute @workgroup_size(WORKGROUP)
fn jagged_count(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let tile = chunk_of(group, groups);
    if tile < tiled.items {
        count_lists(tile, lane);
    }
}

// Where they will be; 64 lists of a tile.
@compute @workgroup_size(WORKGROUP)
fn jagged_place(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let tile = chunk_of(group, groups);
    if tile < tiled.items && is_left(tile) {
        place_lists(tile, lane);
    }
}

// The same lists, filled.
@compute @workgroup_size(WORKGROUP)
fn jagged_fill(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let tile = chunk_of(group, groups);
    if has_lists(tile) {
        fill_lists(tile, lane);
    }
}

// Stage shade: lists that are too long for registers, put in order; 64 of them.
@compute @workgroup_size(WORKGROUP)
fn shade_sort(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let tile = chunk_of(group, groups);
    if !has_lists(tile) {
        return;
    }
    var run = run_at(tile, lane);
    run.length = select(0u, run.length, kernel_of_run(run) == IN_MEMORY);
    sort_lists(run, lane);
}

// The longest lists: runs in order; one entry. Of a list, `groups` workgroups take all entries.
@compute @workgroup_size(WORKGROUP)
fn shade_runs(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let entry = long_entry(chunk_of(group, groups), lane);
    if entry.at < entry.end {
        sort_run(entry.at, entry.start, entry.end);
    }
}

// The same: two runs in order become one; one entry.
@compute @workgroup_size(WORKGROUP)
fn shade_merge(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let entry = long_entry(chunk_of(group, groups), lane);
    if entry.at < entry.end {
        merge_runs(entry.at, entry.start, entry.end, tiled.run);
    }
}

// Lists that were filled in order.
@compute @workgroup_size(WORKGROUP)
fn shade_ordered(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let own = pixel_at(chunk_of(group, groups), lane);
    if own.pixel != NOWHERE && kernel_of_run(own.run) == AS_IT_IS {
        show(own.pixel, shaded(own));
    }
}

// Kernels shade_8, shade_16, shade_32 and shade_64 sort lists of at most so many entries in registers, and
// blend them: `network` has them, which a program writes (wgsl/network.rs).

// Other lists, sorted before. A dispatch goes on where the one before stopped: the picture holds the
// sum so far and the transmittance.
@compute @workgroup_size(WORKGROUP)
fn shade_long(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let own = pixel_at(chunk_of(group, groups), lane);
    if own.pixel == NOWHERE || kernel_of_run(own.run) != IN_MEMORY {
        return;
    }
    let length = min(own.run.length, tiled.layers);
    if tiled.first > 0u && tiled.first >= length {
        return;
    }
    var seen = unseen();
    if tiled.first > 0u {
        seen = kept_of(own.pixel);
    }
    let last = min(length, tiled.first + tiled.count);
    for (var i = tiled.first; i < last; i += 1u) {
        let entry = listed[slot(own.run, i)];
        if is_hidden(entry.x, own.behind) {
            break;
        }
        seen = over(seen, entry, own.behind);
    }
    if last == length {
        show(own.pixel, seen);
    } else {
        keep(own.pixel, seen);
    }
}
