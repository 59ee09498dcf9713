//! What the host does for each stage.

use std::time::Duration;

use triptych_spec::abuffer::EOL;
use triptych_spec::grid::ray::Ray;
use triptych_spec::grid::trace::Query;

use super::device::Device;
use super::{Cells, Counted, Entry, FRESH, Hit, LONGEST, Linked, Packed, TRACED};
use crate::error::GpuError;
use crate::lists::{LONG, TILE, long_passes};

/// Rays of one dispatch: 32 bytes each, within 128 MiB.
const RAYS: usize = 1 << 22;

/// A grid in the making. Stages are called in order; each takes what was given in its place, or
/// what the one before made.
pub struct Stages<'g> {
    device: Device<'g>,
    counts: wgpu::Buffer,
    offsets: wgpu::Buffer,
    prims: wgpu::Buffer,
    bricks: wgpu::Buffer,
    /// Time on the device of what ran last, without transfers.
    pub time: Duration,
    /// Chunks of large boxes, of the last stage that went through boxes.
    pub chunks: u32,
    /// Dispatches of the last search, until its rays were done.
    pub dispatches: u32,
}

impl<'g> Stages<'g> {
    /// Room for counts and offsets.
    ///
    /// # Errors
    /// Limits by name, and whatever the device reports.
    pub fn new(device: Device<'g>) -> Result<Self, GpuError> {
        let (gpu, total) = (device.gpu, u64::from(device.total()));
        let bricks = u64::from(device.bricks());
        Ok(Self {
            counts: gpu.storage("counts of cells", 4 * total)?,
            offsets: gpu.storage("offsets of cells", 4 * (total + 1))?,
            prims: gpu.storage("entries of cells", 4)?,
            bricks: gpu.storage("bricks", 8 * bricks)?,
            device,
            time: Duration::ZERO,
            chunks: 0,
            dispatches: 0,
        })
    }

    /// Stage `count`.
    ///
    /// # Errors
    /// Whatever the device reports; so for all stages.
    pub fn count(&mut self) -> Result<Vec<u32>, GpuError> {
        let buffers = [("counts", &self.counts)];
        let kernels = ["count", "count_chunks"];
        (self.time, self.chunks) = self.device.sweep(kernels, 0, &buffers)?;
        self.device
            .gpu
            .read(&self.counts, self.device.total() as usize)
    }

    /// Puts counts in place of the device's own.
    pub fn give_counts(&mut self, counts: &[u32]) -> Result<(), GpuError> {
        self.counts = self.device.gpu.upload("counts of cells", counts)?;
        Ok(())
    }

    /// Stage `scan`.
    pub fn scan(&mut self) -> Result<Vec<u32>, GpuError> {
        let total = self.device.total();
        let tiles = total.div_ceil(TILE);
        let sums = self
            .device
            .gpu
            .storage("sums of tiles", 4 * u64::from(tiles))?;
        let buffers = [
            ("counts", &self.counts),
            ("offsets", &self.offsets),
            ("sums", &sums),
        ];
        let cells = Cells {
            items: total,
            ..self.device.cells
        };
        self.time = self.device.dispatch("scan_tiles", cells, tiles, &buffers)?;
        self.time += self.device.dispatch("scan_sums", cells, 1, &buffers)?;
        self.time += self.device.dispatch("scan", cells, tiles, &buffers)?;
        self.device.gpu.read(&self.offsets, total as usize + 1)
    }

    /// Puts offsets in place of the device's own.
    pub fn give_offsets(&mut self, offsets: &[u32]) -> Result<(), GpuError> {
        self.offsets = self.device.gpu.upload("offsets of cells", offsets)?;
        Ok(())
    }

    /// Stage `fill`: `entries` of them, of which `capacity` have room. Counts are used up. Lists
    /// are put in order if all have.
    pub fn fill(&mut self, entries: u32, capacity: u32) -> Result<Vec<u32>, GpuError> {
        let gpu = self.device.gpu;
        self.prims = gpu.storage("entries of cells", 4 * u64::from(capacity))?;
        let buffers = [
            ("counts", &self.counts),
            ("offsets", &self.offsets),
            ("listed", &self.prims),
        ];
        let kernels = ["fill", "fill_chunks"];
        (self.time, self.chunks) = self.device.sweep(kernels, capacity, &buffers)?;
        if entries <= capacity {
            self.sort(entries)?;
        }
        gpu.read(&self.prims, capacity as usize)
    }

    /// Each list in order of id.
    fn sort(&mut self, entries: u32) -> Result<(), GpuError> {
        let runs = |items, run| Cells {
            items,
            run,
            ..self.device.cells
        };
        let buffers = [("offsets", &self.offsets), ("listed", &self.prims)];
        let total = self.device.total();
        self.time += self.device.each("fill_sort", runs(total, 0), &buffers)?;
        // No list is longer than all are together, whatever damaged offsets say.
        let longest = self.device.take_unfinished()?.min(entries);
        if longest <= LONG {
            return Ok(());
        }
        let size = 4 * u64::from(entries);
        let mut merged = self.device.gpu.storage("entries of cells", size)?;
        for (kernel, run) in long_passes(LONGEST, longest) {
            let buffers = [
                ("offsets", &self.offsets),
                ("listed", &self.prims),
                ("merged", &merged),
            ];
            self.time += self.device.each(kernel, runs(entries, run), &buffers)?;
            std::mem::swap(&mut self.prims, &mut merged);
        }
        Ok(())
    }

