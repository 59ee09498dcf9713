//! Buffers of a grid that is built over and over, and the passes that use them.

use triptych_spec::grid::axis::Axis;
use triptych_spec::grid::trace::Query;
use triptych_spec::grid::{Blockers, Membership};

use super::device::Device;
use super::timed::Shape;
use super::{Cells, Counted, LONGEST};
use crate::context::Gpu;
use crate::error::GpuError;
use crate::kernel::Kernels;
use crate::lists::{TILE, long_passes};
use crate::ready::Ready;

/// Room for a grid that is built over and over.
pub(crate) struct Room<'g> {
    device: Device<'g>,
    buffers: Vec<(&'static str, wgpu::Buffer)>,
    /// Whether the last pass of a build leaves the lists in `merged`.
    swapped: bool,
}

/// What only a build needs.
const OF_BUILD: [&str; 3] = ["counts", "sums", "merged"];

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
        Self::of(device, shape)
    }

    /// The same of a device.
    ///
    /// # Errors
    /// Limits by name, and whatever the device reports.
    pub(crate) fn of(device: Device<'g>, shape: Shape) -> Result<Self, GpuError> {
        let gpu = device.gpu;
        let total = device.total();
        let room = |what, count: u32, size: u64| gpu.storage(what, size * u64::from(count));
        let buffers = vec![
            ("counts", room("counts of cells", total, 4)?),
            ("offsets", room("offsets of cells", total + 1, 4)?),
            ("sums", room("sums of tiles", total.div_ceil(TILE), 4)?),
            ("listed", room("entries of cells", shape.entries, 4)?),
            ("merged", room("entries of cells", shape.entries, 4)?),
            ("bricks", room("bricks", device.bricks(), 8)?),
        ];
        Ok(Self {
            device,
            buffers,
            swapped: long_passes(LONGEST, shape.longest).count() % 2 == 1,
        })
    }

    fn named(&self) -> Vec<(&str, &wgpu::Buffer)> {
        self.buffers.iter().map(|(name, b)| (*name, b)).collect()
    }

    /// The buffers after a build.
    pub(super) fn sorted(&self) -> Vec<(&str, &wgpu::Buffer)> {
        let mut named = self.named();
        if self.swapped {
            swap(&mut named);
        }
        named
    }

    /// Bytes of the grid and its triangles, with what only a build needs or without.
    pub(crate) fn bytes(&self, build: bool) -> u64 {
        let kept = |name: &&str| build || !OF_BUILD.contains(name);
        let own = self.buffers.iter().filter(|(name, _)| kept(name));
        self.device.bytes(build) + own.map(|(_, buffer)| buffer.size()).sum::<u64>()
    }

    /// Passes from corners to sorted lists and bricks.
    ///
    /// # Errors
    /// WGSL errors; what the device refuses.
    pub(crate) fn build(&self, shape: Shape) -> Result<Vec<Ready>, GpuError> {
        build(&self.device, &self.named(), shape)
    }

    /// Dispatches after which every ray is done.
    pub(crate) fn rounds(&self, shape: Shape) -> u64 {
        self.device.rounds(shape.entries.into())
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
        let mut named = self.sorted();
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

impl Room<'_> {
    /// As many dispatches of a search of a queue's rays, however many those are then.
    ///
    /// # Errors
    /// WGSL errors; what the device refuses.
    pub(crate) fn search_counted(
        &self,
        queue: Counted<'_>,
        query: Query,
        rounds: u32,
    ) -> Result<Vec<Ready>, GpuError> {
        let cells = Cells {
            any: (query == Query::Any).into(),
            ..self.device.cells
        };
        let named = self.sorted();
        let pass = |_| self.device.ready_counted(cells, queue, &named);
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
    for (kernel, run) in long_passes(LONGEST, shape.longest) {
        let cells = Cells {
            items: shape.entries,
            run,
            ..cells
        };
        passes.push(device.ready(kernel, cells, &swapped)?);
        swap(&mut swapped);
    }
    let bricks = Cells {
        items: device.bricks(),
        ..cells
    };
    passes.push(device.ready("trace_bricks", bricks, named)?);
    Ok(passes)
}

/// What was written is read by the next pass.
fn swap(named: &mut [(&str, &wgpu::Buffer)]) {
    for (name, _) in named {
        *name = match *name {
            "listed" => "merged",
            "merged" => "listed",
            other => other,
        };
    }
}
