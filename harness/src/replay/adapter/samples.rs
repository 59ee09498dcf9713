//! The samples with which an adapter draws.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

use triptych_gpu::error::GpuError;
use triptych_gpu::raster::Path;
use triptych_spec::raster::Samples;

use super::Adapter;
use crate::calibrate::{Grid, calibrate_samples};

/// What calibration found, for each number of samples, once it was asked for.
#[derive(Default)]
pub struct Calibrated(Mutex<BTreeMap<u32, Option<Samples>>>);

/// What an adapter draws with on a path where a scene has so many samples.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Drawn {
    /// Samples in these places.
    With(Samples),
    /// It does not draw such scenes, and why.
    Not(String),
}

impl Adapter {
    /// The samples on a path for a scene with these: compute kernels take any; the hardware
    /// has its own, wherever calibration finds them.
    ///
    /// # Errors
    /// Whatever the device reports while it is calibrated.
    pub fn samples(&self, path: Path, scene: Samples) -> Result<Drawn, GpuError> {
        let count = scene.count();
        if path != Path::Fragment || count == 1 {
            return Ok(Drawn::With(scene));
        }
        if let Some(reason) = self.cannot_draw(count) {
            return Ok(Drawn::Not(reason));
        }
        let known = self.calibrated.0.lock();
        let mut known = known.unwrap_or_else(PoisonError::into_inner);
        let found = match known.get(&count) {
            Some(found) => *found,
            None => {
                let bits = self.grid.bits();
                let found = calibrate_samples(&self.gpu, &self.kernels, bits, count)?;
                known.insert(count, found);
                found
            }
        };
        Ok(match found {
            Some(samples) => Drawn::With(samples),
            None => Drawn::Not(format!(
                "the driver's coverage is that of no {count} samples on its sub-pixel grid"
            )),
        })
    }

    /// How many samples a pixel the hardware draws with, and where they lie.
    pub fn samples_in_words(&self) -> String {
        let several = Samples::COUNTS.iter().filter(|count| **count > 1);
        let words = several
            .filter_map(|count| Samples::standard(*count))
            .map(|standard| {
                let count = standard.count();
                match self.samples(Path::Fragment, standard) {
                    Ok(Drawn::With(found)) if found == standard => {
                        format!("{count} in standard places")
                    }
                    Ok(Drawn::With(found)) => format!("{count} at {:?}", found.positions()),
                    Ok(Drawn::Not(reason)) => format!("not {count}: {reason}"),
                    Err(error) => format!("not {count}: {error}"),
                }
            });
        format!("samples: {}", words.collect::<Vec<_>>().join("; "))
    }

    /// Why the hardware's rasteriser is not asked for so many samples.
    fn cannot_draw(&self, count: u32) -> Option<String> {
        if self.gpu.info.backend == wgpu::Backend::Gl {
            return Some("naga's GLSL has no sample mask as an input".to_owned());
        }
        if self.grid == Grid::Unknown {
            return Some("the driver's sub-pixel grid is unknown".to_owned());
        }
        let has = self.gpu.has_samples(count);
        (!has).then(|| format!("the adapter has no targets of {count} samples"))
    }
}
