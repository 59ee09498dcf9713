// A list of a tile, in rows or one entry after another. Imported in place of `run`, where there are `rows`.

struct Run {
    start: u32,
    length: u32,
    // Where its tile's rows are told of, or CONTIGUOUS.
    row: u32,
    in_order: bool,
}

fn slot(run: Run, i: u32) -> u32 {
    if run.row == CONTIGUOUS {
        return run.start + i;
    }
    return run.start + rows[run.row + i];
}
