//! Buffers of a grid, and dispatches over them.

use std::mem::offset_of;
use std::time::Duration;

use triptych_spec::grid::axis::Axis;
use triptych_spec::grid::{Blockers, ENTRIES_MAX, Membership};

use super::{CHUNK, Cells, Counted, SMALL, STEPS, exact};
use crate::context::Gpu;
use crate::error::GpuError;
use crate::frame::WORKGROUP;
use crate::kernel::Kernels;
use crate::ready::Ready;

/// What all stages share.
pub struct Device<'g> {
    pub(super) gpu: &'g Gpu,
    kernels: &'g Kernels,
    /// The file of the kernel that searches.
    search: &'static str,
    /// What kernels are told, but for what a dispatch adds.
    pub(super) cells: Cells,
    /// Triangles.
    pub(super) triangles: u32,
    boundaries: wgpu::Buffer,
    corners: wgpu::Buffer,
    unfinished: wgpu::Buffer,
    chunks: wgpu::Buffer,
}

impl<'g> Device<'g> {
    /// Uploads triangles and boundaries.
    ///
    /// # Errors
    /// Limits by name, and whatever the device reports.
    pub fn new(
        gpu: &'g Gpu,
        kernels: &'g Kernels,
        blockers: &Blockers,
        axes: &[Axis; 3],
        membership: Membership,
    ) -> Result<Self, GpuError> {
        let boundaries = axes.iter().flat_map(|axis| axis.boundaries());
        let boundaries: Vec<f32> = boundaries.map(|b| *b as f32).collect();
        let rows = 0..blockers.triangles.len();
        let triangles = u32::try_from(rows.len()).map_err(|_| GpuError::Limit {
            adapter: gpu.name.clone(),
            what: "triangles",
            needed: rows.len() as u64,
            limit: u32::MAX.into(),
        })?;
        let corners = (0..triangles).flat_map(|prim| blockers.corners(prim));
        let corners = corners.map(exact).map(|[x, y, z]| [x, y, z, 0.0]);
        let corners: Vec<[f32; 4]> = corners.collect();
        let [x, y, z] = axes.each_ref().map(Axis::cells);
        let chunks = chunks_at_most(triangles, x * y * z);
        Ok(Self {
            cells: Cells {
                x,
                y,
                z,
                overlap: (membership == Membership::Overlap).into(),
                chunks,
                ..Cells::default()
            },
            triangles,
            boundaries: gpu.upload("cell boundaries", &boundaries)?,
            corners: gpu.upload("corners of triangles", &corners)?,
            unfinished: gpu.storage("unfinished", 4)?,
            chunks: gpu.storage("chunks of large boxes", 8 * u64::from(chunks.max(1)))?,
            gpu,
            kernels,
            search: "grid",
        })
    }

    /// The same, but of two triangles whose times `f32` cannot tell apart, rays meet the one that is
    /// first, and of two that are met at one time the smaller: the spec's answer.
    #[must_use]
    pub fn exactly(self) -> Self {
        Self {
            search: "grid_exact",
            ..self
        }
    }

    /// Number of cells.
    pub fn total(&self) -> u32 {
        self.cells.x * self.cells.y * self.cells.z
    }

    /// Number of bricks.
    pub fn bricks(&self) -> u32 {
        let sides = [self.cells.x, self.cells.y, self.cells.z];
        sides.into_iter().map(|cells| cells.div_ceil(4)).product()
    }

    /// Bytes of triangles and boundaries, and of what else a build needs.
    pub(super) fn bytes(&self, build: bool) -> u64 {
        let of_build = if build { self.chunks.size() } else { 0 };
        self.corners.size() + self.boundaries.size() + of_build
    }

    /// Dispatches after which every ray is done: it passes a cell once, and with it each entry;
    /// where a dispatch ends, a cell may be looked at again. llvmpipe counts the iterations of a
    /// whole subgroup, whose rays wait for each other, and leaves all loops after 65,535. So a
    /// dispatch takes one of them `STEPS` on, or all together as many: it is as if they came one
    /// after another.
    pub(super) fn rounds(&self, entries: u64) -> u64 {
        let cells = u64::from(self.cells.x + self.cells.y + self.cells.z);
        let lanes = u64::from(self.gpu.info.subgroup_max_size.max(1));
        lanes * ((cells + entries).div_ceil(u64::from(STEPS - 1)) + 1)
    }

    /// One invocation for each item.
    pub(super) fn each(
        &self,
        entry: &str,
        cells: Cells,
        buffers: &[(&str, &wgpu::Buffer)],
    ) -> Result<Duration, GpuError> {
        self.dispatch(entry, cells, cells.items.div_ceil(WORKGROUP), buffers)
    }

