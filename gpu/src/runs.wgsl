// Lists as runs of one array. Imported with what is listed, `Listed`.

// Where each list's run starts; one more than lists.
@group(0) @binding(6) var<storage, read_write> offsets: array<u32>;

// What is listed, a run for each list.
@group(0) @binding(7) var<storage, read_write> listed: array<Listed>;

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
