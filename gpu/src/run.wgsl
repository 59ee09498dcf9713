// A list as a run of `listed`.

struct Run {
    start: u32,
    length: u32,
}

// Where its entry i is.
fn slot(run: Run, i: u32) -> u32 {
    return run.start + i;
}
