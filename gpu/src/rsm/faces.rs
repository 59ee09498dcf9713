//! A model's triangles on the device, and what a view sees of them.

use std::time::Duration;

use triptych_spec::rsm::{self as spec, Model};
use triptych_spec::scene::Size;

use super::records::{Surface, faces};
use super::{Parameters, Surfaces, View};
use crate::context::Gpu;
use crate::error::GpuError;
use crate::frame::WORKGROUP;
use crate::kernel::Kernels;
use crate::ready::Ready;

pub(super) type Buffers<'b> = [(&'b str, &'b wgpu::Buffer)];

/// Corners, normals and colours of a model.
pub(super) struct Faces<'g> {
    gpu: &'g Gpu,
    kernels: &'g Kernels,
    corners: wgpu::Buffer,
    faces: wgpu::Buffer,
    triangles: usize,
}

impl<'g> Faces<'g> {
    pub(super) fn new(gpu: &'g Gpu, kernels: &'g Kernels, model: &Model) -> Result<Self, GpuError> {
        let triangles = 0..u32::try_from(model.triangles.len()).unwrap_or(u32::MAX);
        let corners = triangles.flat_map(|triangle| model.corners(triangle));
        let corners = corners.map(|[x, y, z]| [x as f32, y as f32, z as f32, 0.0]);
        Ok(Self {
            corners: gpu.upload("corners of triangles", &corners.collect::<Vec<_>>())?,
            faces: gpu.upload("faces of triangles", &faces(model))?,
            triangles: model.triangles.len(),
            gpu,
            kernels,
        })
    }

    /// One invocation for each item, to be recorded.
    pub(super) fn ready(
        &self,
        entry: &str,
        told: Parameters,
        view: &wgpu::Buffer,
        buffers: &Buffers<'_>,
    ) -> Result<Ready, GpuError> {
        let uniform = self.gpu.uniform("parameters", &told)?;
        let mut all = vec![
            ("parameters", &uniform),
            ("view", view),
            ("corners", &self.corners),
            ("faces", &self.faces),
        ];
        all.extend_from_slice(buffers);
        let groups = told.items.div_ceil(WORKGROUP);
        Ready::new(self.gpu, self.kernels, ("rsm", entry), groups, &all)
    }

    /// Every triangle of the model as its own source: what is seen is given by its row.
    pub(super) fn sources(&self) -> Result<wgpu::Buffer, GpuError> {
        let rows: Vec<u32> = (0..).take(self.triangles).collect();
        self.gpu.upload("sources", &rows)
    }

    /// Stage `gbuffer`, and how long it took.
    pub(super) fn seen(
        &self,
        told: Parameters,
        eye: &wgpu::Buffer,
        triangles: &[u32],
    ) -> Result<(Surfaces, Duration), GpuError> {
        let bytes = size_of::<Surface>() as u64 * u64::from(told.items);
        let seen = self.gpu.storage("surfaces", bytes)?;
        let buffers = [
            ("nearest", &self.gpu.upload("triangles", triangles)?),
            ("sources", &self.sources()?),
            ("seen", &seen),
        ];
        let time = self.ready("gbuffer", told, eye, &buffers)?.run(self.gpu)?;
        let seen: Vec<Surface> = self.gpu.read(&seen, told.items as usize)?;
        Ok((seen.into_iter().map(Surface::unpacked).collect(), time))
    }
}

/// Stage `gbuffer` without the rest of a frame: what each pixel of a view sees of a triangle of
/// the model, or of [`triptych_spec::abuffer::NOTHING`], with points moved `offset` steps off
/// their faces.
///
/// # Errors
/// Limits by name, and whatever the device reports.
pub fn gbuffer(
    gpu: &Gpu,
    kernels: &Kernels,
    (model, eye, offset): (&Model, &spec::View, u32),
    triangles: &[u32],
) -> Result<Surfaces, GpuError> {
    let Size { width, height } = eye.size;
    let told = Parameters {
        width,
        height,
        offset,
        items: width * height,
        ..Parameters::default()
    };
    let eye = gpu.uniform("the eye", &View::from(eye))?;
    let (seen, _) = Faces::new(gpu, kernels, model)?.seen(told, &eye, triangles)?;
    Ok(seen)
}
