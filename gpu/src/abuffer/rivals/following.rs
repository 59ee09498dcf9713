//! Programmable blending over sorted lists, set up.

use std::time::Instant;

use triptych_spec::abuffer::{Lens, Lists};

use super::{
    Buffer, Given, Rival, Surfaces, by_name, frame, image, read_lists, run_through, whole,
};
use crate::abuffer::STEPS;
use crate::error::GpuError;
use crate::frame::Band;
use crate::raster::{Rasterizer, Ready};
use crate::timer::Timer;

/// What is made of the layers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shading {
    /// Stage `density`: a medium between them, of so much over the depth range.
    Density(f32),
    /// Stage `defocus`: each out of focus.
    Defocus(Lens),
}

/// A shading that is set up over a whole target.
pub struct Following<'r, 'g> {
    rasterizer: &'r Rasterizer<'g>,
    buffers: Vec<Buffer>,
    clear: Ready,
    /// Again and again: lists go on by so many layers.
    each: Vec<Ready>,
    after: Vec<Ready>,
}

impl<'r, 'g> Following<'r, 'g> {
    /// Sets up the passes over a whole target, whose lists are sorted and certified.
    ///
    /// # Errors
    /// A target or lists that do not fit at once, by name; WGSL errors; what the device refuses.
    pub fn new(
        rasterizer: &'r Rasterizer<'g>,
        shading: Shading,
        given: Given<'_>,
        lists: &Lists,
    ) -> Result<Self, GpuError> {
        let gpu = rasterizer.gpu;
        let (band, pixels) = whole(rasterizer)?;
        let surfaces = Surfaces::upload(rasterizer, given.opaque, band)?;
        let mut buffers = read_lists(gpu, lists, pixels)?;
        match shading {
            Shading::Density(sigma) => {
                let words = [sigma, 0.0, 0.0, 0.0];
                buffers.push(("sigma", gpu.uniform("sigma", &words)?));
            }
            Shading::Defocus(lens) => {
                buffers.push(("layer", gpu.storage("layer", 8 * pixels)?));
                let words = [lens.focus, lens.aperture, lens.radius, 0];
                buffers.push(("lens", gpu.uniform("lens", &words)?));
            }
        }
        let mut named: Vec<(&str, &wgpu::Buffer)> = surfaces.named().to_vec();
        named.extend(buffers.iter().map(|(name, buffer)| (*name, buffer)));
        let frame = frame(rasterizer, band, given.background);
        let passes = |stages: &[&str]| -> Result<Vec<Ready>, GpuError> {
            let file = stages[0];
            let ready = |stage: &&str| rasterizer.ready_per_pixel(file, stage, frame, &named);
            stages[1..].iter().map(ready).collect()
        };
        let (clear, each, after) = match shading {
            Shading::Density(_) => (
                passes(&["density", "density_clear"])?,
                passes(&["density", "density"])?,
                Vec::new(),
            ),
            Shading::Defocus(_) => (
                passes(&["defocus", "defocus_clear"])?,
                passes(&["defocus", "defocus_layer", "defocus"])?,
                passes(&["defocus", "defocus_surface", "defocus", "defocus_behind"])?,
            ),
        };
        Ok(Self {
            rasterizer,
            clear: clear.into_iter().next().expect("one was asked for"),
            each,
            after,
            buffers,
        })
    }

    /// What runs, in order, for lists of so many layers at most.
    pub(crate) fn passes(&self, layers: u32) -> impl Iterator<Item = &Ready> {
        let times = match self.after.is_empty() {
            true => u32::try_from(u64::from(layers) / STEPS + 1).expect("fewer than layers"),
            false => layers,
        };
        let each = (0..times).flat_map(|_| &self.each);
        std::iter::once(&self.clear).chain(each).chain(&self.after)
    }

    /// Runs it once, over lists of so many layers at most, and gives the picture.
    ///
    /// # Errors
    /// [`GpuError::Endless`] where a list is longer; whatever the device reports.
    pub fn run(&self, layers: u32) -> Result<Vec<[f32; 3]>, GpuError> {
        let (rasterizer, gpu) = (self.rasterizer, self.rasterizer.gpu);
        let stage = match self.after.is_empty() {
            true => "density",
            false => "defocus",
        };
        let unfinished = by_name(&self.buffers, "unfinished");
        run_through(rasterizer, self.passes(layers), unfinished, stage)?;
        let pixels = Band::whole(rasterizer.size).pixels(rasterizer.size);
        image(gpu, by_name(&self.buffers, "picture"), pixels)
    }

    /// Seconds of a run of so many layers, of the only span of a timer.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn time(&self, timer: &Timer, layers: u32) -> Result<f64, GpuError> {
        let count = self.passes(layers).count();
        let spans = timer.time(self.rasterizer.gpu, 0..1, |span, encoder, queries| {
            for (at, pass) in self.passes(layers).enumerate() {
                let writes = queries.and_then(|q| q.writes(span, at, count));
                pass.record(self.rasterizer, encoder, writes);
            }
        })?;
        Ok(spans[0])
    }

    /// Bytes of its buffers, lists and all.
    pub fn bytes(&self) -> u64 {
        self.buffers.iter().map(|(_, buffer)| buffer.size()).sum()
    }
}

/// Shades sorted lists of a whole target, of so many layers at most.
///
/// # Errors
/// What does not fit, by name; WGSL errors; whatever the device reports.
pub fn follow(
    rasterizer: &Rasterizer<'_>,
    shading: Shading,
    given: Given<'_>,
    lists: &Lists,
    layers: u32,
) -> Result<Rival, GpuError> {
    rasterizer.take_passes();
    let following = Following::new(rasterizer, shading, given, lists)?;
    let start = Instant::now();
    let image = following.run(layers)?;
    Ok(Rival {
        image,
        time: start.elapsed(),
        passes: rasterizer.take_passes(),
        bytes: following.bytes(),
        layers,
        ..Rival::default()
    })
}
