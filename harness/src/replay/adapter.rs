//! Adapters, opened and calibrated.

use triptych_gpu::context::{Gpu, adapters, short_name};
use triptych_gpu::error::GpuError;
use triptych_gpu::kernel::{Foreign, Kernels};
use triptych_gpu::raster::Path;
use triptych_gpu::wgsl::Sources;

use crate::calibrate::{Grid, calibrate};

/// A device, its kernels, and its driver's sub-pixel grid.
pub struct Adapter {
    /// The device.
    pub gpu: Gpu,
    /// Kernels in baseline WGSL.
    pub kernels: Kernels,
    /// Kernels that use 64-bit integers, where the adapter has them.
    pub native: Option<Kernels>,
    /// What calibration found.
    pub grid: Grid,
    /// The user's kernels, which run in place of ours.
    pub foreign: Vec<Foreign>,
}

impl Adapter {
    /// Opens and calibrates the adapters whose name contains one of `wanted` (all,
    /// if that is empty), in order of name. Adapters of the GL back end are taken
    /// only if asked for: naga's GLSL has no sample masks.
    ///
    /// # Errors
    /// The first adapter that cannot be opened.
    pub fn open_all(wanted: &[String]) -> Result<Vec<Self>, GpuError> {
        let asked = |name: &str| {
            wanted
                .iter()
                .any(|w| name.to_lowercase().contains(&w.to_lowercase()))
        };
        let backends = if wanted.iter().any(|w| w.to_lowercase().ends_with("gl")) {
            wgpu::Backends::all()
        } else {
            wgpu::Backends::all() - wgpu::Backends::GL
        };
        let mut found: Vec<_> = adapters(backends)
            .into_iter()
            .map(|a| (short_name(&a.get_info()), a))
            .filter(|(name, _)| wanted.is_empty() || asked(name))
            .collect();
        found.sort_by(|a, b| a.0.cmp(&b.0));
        // A software driver may be listed twice; two boards of one kind are two.
        found.dedup_by(|a, b| {
            let (a, b) = (a.1.get_info(), b.1.get_info());
            a.device_type == wgpu::DeviceType::Cpu && a == b
        });
        let mut adapters: Vec<Self> = Vec::with_capacity(found.len());
        for (name, adapter) in &found {
            let mut adapter = Self::open(adapter)?;
            let alike = found
                .iter()
                .take(adapters.len())
                .filter(|(n, _)| n == name)
                .count();
            if alike > 0 {
                adapter.gpu.name = format!("{name}#{}", alike + 1);
            }
            adapters.push(adapter);
        }
        Ok(adapters)
    }

    /// Opens and calibrates one adapter.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn open(adapter: &wgpu::Adapter) -> Result<Self, GpuError> {
        let gpu = Gpu::open(adapter)?;
        let kernels = Kernels::new(Sources::shipped(false));
        let native = gpu
            .has_int64()
            .then(|| Kernels::new(Sources::shipped(true)));
        let grid = calibrate(&gpu, &kernels)?;
        Ok(Self {
            gpu,
            kernels,
            native,
            grid,
            foreign: Vec::new(),
        })
    }

    /// Runs a user's kernels from now on, in place of ours of the same stages.
    /// Calibration was done with ours.
    pub fn use_foreign(&mut self, foreign: &[Foreign]) {
        if foreign.is_empty() {
            return;
        }
        let kernels = |native| Kernels::with_foreign(Sources::shipped(native), foreign);
        self.kernels = kernels(false);
        self.native = self.native.take().map(|_| kernels(true));
        self.foreign = foreign.to_vec();
    }

    /// The grid on which a path works: compute kernels take any.
    pub fn bits(&self, path: Path) -> u32 {
        match path {
            Path::Compute | Path::Native => triptych_spec::vertex::SUBPIXEL_BITS,
            Path::Fragment => self.grid.bits(),
        }
    }
}
