//! Buffers of a frame, and dispatches over them.

use std::time::Duration;

use triptych_spec::rsm::{self as spec, Model, Setting};
use triptych_spec::scene::Size;

use super::faces::{Buffers, Faces};
use super::records::{Light, Place, Surface};
use super::{Parameters, View};
use crate::context::Gpu;
use crate::error::GpuError;
use crate::grid;
use crate::kernel::Kernels;

/// Texels that an invocation looks at within a dispatch.
const STEPS: u32 = grid::STEPS;

/// What all stages share.
pub(super) struct Device<'g> {
    pub(super) gpu: &'g Gpu,
    pub(super) faces: Faces<'g>,
    model: Model,
    pub(super) given: spec::Parameters,
    /// What kernels are told, but for what a dispatch adds.
    pub(super) told: Parameters,
    pub(super) eye: wgpu::Buffer,
    pub(super) lamp: wgpu::Buffer,
    pub(super) weights: wgpu::Buffer,
}

impl<'g> Device<'g> {
    /// Uploads model and views.
    pub(super) fn new(
        gpu: &'g Gpu,
        kernels: &'g Kernels,
        setting: &Setting<'_>,
    ) -> Result<Self, GpuError> {
        let model = setting.model;
        let map = setting.lamp.view.size;
        let weights =
            (0..map.pixels()).map(|texel| setting.lamp.weight(texel, setting.parameters.stride));
        #[expect(clippy::cast_possible_truncation, reason = "rounding is meant")]
        let weights: Vec<f32> = weights.map(|weight| weight as f32).collect();
        Ok(Self {
            eye: gpu.uniform("the eye", &View::from(setting.eye))?,
            lamp: gpu.uniform("the lamp", &View::from(&setting.lamp.view))?,
            weights: gpu.upload("weights of texels", &weights)?,
            faces: Faces::new(gpu, kernels, model)?,
            told: Parameters::from(setting),
            given: setting.parameters,
            model: model.clone(),
            gpu,
        })
    }

    pub(super) fn eye_size(&self) -> Size {
        Size {
            width: self.told.width,
            height: self.told.height,
        }
    }

    pub(super) fn map_size(&self) -> Size {
        Size {
            width: self.told.map_width,
            height: self.told.map_height,
        }
    }

    pub(super) fn coarse_size(&self) -> Size {
        Size {
            width: self.told.coarse_width,
            height: self.told.coarse_height,
        }
    }

    /// One invocation for each item; waits for the end.
    pub(super) fn run(
        &self,
        entry: &str,
        told: Parameters,
        view: &wgpu::Buffer,
        buffers: &Buffers<'_>,
    ) -> Result<Duration, GpuError> {
        self.faces.ready(entry, told, view, buffers)?.run(self.gpu)
    }

    /// One invocation for each pixel of a picture.
    pub(super) fn each(
        &self,
        entry: &str,
        size: Size,
        view: &wgpu::Buffer,
        buffers: &Buffers<'_>,
    ) -> Result<Duration, GpuError> {
        self.run(entry, self.of(size), view, buffers)
    }

    /// One invocation for each pixel of a picture, and some rows of its kernel at a time.
    pub(super) fn rows(
        &self,
        entry: &str,
        size: Size,
        view: &wgpu::Buffer,
        buffers: &Buffers<'_>,
    ) -> Result<Duration, GpuError> {
        let mut time = Duration::ZERO;
        for told in self.by_rows(size) {
            time += self.run(entry, told, view, buffers)?;
        }
        Ok(time)
    }

    /// A dispatch of one invocation for each pixel.
    pub(super) fn of(&self, size: Size) -> Parameters {
        Parameters {
            items: size.width * size.height,
            ..self.told
        }
    }

    /// Dispatches of one invocation for each pixel, and some rows of its kernel at a time.
    pub(super) fn by_rows(&self, size: Size) -> impl Iterator<Item = Parameters> {
        let side = self.given.side();
        let rows = (STEPS / side).max(1);
        let all = self.of(size);
        (0..side)
            .step_by(rows as usize)
            .map(move |first| Parameters {
                first,
                rows: rows.min(side - first),
                ..all
            })
    }

    pub(super) fn upload_seen(
        &self,
        seen: &[Option<spec::Surface>],
    ) -> Result<wgpu::Buffer, GpuError> {
        let packed = seen.iter().map(|s| Surface::packed(s.as_ref()));
        self.gpu.upload("surfaces", &packed.collect::<Vec<_>>())
    }

    pub(super) fn upload_places(
        &self,
        places: &[Option<spec::Place>],
    ) -> Result<wgpu::Buffer, GpuError> {
        let packed = places.iter().map(|p| Place::packed(p.as_ref()));
        self.gpu.upload("places", &packed.collect::<Vec<_>>())
    }

    pub(super) fn upload_lights(
        &self,
        lights: &[Option<spec::Light>],
    ) -> Result<[wgpu::Buffer; 2], GpuError> {
        let packed = lights
            .iter()
            .map(|l| Light::packed(&self.model, l.as_ref()));
        let intensity = |l: &Option<spec::Light>| padded(l.map_or([0.0; 3], |l| l.intensity));
        let intensities: Vec<_> = lights.iter().map(intensity).collect();
        Ok([
            self.gpu.upload("lights", &packed.collect::<Vec<_>>())?,
            self.gpu.upload("intensities", &intensities)?,
        ])
    }

    pub(super) fn upload_colours(&self, colours: &[[f32; 3]]) -> Result<wgpu::Buffer, GpuError> {
        let padded: Vec<_> = colours.iter().copied().map(padded).collect();
        self.gpu.upload("colours", &padded)
    }

    pub(super) fn colours(
        &self,
        buffer: &wgpu::Buffer,
        size: Size,
    ) -> Result<Vec<[f32; 3]>, GpuError> {
        let colours: Vec<[f32; 4]> = self.gpu.read(buffer, size.pixels())?;
        Ok(colours.into_iter().map(|[r, g, b, _]| [r, g, b]).collect())
    }

    /// Room for something of each pixel.
    pub(super) fn room<T>(&self, what: &'static str, size: Size) -> Result<wgpu::Buffer, GpuError> {
        let bytes = size_of::<T>() as u64 * size.pixels() as u64;
        self.gpu.storage(what, bytes)
    }
}

fn padded([r, g, b]: [f32; 3]) -> [f32; 4] {
    [r, g, b, 0.0]
}
