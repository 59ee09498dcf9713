//! An adapter's wavefront: checked before it is timed, and after.

use triptych_gpu::dispatch::{Room, Stages, Timed};
use triptych_gpu::error::GpuError;
use triptych_gpu::grid::Shape;
use triptych_gpu::kernel::Kernels;
use triptych_gpu::timer::Timer;
use triptych_spec::dispatch::Sums;

use super::super::legs::Station;
use super::super::warm::wake;
use crate::compare::dispatch::picture;
use crate::replay::dispatch::DispatchRun;

/// Frames per second of runs of so many frames, by the device's own clock; of a software driver a run is a
/// frame.
///
/// # Errors
/// What the device refuses; pictures that are not the spec's, in words.
pub(super) fn measure(
    station: &Station<'_>,
    run: &DispatchRun,
    [runs, frames]: [u32; 2],
) -> Result<Vec<f64>, String> {
    let gpu = &station.adapter.gpu;
    // With native integers where there are any.
    let native = station.adapter.native.as_ref();
    let trusted = native.map(|_| Kernels::trusted(true, |sources| sources));
    let checked = native.unwrap_or(&station.adapter.kernels);
    let kernels = trusted.as_ref().unwrap_or(&station.kernels);
    let (world, grid) = (&run.setup.world, &run.setup.grid);
    let stages = Stages::new(gpu, checked, world, grid);
    let frame = stages.and_then(|mut stages| stages.frame(Room::default()));
    let frame = frame.map_err(words)?;
    confirm(run, &frame.sums)?;
    let shape = Shape::checked(gpu, checked, &world.blockers, &grid.axes).map_err(words)?;
    let cells = shape.map(|shape| (&grid.axes, shape));
    let ready = Timed::new(gpu, kernels, world, cells, &frame.batches).map_err(words)?;
    let timer = Timer::new(gpu, &station.clock, 1).map_err(words)?;
    let once = || ready.time_whole(&timer);
    once().map_err(words)?;
    let software = gpu.info.device_type == wgpu::DeviceType::Cpu;
    let frames = if software { 1 } else { frames };
    let mut all = Vec::new();
    for _ in 0..runs {
        if !software {
            wake(|| once().map(drop)).map_err(words)?;
        }
        let mut seconds = 0.0;
        for _ in 0..frames {
            seconds += once().map_err(words)?;
        }
        all.push(f64::from(frames) / seconds);
    }
    confirm(run, &ready.sums().map_err(words)?)?;
    Ok(all)
}

fn words(error: GpuError) -> String {
    error.to_string()
}

/// Holds a picture to the spec's, within its bounds.
fn confirm(run: &DispatchRun, sums: &Sums) -> Result<(), String> {
    let judgement = picture(&run.sums, &run.bounds, sums);
    match judgement.differ() {
        0 => Ok(()),
        count => Err(format!("{count} pixels are not the spec's")),
    }
}
