//! Lists as runs of one array: what hosts of `scan.wgsl` and `sort.wgsl` need to know.

/// Lists of a workgroup in a scan. Twin: `TILE` in `scan.wgsl`.
pub const TILE: u32 = 1024;

/// Lists up to so long are sorted by a workgroup each. Twin: `LONG` in `sort.wgsl`.
pub const LONG: u32 = 512;

/// Entries of longer ones that are put in order at first. Twin: `RUN` in `sort.wgsl`.
pub const RUN: u32 = 64;

/// Kernels that put lists longer than [`LONG`] in order, by `sort_run` and by `merge_runs`, and
/// the runs that each starts from.
pub(crate) fn long_passes(
    [runs, merge]: [&'static str; 2],
    longest: u32,
) -> impl Iterator<Item = (&'static str, u32)> {
    let is_long = longest > LONG;
    let merges = std::iter::successors(is_long.then_some(RUN), |run| run.checked_mul(2));
    let merges = merges.take_while(move |run| *run < longest);
    let first = is_long.then_some((runs, 0));
    first.into_iter().chain(merges.map(move |run| (merge, run)))
}
