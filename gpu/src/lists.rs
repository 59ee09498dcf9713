//! Lists as runs of one array: what hosts of `scan.wgsl` and `sort.wgsl` need to know.

/// Lists of a workgroup in a scan. Twin: `TILE` in `scan.wgsl`.
pub const TILE: u32 = 1024;

/// Lists up to so long are sorted by one invocation each. Twin: `SHORT` in `sort.wgsl`.
pub const SHORT: u32 = 64;

/// Kernels that put lists longer than [`SHORT`] in order, by `sort_run` and by `merge_runs`, and
/// the runs that each starts from.
pub(crate) fn long_passes(
    [runs, merge]: [&'static str; 2],
    longest: u32,
) -> impl Iterator<Item = (&'static str, u32)> {
    let merges = std::iter::successors(Some(SHORT), |run| run.checked_mul(2));
    let merges = merges.take_while(move |run| *run < longest);
    let first = (longest > SHORT).then_some((runs, 0));
    first.into_iter().chain(merges.map(move |run| (merge, run)))
}
