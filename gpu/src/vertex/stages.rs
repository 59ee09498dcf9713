//! What the host does for each stage.

use std::ops::Range;
use std::time::{Duration, Instant};

use bytemuck::{Pod, Zeroable};
use triptych_spec::scene::{Scene, Triangle};
use triptych_spec::vertex::{CORNERS_MAX, Polygons, Position, viewport};

use super::{CLIPPED, CORNERS, Times};
use crate::context::Gpu;
use crate::error::GpuError;
use crate::frame::{Band, Frame, WORKGROUP};
use crate::kernel::{Kernels, Pipeline};

/// Vertices of one dispatch (WebGPU: 65,535 workgroups).
pub(super) const VERTICES: u32 = 65_535 * WORKGROUP;

/// Bytes of a triangle's slots.
pub(super) const SLOTS: u64 = 16 * CORNERS_MAX as u64;

/// A vertex as the kernel reads it.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Vertex {
    position: [f32; 3],
    instance: u32,
}

/// What the stages share.
pub(super) struct Stages<'g> {
    gpu: &'g Gpu,
    kernels: &'g Kernels,
    pub(super) frame: Frame,
    /// Most triangles of a batch.
    pub(super) batch: usize,
    positions: wgpu::Buffer,
    counts: wgpu::Buffer,
    polygons: wgpu::Buffer,
    /// Triangles of the current batch.
    items: u32,
    pub(super) times: Times,
}

impl<'g> Stages<'g> {
    /// Room for the vertices, and for the polygons of a batch.
    pub(super) fn new(
        gpu: &'g Gpu,
        kernels: &'g Kernels,
        scene: &Scene,
        bits: u32,
        batch: usize,
    ) -> Result<Self, GpuError> {
        let room = scene.triangles.len().min(batch) as u64;
        Ok(Self {
            gpu,
            kernels,
            frame: Frame::new(scene.size, bits, Band::whole(scene.size)),
            batch,
            positions: gpu.storage("positions", 16 * scene.vertices.len() as u64)?,
            counts: gpu.storage("counts", 4 * room)?,
            polygons: gpu.storage("polygons", SLOTS * room)?,
            items: 0,
            times: Times::default(),
        })
    }

    /// Stage transform, over all vertices.
    pub(super) fn transform(&mut self, scene: &Scene) -> Result<Vec<[f32; 4]>, GpuError> {
        let [matrices, vertices] = inputs(self.gpu, scene)?;
        let buffers = [
            ("matrices", &matrices),
            ("vertices", &vertices),
            ("positions", &self.positions),
        ];
        let count = self.row("vertices", scene.vertices.len())?;
        let mut time = Duration::ZERO;
        for first in (0..count).step_by(VERTICES as usize) {
            let end = first.saturating_add(VERTICES).min(count);
            time += self.dispatch("transform", first..end, &buffers)?;
        }
        self.times.transform = time;
        self.gpu.read(&self.positions, scene.vertices.len())
    }

    /// Takes given positions in place of its own.
    pub(super) fn place(&mut self, given: &[Position<f32>]) -> Result<(), GpuError> {
        self.positions = self.gpu.upload("positions", given)?;
        Ok(())
    }

    /// Clips a batch; gives the number of corners of each triangle.
    pub(super) fn clip(&mut self, triangles: &[Triangle]) -> Result<Vec<u32>, GpuError> {
        let corners: Vec<[u32; 3]> = triangles.iter().map(|t| t.vertices).collect();
        let corners = self.gpu.upload("triangles", &corners)?;
        self.items = self.row("triangles", triangles.len())?;
        let buffers = [
            ("positions", &self.positions),
            ("triangles", &corners),
            ("counts", &self.counts),
            ("polygons", &self.polygons),
        ];
        self.times.clip += self.dispatch("clip", 0..self.items, &buffers)?;
        let counts: Vec<u32> = self.gpu.read(&self.counts, triangles.len())?;
        let most = counts.iter().copied().max().unwrap_or(0);
        if most as usize > CORNERS_MAX {
            return Err(self.limit(CLIPPED, u64::from(most), CORNERS_MAX as u64));
        }
        Ok(counts)
    }

