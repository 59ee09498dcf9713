//! An adapter: checked before it is timed, and after.

use triptych_gpu::context::Gpu;
use triptych_gpu::error::GpuError;
use triptych_gpu::grid::{Device, Hit, Shape, Span, Stages, Timed};
use triptych_gpu::kernel::Kernels;
use triptych_gpu::timer::{Clock, Timer};
use triptych_spec::abuffer::NOTHING;
use triptych_spec::grid::trace::Query;
use triptych_spec::grid::{Blockers, Grid, Membership};

use crate::compare::grid::{Asked, any, closest};

/// Both, in the order in which they are timed.
const QUERIES: [Query; 2] = [Query::Any, Query::Closest];

/// What is measured: a grid and rays of one kind, with the spec's answers to each.
pub(super) struct Work<'a> {
    pub(super) blockers: &'a Blockers,
    pub(super) grid: &'a Grid,
    pub(super) asked: Asked<'a>,
}

/// Runs a checked build and trace, compares them with the spec, and sets up what is timed, with a
/// timer of `spans`.
///
/// # Errors
/// What the device refuses; lists and answers that are not the spec's, in words.
pub(super) fn set_up<'g>(
    gpu: &'g Gpu,
    [checked, kernels]: [&'g Kernels; 2],
    clock: &Clock,
    work: &Work<'_>,
    spans: &[Span],
) -> Result<(Timed<'g>, Timer), String> {
    let shape = shape(gpu, checked, work)?;
    let (axes, rays) = (&work.grid.axes, work.asked.rays);
    let timed = Timed::new(gpu, kernels, work.blockers, axes, rays, shape).map_err(words)?;
    let timer = |spans: &[Span]| {
        let count = u32::try_from(spans.len()).expect("few");
        Timer::new(gpu, clock, count).map_err(words)
    };
    timed.time(&Span::ALL, &timer(&Span::ALL)?).map_err(words)?;
    confirm(&timed, work)?;
    Ok((timed, timer(spans)?))
}

/// Compares what a timed run made with the spec: the lists, and both hits of each ray.
///
/// # Errors
/// Whatever the device reports; what is not the spec's, in words.
pub(super) fn confirm(timed: &Timed<'_>, work: &Work<'_>) -> Result<(), String> {
    same_lists(&timed.prims().map_err(words)?, work)?;
    for query in QUERIES {
        same_hits(work, query, &timed.hits(query).map_err(words)?)?;
    }
    Ok(())
}

fn words(error: GpuError) -> String {
    error.to_string()
}

fn same_lists(prims: &[u32], work: &Work<'_>) -> Result<(), String> {
    match prims == work.grid.prims {
        true => Ok(()),
        false => Err("lists unlike the spec's".to_owned()),
    }
}

fn same_hits(work: &Work<'_>, query: Query, hits: &[Hit]) -> Result<(), String> {
    if hits.iter().all(|hit| hit.prim == NOTHING) {
        let rays = hits.len();
        return Err(format!(
            "none of {rays} rays meets anything, so hits would not show"
        ));
    }
    let judgement = match query {
        Query::Any => any(work.asked, hits),
        Query::Closest => closest(work.asked, hits),
    };
    match judgement.differ() {
        0 => Ok(()),
        count => Err(format!(
            "{count} rays unlike the spec: {}",
            judgement.described.join("; ")
        )),
    }
}

fn shape(gpu: &Gpu, kernels: &Kernels, work: &Work<'_>) -> Result<Shape, String> {
    let grid = work.grid;
    let device = Device::new(gpu, kernels, work.blockers, &grid.axes, Membership::Box);
    let mut stages = Stages::new(device.map_err(words)?).map_err(words)?;
    stages.count().map_err(words)?;
    let offsets = stages.scan().map_err(words)?;
    let entries = offsets.last().copied().unwrap_or(0);
    let prims = stages.fill(entries, entries).map_err(words)?;
    let chunks = stages.chunks;
    if offsets != grid.offsets {
        return Err("offsets unlike the spec's".to_owned());
    }
    same_lists(&prims, work)?;
    let mut rounds = [0; 2];
    for (query, rounds) in QUERIES.into_iter().zip(&mut rounds) {
        let hits = stages.trace(work.asked.rays, query).map_err(words)?;
        *rounds = stages.dispatches;
        same_hits(work, query, &hits)?;
    }
    Ok(Shape {
        rounds,
        ..Shape::of(&offsets, chunks)
    })
}
