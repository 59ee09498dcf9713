// UNSOUND, on purpose: entries are inserted where they belong, as the author's program does. What an
// invocation writes into an entry is plain data, and nothing orders it before the exchange that shows
// the entry to others: they may follow an entry whose key they do not see yet.
//#import cover
//#import counter

struct Sorted {
    key: u32,
    next: atomic<u32>,
}

@group(0) @binding(10) var<storage, read_write> heads: array<atomic<u32>>;

@group(0) @binding(11) var<storage, read_write> nodes: array<Sorted>;

const EOL: u32 = 0xffffffffu;

// Tries are bounded: others may go on inserting, and damaged lists may not end.
const TRIES: u32 = 4096u;

fn insert_sorted(pixel: u32, key: u32) {
    let address = claim();
    if address >= told.capacity {
        return;
    }
    nodes[address].key = key;
    var previous = EOL;
    var current = atomicLoad(&heads[pixel]);
    for (var tries = 0u; tries < TRIES; tries += 1u) {
        if current != EOL {
            if nodes[current].key < key {
                previous = current;
                current = atomicLoad(&nodes[current].next);
                continue;
            }
        }
        atomicStore(&nodes[address].next, current);
        var seen: u32;
        if previous == EOL {
            seen = atomicCompareExchangeWeak(&heads[pixel], current, address).old_value;
        } else {
            seen = atomicCompareExchangeWeak(&nodes[previous].next, current, address).old_value;
        }
        if seen == current {
            return;
        }
        current = seen;
    }
}

@compute @workgroup_size(64)
fn chain(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let job = small_job(chunk_of(group, groups));
    find_pairs(job, lane);
    for (var i = lane; i < atomicLoad(&all_pairs); i += WORKGROUP) {
        let map = map_of(job, pairs[i]);
        let cover = small_cover(map, job, pairs[i], true);
        for (var at = 0u; at < cover.pixels; at += 1u) {
            let sample = sample_of(map, cover, at);
            if sample.is_covered {
                insert_sorted(sample.pixel, key_at(cover, sample));
            }
        }
    }
}

@compute @workgroup_size(64)
fn chain_large(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let job = large_job(chunk_of(group, groups));
    let count = hold(job, lane, true);
    let map = maps[told.first_map + job.map];
    for (var i = 0u; i < count; i += 1u) {
        let cover = held[i];
        for (var at = lane; at < cover.pixels; at += WORKGROUP) {
            let sample = sample_of(map, cover, at);
            if sample.is_covered {
                insert_sorted(sample.pixel, key_at(cover, sample));
            }
        }
    }
}

// Nothing is left to be sorted, if all went well.
@compute @workgroup_size(64)
fn chain_sort(@builtin(global_invocation_id) id: vec3<u32>) {
}
