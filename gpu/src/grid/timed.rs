//! A grid that is set up once and built and traced many times, each timed.
//!
//! Kernels run unchecked, as an engine has them, so only ours may, and only on what a checked
//! run has been through: that run also tells how many dispatches each stage needs.

use triptych_spec::grid::axis::Axis;
use triptych_spec::grid::ray::Ray;
use triptych_spec::grid::trace::Query;
use triptych_spec::grid::{Blockers, Membership};

use super::device::Device;
use super::stages::{fresh, long_passes};
use super::{Cells, Hit, Packed, TILE};
use crate::context::Gpu;
use crate::dispatch::Ready;
use crate::error::GpuError;
use crate::kernel::Kernels;
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

/// Buffers and passes, ready to run.
pub struct Timed<'g> {
    gpu: &'g Gpu,
    spans: [Vec<Ready>; 3],
    hits: wgpu::Buffer,
    start: wgpu::Buffer,
    rays: u32,
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
        let hits = gpu.storage("hits", size_of::<Hit>() as u64 * u64::from(count))?;
        let trace = |query, rounds| room.search([&rays, &hits], count, query, rounds);
        let spans = [
            room.build(shape)?,
            trace(Query::Any, shape.rounds[0])?,
            trace(Query::Closest, shape.rounds[1])?,
        ];
        Ok(Self {
            gpu,
            spans,
            hits,
            start,
            rays: count,
        })
    }

    /// Runs each span once, in this order, and gives the seconds of each. Rays start afresh;
    /// that is not timed.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn time(&self, timer: &Timer) -> Result<[f64; 3], GpuError> {
        let seconds = timer.time(self.gpu, 0..3, |span, encoder, queries| {
            let passes = &self.spans[span as usize];
            if span > 0 {
                encoder.copy_buffer_to_buffer(&self.start, 0, &self.hits, 0, None);
            }
            for (at, pass) in passes.iter().enumerate() {
                let writes = queries.and_then(|q| q.writes(span, at, passes.len()));
                pass.record(encoder, writes);
            }
        })?;
        Ok([seconds[0], seconds[1], seconds[2]])
    }

    /// What the rays of the last span met.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn hits(&self) -> Result<Vec<Hit>, GpuError> {
        self.gpu.read(&self.hits, self.rays as usize)
    }
}

/// Room for a grid that is built over and over.
pub(crate) struct Room<'g> {
    device: Device<'g>,
    buffers: Vec<(&'static str, wgpu::Buffer)>,
}

impl<'g> Room<'g> {
    /// Uploads triangles and boundaries, and makes room for what a checked run needed.
    ///
    /// # Errors
    /// Limits by name, and whatever the device reports.
    pub(crate) fn new(
        gpu: &'g Gpu,
        kernels: &'g Kernels,
        blockers: &Blockers,
        axes: &[Axis; 3],
        shape: Shape,
    ) -> Result<Self, GpuError> {
        let device = Device::new(gpu, kernels, blockers, axes, Membership::Box)?;
        let total = device.total();
        let room = |what, count: u32, size: u64| gpu.storage(what, size * u64::from(count));
        let buffers = vec![
            ("counts", room("counts of cells", total, 4)?),
            ("offsets", room("offsets of cells", total + 1, 4)?),
            ("sums", room("sums of tiles", total.div_ceil(TILE), 4)?),
            ("prims", room("entries of cells", shape.entries, 4)?),
            ("merged", room("entries of cells", shape.entries, 4)?),
            ("bricks", room("bricks", device.bricks(), 8)?),
        ];
        Ok(Self { device, buffers })
    }

    fn named(&self) -> Vec<(&str, &wgpu::Buffer)> {
        self.buffers.iter().map(|(name, b)| (*name, b)).collect()
    }

    /// Passes from corners to sorted lists and bricks.
    ///
    /// # Errors
    /// WGSL errors; what the device refuses.
    pub(crate) fn build(&self, shape: Shape) -> Result<Vec<Ready>, GpuError> {
        build(&self.device, &self.named(), shape)
    }

    /// As many dispatches of a search of these rays, with what they have met.
    ///
    /// # Errors
    /// WGSL errors; what the device refuses.
    pub(crate) fn search(
        &self,
        [rays, hits]: [&wgpu::Buffer; 2],
        items: u32,
        query: Query,
        rounds: u32,
    ) -> Result<Vec<Ready>, GpuError> {
        let mut named = self.named();
        named.extend([("rays", rays), ("hits", hits)]);
        let cells = Cells {
            items,
            any: (query == Query::Any).into(),
            ..self.device.cells
        };
        let pass = |_| self.device.ready("trace", cells, &named);
        (0..rounds).map(pass).collect()
    }
}

/// Passes of a build. Counts are zero before it and after it.
fn build(
    device: &Device<'_>,
    named: &[(&str, &wgpu::Buffer)],
    shape: Shape,
) -> Result<Vec<Ready>, GpuError> {
    let (total, cells) = (device.total(), device.cells);
    let of_cells = Cells {
        items: total,
        ..cells
    };
    let tiles = total.div_ceil(TILE);
    let mut passes = Vec::new();
    let sweep = |[small, large]: [&str; 2], passes: &mut Vec<Ready>| -> Result<(), GpuError> {
        let cells = |items| Cells {
            items,
            capacity: shape.entries,
            ..cells
        };
        let pass = device.ready(small, cells(device.triangles), named)?;
        if shape.chunks == 0 {
            passes.push(pass);
            return Ok(());
        }
        passes.push(device.counting(pass));
        passes.push(device.ready_groups(large, cells(shape.chunks), shape.chunks, named)?);
        Ok(())
    };
    sweep(["count", "count_chunks"], &mut passes)?;
    passes.push(device.ready_groups("scan_tiles", of_cells, tiles, named)?);
    passes.push(device.ready_groups("scan_sums", of_cells, 1, named)?);
    passes.push(device.ready_groups("scan", of_cells, tiles, named)?);
    sweep(["fill", "fill_chunks"], &mut passes)?;
    passes.push(device.ready("fill_sort", of_cells, named)?);
    let mut swapped: Vec<(&str, &wgpu::Buffer)> = named.to_vec();
    for (kernel, run) in long_passes(shape.longest) {
        let cells = Cells {
            items: shape.entries,
            run,
            ..cells
        };
        passes.push(device.ready(kernel, cells, &swapped)?);
        for (name, _) in &mut swapped {
            *name = match *name {
                "prims" => "merged",
                "merged" => "prims",
                other => other,
            };
        }
    }
    let bricks = Cells {
        items: device.bricks(),
        ..cells
    };
    passes.push(device.ready("trace_bricks", bricks, named)?);
    Ok(passes)
}
