// Runs of one array.

// Where each cell's run starts; one more than cells.
@group(0) @binding(6) var<storage, read_write> offsets: array<u32>;

// Ids, a run for each cell.
@group(0) @binding(7) var<storage, read_write> prims: array<u32>;

// The cell whose run an entry is in.
fn cell_of(entry: u32) -> u32 {
    var low = 0u;
    var high = cells.x * cells.y * cells.z;
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

// How many of a run in order are smaller.
fn below(prim: u32, start: u32, end: u32) -> u32 {
    var low = start;
    var high = end;
    while low < high {
        let middle = (low + high) / 2u;
        if prims[middle] < prim {
            low = middle + 1u;
        } else {
            high = middle;
        }
    }
    return low - start;
}

// The same of a run in any order.
fn rank(prim: u32, start: u32, end: u32) -> u32 {
    var smaller = 0u;
    for (var i = start; i < end; i += 1u) {
        smaller += u32(prims[i] < prim);
    }
    return smaller;
}
