// Lists in rising order: short ones by an invocation each, long ones by a workgroup each, in its
// own memory, and the longest, if there are any, by an invocation for each entry.
// Imported where there is a counter `unfinished`, and with what is listed: its order, `less`, and
// `LAST`, which nothing is behind.
//#import item
//#import run
//#import runs

// Entries, with runs twice as long in order.
@group(0) @binding(8) var<storage, read_write> merged: array<Listed>;

// Lists up to so long are sorted by one invocation each.
const SHORT: u32 = 32u;

// Up to so long, by a workgroup.
const LONG: u32 = 512u;

// Entries of the longest that are put in order at first.
const RUN: u32 = 64u;

// Of 64 lists, those that a workgroup sorts one after another.
var<workgroup> longs: array<Run, 64>;
var<workgroup> all_longs: atomic<u32>;
var<workgroup> number_of_longs: u32;
var<workgroup> own_values: array<Listed, LONG>;

// A list for each invocation of a workgroup, all of which come along. The length of what is too
// long goes to `unfinished`.
fn sort_lists(run: Run, lane: u32) {
    if lane == 0u {
        atomicStore(&all_longs, 0u);
    }
    workgroupBarrier();
    if run.length > LONG {
        atomicMax(&unfinished, run.length);
    } else if run.length > SHORT {
        longs[atomicAdd(&all_longs, 1u)] = run;
    } else {
        sort_short(run);
    }
    workgroupBarrier();
    if lane == 0u {
        number_of_longs = atomicLoad(&all_longs);
    }
    let count = workgroupUniformLoad(&number_of_longs);
    for (var i = 0u; i < count; i += 1u) {
        sort_long(workgroupUniformLoad(&longs[i]), lane);
    }
}

fn sort_short(run: Run) {
    for (var i = 1u; i < run.length; i += 1u) {
        let value = listed[slot(run, i)];
        var at = i;
        while at > 0u && less(value, listed[slot(run, at - 1u)]) {
            listed[slot(run, at)] = listed[slot(run, at - 1u)];
            at -= 1u;
        }
        listed[slot(run, at)] = value;
    }
}

fn sort_long(run: Run, lane: u32) {
    for (var i = lane; i < run.length; i += WORKGROUP) {
        own_values[i] = listed[slot(run, i)];
    }
    sort_values(run.length, lane);
    for (var i = lane; i < run.length; i += WORKGROUP) {
        listed[slot(run, i)] = own_values[i];
    }
    workgroupBarrier();
}

// The first of a workgroup's values, in order: Batcher's bitonic sort, up to the next power of two;
// what is not there is largest.
fn sort_values(length: u32, lane: u32) {
    var size = 2u;
    while size < length {
        size *= 2u;
    }
    for (var i = length + lane; i < size; i += WORKGROUP) {
        own_values[i] = LAST;
    }
    workgroupBarrier();
    for (var block = 2u; block <= size; block *= 2u) {
        for (var reach = block / 2u; reach > 0u; reach /= 2u) {
            for (var i = lane; i < size; i += WORKGROUP) {
                exchange(i, i ^ reach, (i & block) == 0u);
            }
            workgroupBarrier();
        }
    }
}

// Two values in order, or in the reverse; by the first of both.
fn exchange(one: u32, other: u32, rising: bool) {
    if other > one {
        let a = own_values[one];
        let b = own_values[other];
        if less(b, a) == rising {
            own_values[one] = b;
            own_values[other] = a;
        }
    }
}

// An entry of a list from `start` on. In the longest lists, runs of RUN are put in order; an entry's
// rank is its place. Others are left as they are.
fn sort_run(entry: u32, start: u32, end: u32) {
    if end - start <= LONG {
        merged[entry] = listed[entry];
        return;
    }
    let own = start + (entry - start) / RUN * RUN;
    merged[own + rank(entry, own, min(own + RUN, end))] = listed[entry];
}

// The same: two runs in order become one. The first one's are before their equals.
fn merge_runs(entry: u32, start: u32, end: u32, size: u32) {
    let value = listed[entry];
    if end - start <= LONG {
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
fn below(value: Listed, or_equal: bool, start: u32, end: u32) -> u32 {
    var low = start;
    var high = end;
    while low < high {
        let middle = (low + high) / 2u;
        if less(listed[middle], value) || (or_equal && !less(value, listed[middle])) {
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
        before += u32(less(listed[i], value) || (i < entry && !less(value, listed[i])));
    }
    return before;
}
