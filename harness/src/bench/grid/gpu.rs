//! An adapter: checked once, then timed.

use triptych_gpu::error::GpuError;
use triptych_gpu::grid::{Device, Shape, Stages, Timed};
use triptych_gpu::kernel::Kernels;
use triptych_gpu::timer::{Clock, Timer};
use triptych_spec::abuffer::NOTHING;
use triptych_spec::grid::ray::Ray;
use triptych_spec::grid::trace::Query;
use triptych_spec::grid::{Blockers, Grid, Membership};

use crate::compare::grid::{Asked, any, closest};

/// What is measured: a grid and rays of one kind, with the spec's answers to the first.
pub(super) struct Work<'a> {
    pub(super) blockers: &'a Blockers,
    pub(super) grid: &'a Grid,
    pub(super) rays: &'a [Ray],
    pub(super) asked: Asked<'a>,
}

/// Runs a checked build and trace, compares them with the spec, and sets up what is timed.
///
/// # Errors
/// What the device refuses; answers that are not the spec's, in words.
pub(super) fn set_up<'g>(
    gpu: &'g triptych_gpu::context::Gpu,
    checked: &'g Kernels,
    kernels: &'g Kernels,
    clock: &Clock,
    work: &Work<'_>,
) -> Result<(Timed<'g>, Timer), String> {
    let shape = shape(gpu, checked, work)?;
    let words = |e: GpuError| e.to_string();
    let timed = Timed::new(
        gpu,
        kernels,
        work.blockers,
        &work.grid.axes,
        work.rays,
        shape,
    );
    let timed = timed.map_err(words)?;
    let timer = Timer::new(gpu, clock, 3).map_err(words)?;
    timed.time(&timer).map_err(words)?;
    let hits = timed.hits().map_err(words)?;
    let judgement = closest(work.asked, &hits[..work.asked.rays.len()]);
    match judgement.differ() {
        0 => Ok((timed, timer)),
        _ => Err(format!(
            "unlike the spec: {}",
            judgement.described.join("; ")
        )),
    }
}

fn shape(
    gpu: &triptych_gpu::context::Gpu,
    kernels: &Kernels,
    work: &Work<'_>,
) -> Result<Shape, String> {
    let words = |e: GpuError| e.to_string();
    let grid = work.grid;
    let device = Device::new(gpu, kernels, work.blockers, &grid.axes, Membership::Box);
    let mut stages = Stages::new(device.map_err(words)?).map_err(words)?;
    stages.count().map_err(words)?;
    let offsets = stages.scan().map_err(words)?;
    let entries = offsets.last().copied().unwrap_or(0);
    let prims = stages.fill(entries, entries).map_err(words)?;
    let chunks = stages.chunks;
    if offsets != grid.offsets || prims != grid.prims {
        return Err("lists unlike the spec's".to_owned());
    }
    let mut rounds = [0; 2];
    for (query, rounds) in [Query::Any, Query::Closest].into_iter().zip(&mut rounds) {
        let hits = stages.trace(work.rays, query).map_err(words)?;
        *rounds = stages.dispatches;
        let own = &hits[..work.asked.rays.len()];
        let judgement = match query {
            Query::Any => any(work.asked, own),
            Query::Closest => closest(work.asked, own),
        };
        if judgement.differ() > 0 || hits.iter().all(|hit| hit.prim == NOTHING) {
            return Err(format!(
                "unlike the spec: {}",
                judgement.described.join("; ")
            ));
        }
    }
    let lengths = offsets.windows(2).map(|run| run[1] - run[0]);
    Ok(Shape {
        entries,
        longest: lengths.max().unwrap_or(0),
        chunks,
        rounds,
    })
}
