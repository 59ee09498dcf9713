//! A band of a frame that is timed, and the passes over it.

use triptych_spec::abuffer::Order;
use triptych_spec::raster::SAMPLES_MAX;

use super::part::{FILE, Part, can_keep, file};
use crate::abuffer::attempt::dispatches;
use crate::abuffer::buffers::Buffers;
use crate::abuffer::{Options, STEPS};
use crate::error::GpuError;
use crate::frame::{Band, Frame};
use crate::raster::{Path, Rasterizer, Ready};

/// A band, with passes for each part of the frame; a part without any has no time here.
pub(in crate::abuffer) struct Strip {
    pub(in crate::abuffer) frame: Frame,
    pub(super) band: Band,
    pub(in crate::abuffer) parts: Vec<(Part, Vec<Ready>)>,
    built: usize,
}

impl Strip {
    /// What builds the lists of a band, with room for so many nodes.
    pub(in crate::abuffer) fn new(
        rasterizer: &Rasterizer<'_>,
        options: &Options<'_>,
        (band, capacity): (Band, u32),
        buffers: &Buffers,
        is_opaque: impl Fn(u32) -> bool,
    ) -> Result<Self, GpuError> {
        let [r, g, b] = options.background;
        let frame = Frame {
            capacity,
            depth_test: u32::from(options.depth_test),
            order: u32::from(options.order == Order::Sample),
            once: u32::from(options.once),
            background: [r, g, b, 1.0],
            ..rasterizer.frame(band)
        };
        let named = buffers.named();
        let clear = rasterizer.ready_per_pixel(FILE, "clear_lists", frame, &named)?;
        let mut parts = vec![(Part::Clear, vec![clear])];
        if options.opaque {
            let work = rasterizer.work(band, &is_opaque)?;
            let mut passes = Vec::new();
            for stage in ["opaque_nearest", "opaque_first"] {
                passes.extend(rasterizer.ready("abuffer", stage, frame, &work, &named)?);
            }
            parts.push((Part::Opaque, passes));
        }
        if options.lists {
            let work = rasterizer.work(band, |prim| !is_opaque(prim))?;
            let passes = rasterizer.ready_build(frame, &work, &named)?;
            parts.push((Part::Build, passes));
        }
        Ok(Self {
            frame,
            band,
            built: parts.len(),
            parts,
        })
    }

    /// Parts that build the lists.
    pub(super) fn built(&self) -> &[(Part, Vec<Ready>)] {
        &self.parts[..self.built]
    }

    /// Adds what follows lists of up to `longest` nodes.
    pub(in crate::abuffer) fn follow(
        &mut self,
        rasterizer: &Rasterizer<'_>,
        buffers: &Buffers,
        longest: u32,
        layers: &[u32],
    ) -> Result<(), GpuError> {
        let passes = Passes {
            rasterizer,
            buffers,
            frame: self.frame,
        };
        self.parts.truncate(self.built);
        let several = self.frame.samples > 1;
        let layers = layers.iter().copied().filter(|_| !several);
        for n in layers.clone().filter(|n| can_keep(*n, longest)) {
            let pass = passes.one(&file(n), "nearest_layers", self.frame)?;
            self.parts.push((Part::Nearest(n), vec![pass]));
        }
        let sort = passes.until_done(("abuffer", "sort"), self.frame, longest)?;
        self.parts.push((Part::Sort, sort));
        for n in layers.filter(|n| *n < longest && u64::from(*n) <= STEPS) {
            let pass = passes.one(&file(n), "nearest_layers_sorted", self.frame)?;
            self.parts.push((Part::NearestSorted(n), vec![pass]));
        }
        let resolve = match several {
            false => passes.until_done(("abuffer", "resolve"), self.frame, longest)?,
            true => passes.resolve_samples(longest)?,
        };
        self.parts.push((Part::Resolve, resolve));
        Ok(())
    }
}

/// Makes passes over a band's lists.
struct Passes<'p, 'g> {
    rasterizer: &'p Rasterizer<'g>,
    buffers: &'p Buffers,
    frame: Frame,
}

impl Passes<'_, '_> {
    fn one(&self, file: &str, stage: &str, frame: Frame) -> Result<Ready, GpuError> {
        let named = self.buffers.named();
        self.rasterizer.ready_per_pixel(file, stage, frame, &named)
    }

    /// As many dispatches of a stage as lists of that length may take; those that come
    /// after the last do nothing.
    fn until_done(
        &self,
        (file, stage): (&str, &str),
        frame: Frame,
        longest: u32,
    ) -> Result<Vec<Ready>, GpuError> {
        let mut passes = vec![self.one(FILE, "clear_progress", frame)?];
        for _ in 0..dispatches(longest) {
            passes.push(self.one(file, stage, frame)?);
        }
        Ok(passes)
    }

    /// Stage resolve where pixels have several samples, as a replay runs it.
    fn resolve_samples(&self, longest: u32) -> Result<Vec<Ready>, GpuError> {
        const KERNELS: &str = "multisample";
        let steps = longest.saturating_mul(u32::try_from(SAMPLES_MAX).unwrap_or(u32::MAX));
        let by_sample = self.frame.order == 1;
        if self.rasterizer.path != Path::Fragment && !by_sample {
            return self.until_done((KERNELS, "resolve_pixel"), self.frame, steps);
        }
        let mut passes = Vec::new();
        for sample in 0..self.frame.samples {
            let frame = Frame {
                sample,
                ..self.frame
            };
            if by_sample {
                passes.extend(self.until_done((KERNELS, "key_samples"), frame, longest)?);
                passes.extend(self.until_done(("abuffer", "sort"), frame, longest)?);
            }
            passes.extend(self.until_done((KERNELS, "resolve_sample"), frame, steps)?);
        }
        passes.push(self.one(KERNELS, "resolve_mean", self.frame)?);
        Ok(passes)
    }
}
