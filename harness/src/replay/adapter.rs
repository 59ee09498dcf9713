//! Adapters, opened and calibrated.

mod samples;

use std::collections::BTreeMap;

use triptych_gpu::context::{Gpu, adapters, short_name};
use triptych_gpu::error::GpuError;
use triptych_gpu::kernel::{Foreign, Kernels};
use triptych_gpu::raster::Path;
use triptych_gpu::wgsl::Sources;

use super::broken::{Broken, each};
use crate::calibrate::{Grid, calibrate};
use samples::Calibrated;
pub use samples::Drawn;

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
    /// The samples that calibration found.
    calibrated: Calibrated,
    /// The user's kernels, which run in place of ours.
    pub foreign: Vec<Foreign>,
}

/// The adapters that a run is about.
#[derive(Default)]
pub struct Adapters {
    /// Opened and calibrated, in order of name.
    pub open: Vec<Adapter>,
    /// Those that are there and of no use, in order of name.
    pub broken: Vec<Broken>,
}

impl Adapters {
    /// Finds, opens and calibrates the adapters whose name contains one of `wanted`
    /// (all, if that is empty). One that fails does not keep the others from a run.
    ///
    /// Adapters of the GL back end are taken only if asked for: naga's GLSL has no
    /// sample masks.
    pub fn open(wanted: &[String]) -> Self {
        let asked = !wanted.is_empty();
        let (open, broken) = each(find(wanted), asked, |name, adapter| {
            Adapter::open(adapter, name)
        });
        Self { open, broken }
    }
}

/// The adapters whose name contains one of `wanted`, each under a name of its own.
fn find(wanted: &[String]) -> Vec<(String, wgpu::Adapter)> {
    let wanted: Vec<String> = wanted.iter().map(|w| w.to_lowercase()).collect();
    let backends = if wanted.iter().any(|w| w.ends_with("gl")) {
        wgpu::Backends::all()
    } else {
        wgpu::Backends::all() - wgpu::Backends::GL
    };
    let mut found: Vec<_> = adapters(backends)
        .into_iter()
        .map(|a| (short_name(&a.get_info()), a))
        .collect();
    found.sort_by(|a, b| a.0.cmp(&b.0));
    // A software driver may be listed twice; two boards of one kind are two.
    found.dedup_by(|a, b| {
        let (a, b) = (a.1.get_info(), b.1.get_info());
        a.device_type == wgpu::DeviceType::Cpu && a == b
    });
    let asked = |name: &str| wanted.iter().any(|w| name.to_lowercase().contains(w));
    let mut found = numbered(found);
    found.retain(|(name, _)| wanted.is_empty() || asked(name));
    found
}

/// Tells what is called the same apart: `x`, `x#2`, `x#3`. The names depend neither on
/// which of them are wanted nor on which of them open.
fn numbered<F>(found: Vec<(String, F)>) -> Vec<(String, F)> {
    let mut seen = BTreeMap::<String, u32>::new();
    let number = |(name, found): (String, F)| {
        let alike = seen.entry(name.clone()).or_default();
        *alike += 1;
        match *alike {
            1 => (name, found),
            n => (format!("{name}#{n}"), found),
        }
    };
    found.into_iter().map(number).collect()
}

/// Kernels for an adapter with 64-bit integers, and with atomics of them if it has those.
fn native(gpu: &Gpu) -> Sources {
    let mut sources = Sources::shipped(true);
    if gpu.has_int64_atomics() {
        sources = sources.with_wide_atomics();
    }
    match gpu.has_all_int64_atomics() {
        true => sources.with_all_wide_atomics(),
        false => sources,
    }
}

impl Adapter {
    /// Opens and calibrates one adapter under this name.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn open(adapter: &wgpu::Adapter, name: &str) -> Result<Self, GpuError> {
        let gpu = Gpu::open_as(adapter, name)?;
        let kernels = Kernels::new(Sources::shipped(false));
        let native = gpu.has_int64().then(|| Kernels::new(native(&gpu)));
        let grid = calibrate(&gpu, &kernels)?;
        Ok(Self {
            gpu,
            kernels,
            native,
            grid,
            calibrated: Calibrated::default(),
            foreign: Vec::new(),
        })
    }

    /// The kernels of a path.
    pub fn kernels(&self, path: Path) -> &Kernels {
        let native = self.native.as_ref().filter(|_| path == Path::Native);
        native.unwrap_or(&self.kernels)
    }

    /// What a leg on a path is called in rows.
    pub fn label(&self, path: Path) -> String {
        format!("gpu@{}/{}", self.gpu.name, path.name())
    }

    /// Runs the kernels that ship, whatever it ran before.
    pub fn use_shipped(&mut self) {
        self.kernels = Kernels::new(Sources::shipped(false));
        let native = || Kernels::new(native(&self.gpu));
        self.native = self.gpu.has_int64().then(native);
        self.calibrated = Calibrated::default();
        self.foreign.clear();
    }

    /// Runs a user's kernels from now on, in place of ours of the same stages.
    /// Calibration was done with ours.
    pub fn use_foreign(&mut self, foreign: &[Foreign]) {
        if foreign.is_empty() {
            return;
        }
        self.kernels = Kernels::with_foreign(Sources::shipped(false), foreign);
        // A user's kernel knows the baseline's bindings.
        let wide = || match foreign
            .iter()
            .any(|f| ["peel", "ordered"].contains(&f.stage.name))
        {
            true => Kernels::with_foreign(Sources::shipped(true), foreign),
            false => Kernels::with_foreign(native(&self.gpu), foreign),
        };
        self.native = self.native.is_some().then(wide);
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn adapters_of_one_name_are_told_apart() {
        let found = ["x", "y", "x", "x"].map(|name| (name.to_owned(), ()));
        let names: Vec<String> = numbered(found.into()).into_iter().map(|f| f.0).collect();
        assert_eq!(names, ["x", "y", "x#2", "x#3"]);
    }
}
