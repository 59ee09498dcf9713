// Lists of words, for runs.wgsl and sort.wgsl.

alias Listed = u32;

const LAST: Listed = 0xffffffffu;

fn less(a: Listed, b: Listed) -> bool {
    return a < b;
}
