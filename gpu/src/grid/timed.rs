//! A grid that is set up once and built and traced many times, each timed.
//!
//! Kernels run unchecked, as an engine has them, so only ours may, and only on what a checked
//! run has been through: that run also tells how many dispatches each stage needs.

use triptych_spec::grid::axis::Axis;
use triptych_spec::grid::ray::Ray;
use triptych_spec::grid::trace::Query;
use triptych_spec::grid::{Blockers, Membership};

use super::room::Room;
use super::stages::{Stages, fresh};
use super::{Device, Hit, Packed};
use crate::context::Gpu;
use crate::error::GpuError;
use crate::kernel::Kernels;
use crate::ready::Ready;
use crate::timer::Timer;

/// What is timed, in the order of all results here.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Span {
    /// Stages count, scan and fill, and the bricks.
    Build,
    /// Rays until anything is met.
    Any,
    /// Rays until the nearest is met.
    Closest,
}

impl Span {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Build, Self::Any, Self::Closest];
}

/// How often a checked run dispatched what it ran.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shape {
    /// Entries of all lists.
    pub entries: u32,
    /// Entries of the longest list.
    pub longest: u32,
    /// Chunks of large boxes.
    pub chunks: u32,
    /// Most steps of a ray: dispatches of the searches, any and closest.
    pub rounds: [u32; 2],
}

impl Shape {
    /// Of a build that is run and checked for it, before any ray; `None` where nothing is to be found.
    ///
    /// # Errors
    /// Limits by name, and whatever the device reports.
    pub fn checked(
        gpu: &Gpu,
        kernels: &Kernels,
        blockers: &Blockers,
        axes: &[Axis; 3],
    ) -> Result<Option<Self>, GpuError> {
        if blockers.triangles.is_empty() {
            return Ok(None);
        }
        let device = Device::new(gpu, kernels, blockers, axes, Membership::Box)?;
        let mut stages = Stages::new(device)?;
        stages.count()?;
        let offsets = stages.scan()?;
        let entries = offsets.last().copied().unwrap_or(0);
        stages.fill(entries, entries)?;
        Ok(Some(Self::of(&offsets, stages.chunks)))
    }

    /// Of a checked build, before any ray.
    pub fn of(offsets: &[u32], chunks: u32) -> Self {
        let lengths = offsets.windows(2).map(|run| run[1] - run[0]);
        Self {
            entries: offsets.last().copied().unwrap_or(0),
            longest: lengths.max().unwrap_or(0),
            chunks,
            rounds: [0; 2],
        }
    }
}

/// Buffers and passes, ready to run.
pub struct Timed<'g> {
    gpu: &'g Gpu,
    spans: [Vec<Ready>; 3],
    room: Room<'g>,
    /// Of any hits, and of closest ones.
    hits: [wgpu::Buffer; 2],
    start: wgpu::Buffer,
    rays: u32,
    entries: u32,
}

impl<'g> Timed<'g> {
    /// Sets everything up.
    ///
    /// # Errors
    /// Limits by name, and whatever the device reports.
    pub fn new(
        gpu: &'g Gpu,
        kernels: &'g Kernels,
        blockers: &Blockers,
        axes: &[Axis; 3],
        rays: &[Ray],
        shape: Shape,
    ) -> Result<Self, GpuError> {
        let room = Room::new(gpu, kernels, blockers, axes, shape)?;
        let packed: Vec<Packed> = rays.iter().map(Packed::from).collect();
        let count = u32::try_from(rays.len()).expect("fewer rays than 2^32");
        let start = gpu.upload("hits", &vec![fresh(); rays.len()])?;
        let rays = gpu.upload("rays", &packed)?;
        let hits = || gpu.storage("hits", size_of::<Hit>() as u64 * u64::from(count));
        let hits = [hits()?, hits()?];
        let trace =
            |at: usize, query| room.search([&rays, &hits[at]], count, query, shape.rounds[at]);
        let spans = [
            room.build(shape)?,
            trace(0, Query::Any)?,
            trace(1, Query::Closest)?,
        ];
        Ok(Self {
            gpu,
            spans,
            room,
            hits,
            start,
            rays: count,
            entries: shape.entries,
        })
    }

    /// Runs these spans once, in this order, and gives the seconds of each; `timer` has as many.
    /// Before any other, a grid is built. Rays start afresh; that is not timed.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn time(&self, spans: &[Span], timer: &Timer) -> Result<Vec<f64>, GpuError> {
        let count = u32::try_from(spans.len()).expect("few");
        timer.time(self.gpu, 0..count, |at, encoder, queries| {
            let span = spans[at as usize] as usize;
            let passes = &self.spans[span];
            if let Some(query) = span.checked_sub(1) {
                encoder.copy_buffer_to_buffer(&self.start, 0, &self.hits[query], 0, None);
            }
            for (number, pass) in passes.iter().enumerate() {
                let writes = queries.and_then(|q| q.writes(at, number, passes.len()));
                pass.record(encoder, writes);
            }
        })
    }

    /// What the rays met in the last run of a query's span.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn hits(&self, query: Query) -> Result<Vec<Hit>, GpuError> {
        let at = usize::from(query == Query::Closest);
        self.gpu.read(&self.hits[at], self.rays as usize)
    }

    /// The lists that rays were searched in, as the last build left them.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn prims(&self) -> Result<Vec<u32>, GpuError> {
        let named = self.room.sorted();
        let prims = named.iter().find(|(name, _)| *name == "listed");
        let (_, prims) = prims.expect("made with the room");
        self.gpu.read(prims, self.entries as usize)
    }

    /// Bytes of what a span reads or writes, without rays and hits: all that a build does; and
    /// of what rays are searched in, which is less.
    pub fn bytes(&self, span: Span) -> u64 {
        self.room.bytes(span == Span::Build)
    }
}
