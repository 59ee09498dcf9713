//! Vertex stages on the device: transform, clip, snap, in batches of triangles.

use std::ops::Range;
use std::time::{Duration, Instant};

use bytemuck::{Pod, Zeroable};
use triptych_spec::scene::{Scene, Triangle};
use triptych_spec::vertex::{CORNERS_MAX, Primitives, viewport};

use crate::context::Gpu;
use crate::error::GpuError;
use crate::frame::{Band, Frame, WORKGROUP};
use crate::kernel::{Kernels, Pipeline};

/// Vertices of one dispatch (WebGPU: 65,535 workgroups).
const VERTICES: u32 = 65_535 * WORKGROUP;

/// Triangles of one batch: their slots take 72 MiB, within the 128 MiB that
/// WebGPU lets every kernel bind.
const TRIANGLES: usize = 1 << 19;

/// What a device exceeds that clips a triangle to more corners than six planes can.
pub const CLIPPED: &str = "corners of a clipped triangle";

/// Bytes of a triangle's slots.
const SLOTS: u64 = 16 * CORNERS_MAX as u64;

/// What the device made of a scene's vertices.
#[derive(Clone, Debug, PartialEq)]
pub struct VertexRun {
    /// After `transform`: homogeneous pixels, one for each of [`Scene::vertices`].
    pub positions: Vec<[f32; 4]>,
    /// After `snap`.
    pub primitives: Primitives,
    /// Time of each stage.
    pub times: Times,
}

/// Time of each stage on the device, without transfers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Times {
    /// Stage transform.
    pub transform: Duration,
    /// Stage clip.
    pub clip: Duration,
    /// Stage snap.
    pub snap: Duration,
}

/// A vertex as the kernel reads it.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Vertex {
    position: [f32; 3],
    instance: u32,
}

/// Runs the vertex stages of a scene.
///
/// # Errors
/// Limits by name, WGSL errors, and whatever the device reports.
pub fn run(gpu: &Gpu, kernels: &Kernels, scene: &Scene, bits: u32) -> Result<VertexRun, GpuError> {
    run_in_batches(gpu, kernels, scene, bits, TRIANGLES)
}

fn run_in_batches(
    gpu: &Gpu,
    kernels: &Kernels,
    scene: &Scene,
    bits: u32,
    batch: usize,
) -> Result<VertexRun, GpuError> {
    let mut stages = Stages::new(gpu, kernels, scene, bits, batch)?;
    let positions = stages.transform(scene)?;
    let mut primitives = Primitives {
        size: scene.size,
        bits,
        snapped: Vec::new(),
        prims: Vec::new(),
        source: Vec::new(),
    };
    for (number, triangles) in scene.triangles.chunks(batch).enumerate() {
        let counts = stages.clip(triangles)?;
        let base = primitives.snapped.len();
        let first = number * batch;
        let offsets = append_fans(&mut primitives, first, base, &counts).ok_or_else(|| {
            stages.limit("corners of all triangles", u64::MAX, u64::from(u32::MAX))
        })?;
        primitives.snapped.extend(stages.snap(&offsets)?);
    }
    Ok(VertexRun {
        positions,
        primitives,
        times: stages.times,
    })
}

/// Appends the fans of a batch whose first triangle and first corner are given, and
/// tells where in the batch's corners each triangle's begin, and where all end.
/// `None` if a corner's row exceeds 32 bits.
fn append_fans(
    primitives: &mut Primitives,
    first: usize,
    base: usize,
    counts: &[u32],
) -> Option<Vec<u32>> {
    let base = u32::try_from(base).ok()?;
    let mut offsets = vec![0_u32];
    let mut at = 0_u32;
    for (source, &count) in (u32::try_from(first).ok()?..).zip(counts) {
        let start = base.checked_add(at)?;
        let end = start.checked_add(count)?;
        for corner in start.saturating_add(2)..end {
            primitives.prims.push([start, corner - 1, corner]);
            primitives.source.push(source);
        }
        at += count;
        offsets.push(at);
    }
    Some(offsets)
}

/// What the stages share.
struct Stages<'g> {
    gpu: &'g Gpu,
    kernels: &'g Kernels,
    frame: Frame,
    positions: wgpu::Buffer,
    counts: wgpu::Buffer,
    polygons: wgpu::Buffer,
    /// Triangles of the current batch.
    items: u32,
    times: Times,
}

impl<'g> Stages<'g> {
    fn new(
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
            positions: gpu.storage("positions", 16 * scene.vertices.len() as u64)?,
            counts: gpu.storage("counts", 4 * room)?,
            polygons: gpu.storage("polygons", SLOTS * room)?,
            items: 0,
            times: Times::default(),
        })
    }

    /// The only place where the matrices are rounded: composed in f64, then to f32.
    fn transform(&mut self, scene: &Scene) -> Result<Vec<[f32; 4]>, GpuError> {
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
        let matrices = self.gpu.upload("matrices", &matrices)?;
        let vertices = self.gpu.upload("vertices", &vertices)?;
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

    /// Clips a batch; gives the number of corners of each triangle.
    fn clip(&mut self, triangles: &[Triangle]) -> Result<Vec<u32>, GpuError> {
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

    /// Snaps the batch that was clipped last; gives its corners, compacted.
    fn snap(&mut self, offsets: &[u32]) -> Result<Vec<[i32; 3]>, GpuError> {
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

    fn limit(&self, what: &'static str, needed: u64, limit: u64) -> GpuError {
        GpuError::Limit {
            adapter: self.gpu.name.clone(),
            what,
            needed,
            limit,
        }
    }
}

#[cfg(test)]
mod tests;
