//! What hosts of lists need to know: runs of one array, as of `scan.wgsl` and `sort.wgsl`; kernels that
//! follow lists and ask for another dispatch.

use std::time::Duration;

use crate::context::Gpu;
use crate::error::GpuError;

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

/// Bytes before the pixels' progress, which say whether any asks for another dispatch. Twins: `Work` in
/// WGSL.
pub(crate) const HEADER: u64 = 4;

/// Dispatches a stage until no pixel asks for more, from no progress on; `dispatch` gives its time. What
/// needs more than `most` follows a list that does not end.
pub(crate) fn until_done(
    gpu: &Gpu,
    progress: &wgpu::Buffer,
    (stage, most): (&'static str, u64),
    dispatch: impl Fn() -> Result<Duration, GpuError>,
) -> Result<Duration, GpuError> {
    let clear = |bytes| {
        let mut encoder = gpu.encoder();
        encoder.clear_buffer(progress, 0, bytes);
        gpu.submit(encoder)
    };
    let mut time = Duration::ZERO;
    clear(None)?;
    for _ in 0..most {
        clear(Some(HEADER))?;
        time += dispatch()?;
        if gpu.word(progress, 0)? == 0 {
            return Ok(time);
        }
    }
    Err(GpuError::Endless {
        adapter: gpu.name.clone(),
        stage,
    })
}
