// Lists as runs of one array. Imported with what is listed, `Listed`.

// Where each list's run starts; one more than lists.
@group(0) @binding(6) var<storage, read_write> offsets: array<u32>;

// What is listed, a run for each list.
@group(0) @binding(7) var<storage, read_write> listed: array<Listed>;

// The list of an invocation, of so many; an empty one for what is too many.
fn run_of(list: u32, lists: u32) -> vec2<u32> {
    if list >= lists {
        return vec2(0u);
    }
    return vec2(offsets[list], offsets[list + 1u] - offsets[list]);
}

// The list whose run an entry is in, of so many.
fn list_of(entry: u32, lists: u32) -> u32 {
    var low = 0u;
    var high = lists;
    while low < high {
        let middle = (low + high) / 2u;
        if offsets[middle] <= entry {
            low = middle + 1u;
        } else {
            high = middle;
        }
    }
    return low - 1u;
}