    /// So many workgroups; waits for the end.
    pub(super) fn dispatch(
        &self,
        entry: &str,
        cells: Cells,
        groups: u32,
        buffers: &[(&str, &wgpu::Buffer)],
    ) -> Result<Duration, GpuError> {
        self.ready_groups(entry, cells, groups, buffers)?
            .run(self.gpu)
    }

    /// One invocation for each item, to be recorded.
    pub(super) fn ready(
        &self,
        entry: &str,
        cells: Cells,
        buffers: &[(&str, &wgpu::Buffer)],
    ) -> Result<Ready, GpuError> {
        self.ready_groups(entry, cells, cells.items.div_ceil(WORKGROUP), buffers)
    }

    /// So many workgroups, to be recorded.
    pub(super) fn ready_groups(
        &self,
        entry: &str,
        cells: Cells,
        groups: u32,
        buffers: &[(&str, &wgpu::Buffer)],
    ) -> Result<Ready, GpuError> {
        let uniform = self.gpu.uniform("cells", &cells)?;
        self.pass(entry, (cells, &uniform), groups, buffers)
    }

    /// One invocation for each ray of a queue, however many those are then, to be recorded.
    pub(super) fn ready_counted(
        &self,
        cells: Cells,
        queue: Counted<'_>,
        buffers: &[(&str, &wgpu::Buffer)],
    ) -> Result<Ready, GpuError> {
        let uniform = self.gpu.uniform("cells", &cells)?;
        let named = [buffers, &[("rays", queue.rays), ("hits", queue.hits)]].concat();
        let pass = self.pass("trace", (cells, &uniform), 0, &named)?;
        let items = offset_of!(Cells, items) as u64;
        Ok(pass
            .after_word((queue.arguments, 12), (&uniform, items))
            .counted(queue.arguments))
    }

    fn pass(
        &self,
        entry: &str,
        (cells, uniform): (Cells, &wgpu::Buffer),
        groups: u32,
        buffers: &[(&str, &wgpu::Buffer)],
    ) -> Result<Ready, GpuError> {
        let mut all = vec![
            ("cells", uniform),
            ("boundaries", &self.boundaries),
            ("corners", &self.corners),
            ("unfinished", &self.unfinished),
            ("chunks", &self.chunks),
        ];
        all.extend_from_slice(buffers);
        // Where any triangle will do, there is nothing to be told apart.
        let file = match (entry, cells.any) {
            ("trace", 0) => self.search,
            _ => "grid",
        };
        Ready::new(self.gpu, self.kernels, (file, entry), groups, &all)
    }

    /// A pass that counts what it leaves to be done from zero on.
    pub(super) fn counting(&self, pass: Ready) -> Ready {
        pass.after_clearing(self.unfinished.clone())
    }

    /// What kernels left to be done, which is nothing afterwards.
    pub(super) fn take_unfinished(&self) -> Result<u32, GpuError> {
        self.gpu.take(&self.unfinished)
    }

    /// Runs a kernel that goes through the cells of small boxes, and then the one that goes
    /// through the chunks of large ones; how many those were.
    ///
    /// # Errors
    /// More chunks than boxes that touch [`ENTRIES_MAX`] cells may have, and whatever the device
    /// reports.
    pub(super) fn sweep(
        &self,
        [small, large]: [&str; 2],
        capacity: u32,
        buffers: &[(&str, &wgpu::Buffer)],
    ) -> Result<(Duration, u32), GpuError> {
        let cells = |items| Cells {
            items,
            capacity,
            ..self.cells
        };
        let mut time = self.each(small, cells(self.triangles), buffers)?;
        let chunks = self.take_unfinished()?;
        if chunks > self.cells.chunks {
            return Err(GpuError::Limit {
                adapter: self.gpu.name.clone(),
                what: "chunks of large boxes",
                needed: chunks.into(),
                limit: self.cells.chunks.into(),
            });
        }
        if chunks > 0 {
            time += self.dispatch(large, cells(chunks), chunks, buffers)?;
        }
        Ok((time, chunks))
    }
}

/// How many chunks the large boxes of so many triangles in so many cells may have: each begins
/// at most one that is not full, and all boxes together touch at most [`ENTRIES_MAX`] cells.
fn chunks_at_most(triangles: u32, cells: u32) -> u32 {
    let large = ENTRIES_MAX / u64::from(SMALL + 1);
    let most = u64::from(triangles).min(large) + ENTRIES_MAX / u64::from(CHUNK);
    let of_each = u64::from(triangles) * u64::from(cells.div_ceil(CHUNK));
    u32::try_from(most.min(of_each)).expect("below 2^21")
}
