//! Stage resolve where pixels have several samples: passes in turn.

use std::time::Duration;

use triptych_spec::abuffer::Order;
use triptych_spec::raster::SAMPLES_MAX;

use super::attempt::Run;
use super::buffers::Buffers;
use crate::error::GpuError;
use crate::frame::Frame;
use crate::raster::{Path, per_pixel};

/// The file that ships the kernels.
const FILE: &str = "multisample";

impl Run<'_, '_> {
    /// The picture's samples, and their mean at each pixel's first. The compute paths take a
    /// pixel at a time, which sorts once and averages; the fragment path, and whatever goes by
    /// each sample's true depth, a sample at a time.
    pub(super) fn resolve_samples(&self, longest: u32, b: &Buffers) -> Result<Duration, GpuError> {
        let frame = self.frame();
        let by_pixel = self.rasterizer.path != Path::Fragment;
        // Kernels stop for breath after so many fewer nodes.
        let steps = longest.saturating_mul(u32::try_from(SAMPLES_MAX).unwrap_or(u32::MAX));
        if by_pixel && self.options.order == Order::Centroid {
            return self.until_done((FILE, "resolve_pixel"), frame, steps, b);
        }
        let mut time = Duration::ZERO;
        for sample in 0..frame.samples {
            let frame = Frame { sample, ..frame };
            if self.options.order == Order::Sample && self.options.lists {
                time += self.until_done((FILE, "key_samples"), frame, longest, b)?;
                time += self.until_done(("abuffer", "sort"), frame, longest, b)?;
            }
            time += self.until_done((FILE, "resolve_sample"), frame, steps, b)?;
        }
        let mean = per_pixel(self.rasterizer, FILE, "resolve_mean", frame, &b.named())?;
        Ok(time + mean)
    }
}
