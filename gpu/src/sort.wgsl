// Lists in rising order: short ones by an invocation each, longer ones by one for each entry.
// Imported where there is a counter `unfinished`.
//#import runs

// Entries, with runs twice as long in order.
@group(0) @binding(8) var<storage, read_write> merged: array<u32>;

// Lists up to so long are sorted by one invocation each.
const SHORT: u32 = 64u;

// A short list; the length of a longer one goes to `unfinished`.
fn sort_list(list: u32) {
    let start = offsets[list];
    let end = offsets[list + 1u];
    if end - start > SHORT {
        atomicMax(&unfinished, end - start);
        return;
    }
    for (var i = start + 1u; i < end; i += 1u) {
        let value = listed[i];
        var at = i;
        while at > start && listed[at - 1u] > value {
            listed[at] = listed[at - 1u];
            at -= 1u;
        }
        listed[at] = value;
    }
}

// Long lists, of so many lists: runs of SHORT in order; an entry's rank is its place.
fn sort_run(entry: u32, lists: u32) {
    let list = list_of(entry, lists);
    let start = offsets[list];
    let end = offsets[list + 1u];
    if end - start <= SHORT {
        merged[entry] = listed[entry];
        return;
    }
    let own = start + (entry - start) / SHORT * SHORT;
    merged[own + rank(entry, own, min(own + SHORT, end))] = listed[entry];
}

// The same: two runs in order become one. The first one's are before their equals.
fn merge_runs(entry: u32, lists: u32, size: u32) {
    let list = list_of(entry, lists);
    let start = offsets[list];
    let end = offsets[list + 1u];
    let value = listed[entry];
    if end - start <= SHORT {
        merged[entry] = value;
        return;
    }
    let run = (entry - start) / size;
    let own = start + run * size;
    let pair = start + (run & 0xfffffffeu) * size;
    let is_first = own == pair;
    let other = min(select(pair, pair + size, is_first), end);
    let before = below(value, !is_first, other, min(other + size, end));
    merged[pair + (entry - own) + before] = value;
}

// How many of a run in order are smaller, or as large.
fn below(value: u32, or_equal: bool, start: u32, end: u32) -> u32 {
    var low = start;
    var high = end;
    while low < high {
        let middle = (low + high) / 2u;
        if listed[middle] < value || (or_equal && listed[middle] == value) {
            low = middle + 1u;
        } else {
            high = middle;
        }
    }
    return low - start;
}

// How many of a run in any order are smaller than an entry, or as large and before it.
fn rank(entry: u32, start: u32, end: u32) -> u32 {
    let value = listed[entry];
    var before = 0u;
    for (var i = start; i < end; i += 1u) {
        before += u32(listed[i] < value || (listed[i] == value && i < entry));
    }
    return before;
}