    /// Puts entries in place of the device's own.
    pub fn give_prims(&mut self, prims: &[u32]) -> Result<(), GpuError> {
        self.prims = self.device.gpu.upload("entries of cells", prims)?;
        Ok(())
    }

    /// Stage `link`: the paper's lists.
    pub fn link(&mut self, capacity: u32) -> Result<Linked, GpuError> {
        let (gpu, total) = (self.device.gpu, self.device.total());
        let heads = gpu.filled("heads", total, EOL)?;
        let entries = gpu.storage("entries of lists", 8 * u64::from(capacity))?;
        let counter = gpu.storage("counter", 4)?;
        let buffers = [
            ("heads", &heads),
            ("entries", &entries),
            ("counter", &counter),
        ];
        let kernels = ["link", "link_chunks"];
        (self.time, self.chunks) = self.device.sweep(kernels, capacity, &buffers)?;
        let attempts: Vec<u32> = gpu.read(&counter, 1)?;
        Ok(Linked {
            heads: gpu.read(&heads, total as usize)?,
            entries: gpu.read::<Entry>(&entries, capacity as usize)?,
            attempts: attempts[0],
        })
    }

    /// Stage `trace`: what each ray meets.
    pub fn trace(&mut self, rays: &[Ray], query: Query) -> Result<Vec<Hit>, GpuError> {
        self.time = self.mark_bricks()?;
        let mut hits = Vec::with_capacity(rays.len());
        for rays in rays.chunks(RAYS) {
            hits.extend(self.trace_part(rays, query)?);
        }
        Ok(hits)
    }

    /// Works out which bricks list anything.
    pub(crate) fn mark_bricks(&self) -> Result<Duration, GpuError> {
        let bricks = Cells {
            items: self.device.bricks(),
            ..self.device.cells
        };
        let buffers = [("offsets", &self.offsets), ("bricks", &self.bricks)];
        self.device.each("trace_bricks", bricks, &buffers)
    }

    fn trace_part(&mut self, rays: &[Ray], query: Query) -> Result<Vec<Hit>, GpuError> {
        let gpu = self.device.gpu;
        let packed: Vec<Packed> = rays.iter().map(Packed::from).collect();
        let items = u32::try_from(rays.len()).expect("at most RAYS");
        let rays = gpu.upload("rays", &packed)?;
        let hits = gpu.upload("hits", &vec![fresh(); packed.len()])?;
        let time = self.search(&rays, &hits, items, query)?;
        self.time += time;
        let hits: Vec<Hit> = gpu.read(&hits, packed.len())?;
        match hits.iter().all(|hit| hit.state == TRACED) {
            true => Ok(hits),
            false => Err(self.endless()),
        }
    }

    /// Traces the first `items` of some rays on the device, whose hits start afresh, until all
    /// are done.
    pub(crate) fn search(
        &mut self,
        rays: &wgpu::Buffer,
        hits: &wgpu::Buffer,
        items: u32,
        query: Query,
    ) -> Result<Duration, GpuError> {
        let buffers = [
            ("offsets", &self.offsets),
            ("listed", &self.prims),
            ("bricks", &self.bricks),
            ("rays", rays),
            ("hits", hits),
        ];
        let cells = Cells {
            items,
            any: (query == Query::Any).into(),
            ..self.device.cells
        };
        let search = || self.device.each("trace", cells, &buffers);
        let (time, dispatches) = self.until_done(search)?;
        self.dispatches = dispatches;
        Ok(time)
    }

    /// The same for the rays of a queue, however many those are.
    pub(crate) fn search_counted(
        &mut self,
        queue: Counted<'_>,
        query: Query,
    ) -> Result<Duration, GpuError> {
        let buffers = [
            ("offsets", &self.offsets),
            ("listed", &self.prims),
            ("bricks", &self.bricks),
        ];
        let cells = Cells {
            any: (query == Query::Any).into(),
            ..self.device.cells
        };
        let search = || {
            let pass = self.device.ready_counted(cells, queue, &buffers)?;
            pass.run(self.device.gpu)
        };
        let (time, dispatches) = self.until_done(search)?;
        self.dispatches = dispatches;
        Ok(time)
    }

    /// Dispatches until no ray is unfinished: how long that took, and how often.
    fn until_done(
        &self,
        search: impl Fn() -> Result<Duration, GpuError>,
    ) -> Result<(Duration, u32), GpuError> {
        let mut time = Duration::ZERO;
        let rounds = 0..self.device.rounds(self.prims.size() / 4);
        for (round, _) in (1..).zip(rounds) {
            time += search()?;
            if self.device.take_unfinished()? == 0 {
                return Ok((time, round));
            }
        }
        Err(self.endless())
    }

    fn endless(&self) -> GpuError {
        GpuError::Endless {
            adapter: self.device.gpu.name.clone(),
            stage: "trace",
        }
    }
}

/// A ray that has not started.
pub(crate) fn fresh() -> Hit {
    Hit {
        prim: 0,
        time: 0.0,
        state: FRESH,
        at: 0,
    }
}
