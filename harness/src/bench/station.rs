//! An adapter, and what it draws a scene with.

use triptych_gpu::kernel::Kernels;
use triptych_gpu::raster::{Path, Rasterizer};
use triptych_gpu::timer::Clock;
use triptych_spec::raster::Samples;

use super::gpu::Refusal;
use super::reference::Grid;
use crate::calibrate;
use crate::replay::gpu::{Adapter, Drawn};

/// An adapter with the kernels that are timed.
pub(super) struct Station<'a> {
    pub(super) adapter: &'a Adapter,
    pub(super) kernels: Kernels,
    pub(super) native: Option<Kernels>,
    pub(super) clock: Clock,
}

impl Station<'_> {
    /// Whether the host computes for it.
    pub(super) fn is_software(&self) -> bool {
        self.adapter.gpu.info.device_type == wgpu::DeviceType::Cpu
    }

    /// The samples that it draws a scene with on a path.
    pub(super) fn samples(&self, path: Path, scene: Samples) -> Result<Samples, Refusal> {
        let several = scene.count() > 1;
        if let Some(foreign) = self.adapter.foreign.first().filter(|_| several) {
            let file = &foreign.file;
            let words = format!("{file} is measured with one sample a pixel");
            return Err(Refusal::Skipped(words));
        }
        match self.adapter.samples(path, scene)? {
            Drawn::With(samples) => Ok(samples),
            Drawn::Not(reason) => Err(Refusal::Skipped(reason)),
        }
    }

    pub(super) fn rasterizer(&self, path: Path, grid: &Grid) -> Result<Rasterizer<'_>, Refusal> {
        let kernels = match path {
            Path::Native => self.native.as_ref(),
            Path::Compute | Path::Fragment => Some(&self.kernels),
        };
        let reason = "no 64-bit integers: compute takes its place";
        let kernels = kernels.ok_or_else(|| Refusal::Skipped(reason.to_owned()))?;
        if path == Path::Fragment && self.adapter.grid == calibrate::Grid::Unknown {
            let reason = "the driver's sub-pixel grid is unknown".to_owned();
            return Err(Refusal::Skipped(reason));
        }
        for foreign in &self.adapter.foreign {
            if !foreign.serves(path == Path::Fragment) {
                let reason = format!("{} has no kernel for it", foreign.file);
                return Err(Refusal::Skipped(reason));
            }
        }
        let gpu = &self.adapter.gpu;
        let (prims, faces) = (&grid.primitives, &grid.faces);
        Ok(Rasterizer::new(gpu, kernels, path, prims, faces)?)
    }
}