    /// Puts given polygons in the place of a clipped batch; gives their numbers of corners.
    pub(super) fn fill(
        &mut self,
        given: &Polygons<f32>,
        first: usize,
        triangles: usize,
    ) -> Result<Vec<u32>, GpuError> {
        let offsets = &given.offsets[first..=first + triangles];
        let mut slots = vec![[0.0_f32; 4]; CORNERS_MAX * triangles];
        let mut counts = Vec::with_capacity(triangles);
        for (range, slots) in offsets.windows(2).zip(slots.chunks_mut(CORNERS_MAX)) {
            let corners = &given.corners[range[0] as usize..range[1] as usize];
            slots[..corners.len()].copy_from_slice(corners);
            counts.push(range[1] - range[0]);
        }
        self.items = self.row("triangles", triangles)?;
        self.counts = self.gpu.upload("counts", &counts)?;
        self.polygons = self.gpu.upload("polygons", &slots)?;
        Ok(counts)
    }

    /// Appends the polygons of the batch that was clipped last.
    pub(super) fn read_polygons(
        &self,
        counts: &[u32],
        to: &mut Polygons<f32>,
    ) -> Result<(), GpuError> {
        let slots: Vec<Position<f32>> =
            self.gpu.read(&self.polygons, CORNERS_MAX * counts.len())?;
        for (slots, &count) in slots.chunks(CORNERS_MAX).zip(counts) {
            to.corners.extend_from_slice(&slots[..count as usize]);
            to.offsets.push(self.row(CORNERS, to.corners.len())?);
        }
        Ok(())
    }

    /// Snaps the batch that was clipped last; gives its corners, compacted.
    pub(super) fn snap(&mut self, offsets: &[u32]) -> Result<Vec<[i32; 3]>, GpuError> {
        let total = offsets.last().map_or(0, |&end| end as usize);
        let offsets = self.gpu.upload("offsets", offsets)?;
        let snapped = self.gpu.storage("snapped", 12 * total as u64)?;
        let buffers = [
            ("counts", &self.counts),
            ("polygons", &self.polygons),
            ("offsets", &offsets),
            ("snapped", &snapped),
        ];
        self.times.snap += self.dispatch("snap", 0..self.items, &buffers)?;
        self.gpu.read(&snapped, total)
    }

    /// One invocation for each item; waits for the end.
    fn dispatch(
        &self,
        stage: &str,
        items: Range<u32>,
        buffers: &[(&str, &wgpu::Buffer)],
    ) -> Result<Duration, GpuError> {
        let gpu = self.gpu;
        let kernel = self.kernels.compute(gpu, "vertex", stage)?;
        let frame = Frame {
            work_first: items.start,
            items: items.end - items.start,
            ..self.frame
        };
        let uniform = gpu.uniform("frame", &frame)?;
        let mut all = vec![("frame", &uniform)];
        all.extend_from_slice(buffers);
        let group = kernel.bind(gpu, &all);
        let mut encoder = gpu.encoder();
        if let Pipeline::Compute(pipeline) = &kernel.pipeline {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, &group, &[]);
            pass.dispatch_workgroups(frame.items.div_ceil(WORKGROUP), 1, 1);
        }
        let start = Instant::now();
        gpu.submit(encoder)?;
        Ok(start.elapsed())
    }

    fn row(&self, what: &'static str, count: usize) -> Result<u32, GpuError> {
        let limit = u64::from(u32::MAX);
        u32::try_from(count).map_err(|_| self.limit(what, count as u64, limit))
    }

    pub(super) fn limit(&self, what: &'static str, needed: u64, limit: u64) -> GpuError {
        GpuError::Limit {
            adapter: self.gpu.name.clone(),
            what,
            needed,
            limit,
        }
    }
}

/// Matrices and vertices on the device. The only place where the matrices are rounded: composed in
/// f64, then to f32.
pub(super) fn inputs(gpu: &Gpu, scene: &Scene) -> Result<[wgpu::Buffer; 2], GpuError> {
    let to_pixels = viewport(scene.size);
    #[expect(
        clippy::cast_possible_truncation,
        reason = "the one rounding of an entry that the bound allows for"
    )]
    let rows = |m| to_pixels.times(m).rows.map(|row| row.map(|v| v as f32));
    let matrices: Vec<[[f32; 4]; 4]> = scene.instances.iter().map(rows).collect();
    let vertex = |v: &triptych_spec::scene::Vertex| Vertex {
        position: v.position,
        instance: v.instance,
    };
    let vertices: Vec<Vertex> = scene.vertices.iter().map(vertex).collect();
    Ok([
        gpu.upload("matrices", &matrices)?,
        gpu.upload("vertices", &vertices)?,
    ])
}
