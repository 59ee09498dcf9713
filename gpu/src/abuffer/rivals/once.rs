//! Techniques that go through the triangles once, set up.

use std::time::Instant;

use super::targets::{Blend, Targets};
use super::{Given, Rival, Surfaces, bands, frame, image};
use crate::error::GpuError;
use crate::frame::Band;
use crate::raster::{Path, Rasterizer, Ready};

/// What goes through the triangles once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Single {
    /// Stage `alpha` by the hardware, into 16-bit floats if `half`.
    Alpha {
        /// Whether the target has 16 bits a channel.
        half: bool,
    },
    /// Stage `weighted`: sums by the hardware on the fragment path, by atomics on others.
    Weighted,
}

/// A technique that is set up over a band.
pub struct Once<'r, 'g> {
    rasterizer: &'r Rasterizer<'g>,
    before: Vec<Ready>,
    drawn: Vec<Ready>,
    targets: Option<Targets>,
    after: Vec<Ready>,
    picture: wgpu::Buffer,
    sums: wgpu::Buffer,
    pixels: u32,
}

impl<'r, 'g> Once<'r, 'g> {
    /// Sets up the passes over a band, in front of these surfaces.
    ///
    /// # Errors
    /// WGSL errors; what the device refuses, as to blend 32-bit floats
    /// ([`crate::context::Gpu::blends_floats`]).
    pub fn new(
        rasterizer: &'r Rasterizer<'g>,
        technique: Single,
        surfaces: &Surfaces,
        (band, background): (Band, [f32; 3]),
        is_opaque: impl Fn(u32) -> bool,
    ) -> Result<Self, GpuError> {
        let gpu = rasterizer.gpu;
        let pixels = band.pixels(rasterizer.size);
        let frame = frame(rasterizer, band, background);
        let blend = match (technique, rasterizer.path) {
            (Single::Alpha { half }, _) => Some(Blend::Over { half }),
            (Single::Weighted, Path::Fragment) => Some(Blend::Sums),
            (Single::Weighted, _) => None,
        };
        let picture = gpu.storage("picture", 16 * u64::from(pixels))?;
        let sums = match blend {
            None => gpu.storage("sums", 20 * u64::from(pixels))?,
            Some(_) => gpu.storage("sums", 0)?,
        };
        let targets = blend.map(|blend| Targets::new(rasterizer, blend, band));
        let targets = targets.transpose()?;
        let mut named: Vec<(&str, &wgpu::Buffer)> = surfaces.named().to_vec();
        named.extend([("picture", &picture), ("sums", &sums)]);
        named.extend(targets.iter().flat_map(Targets::named));
        let work = rasterizer.work(band, |prim| !is_opaque(prim))?;
        let file = match technique {
            Single::Alpha { .. } => "alpha",
            Single::Weighted => "weighted",
        };
        let pass = |stage: &str| rasterizer.ready_per_pixel(file, stage, frame, &named);
        let (mut before, mut after) = (Vec::new(), Vec::new());
        let drawn = match blend {
            Some(blend) => {
                let entry = format!("{file}_fragment");
                let targets = blend.states();
                let kernels = rasterizer.kernels;
                let kernel = kernels.blending(gpu, file, ["place", &entry], &targets)?;
                rasterizer.ready_kernel(&kernel, file, frame, &work, &named)?
            }
            None => {
                before.push(pass("weighted_clear")?);
                rasterizer.ready(file, file, frame, &work, &named)?
            }
        };
        for stage in after_drawing(technique, blend) {
            after.push(pass(stage)?);
        }
        Ok(Self {
            rasterizer,
            before,
            drawn,
            targets,
            after,
            picture,
            sums,
            pixels,
        })
    }

    /// Records all of it; `writes` notes when each of the passes begins and ends.
    pub(crate) fn record(&self, encoder: &mut wgpu::CommandEncoder) {
        self.rasterizer.record(&self.before, encoder);
        match &self.targets {
            None => self.rasterizer.record(&self.drawn, encoder),
            Some(targets) => {
                targets.clear(encoder);
                for pass in &self.drawn {
                    self.rasterizer
                        .record_into(pass, &targets.attachments(), encoder, None);
                }
                targets.copy(encoder);
            }
        }
        self.rasterizer.record(&self.after, encoder);
    }

    /// Runs it once, and gives the picture.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn run(&self) -> Result<Vec<[f32; 3]>, GpuError> {
        let mut encoder = self.rasterizer.gpu.encoder();
        self.record(&mut encoder);
        self.rasterizer.gpu.submit(encoder)?;
        image(self.rasterizer.gpu, &self.picture, self.pixels)
    }

    /// Bytes of its buffers and targets.
    pub fn bytes(&self) -> u64 {
        let targets = self.targets.as_ref().map_or(0, Targets::bytes);
        self.picture.size() + self.sums.size() + targets
    }
}

/// Stages of the pixels, once all is drawn.
fn after_drawing(technique: Single, blend: Option<Blend>) -> &'static [&'static str] {
    match (technique, blend) {
        (Single::Alpha { half: false }, _) => &["alpha_single", "alpha_behind"],
        (Single::Alpha { half: true }, _) => &["alpha_half", "alpha_behind"],
        (Single::Weighted, Some(_)) => &["weighted_blended"],
        (Single::Weighted, None) => &["weighted_behind"],
    }
}

/// Runs a technique over the whole target.
///
/// # Errors
/// WGSL errors; whatever the device reports.
pub fn once(
    rasterizer: &Rasterizer<'_>,
    technique: Single,
    given: Given<'_>,
    is_opaque: impl Fn(u32) -> bool,
) -> Result<Rival, GpuError> {
    rasterizer.take_passes();
    let mut all = Rival {
        layers: 1,
        ..Rival::default()
    };
    for band in bands(rasterizer, 20) {
        let surfaces = Surfaces::upload(rasterizer, given.opaque, band)?;
        let at = (band, given.background);
        let once = Once::new(rasterizer, technique, &surfaces, at, &is_opaque)?;
        let start = Instant::now();
        all.image.extend(once.run()?);
        all.time += start.elapsed();
        all.bytes = all.bytes.max(once.bytes());
    }
    all.passes = rasterizer.take_passes();
    Ok(all)
}
