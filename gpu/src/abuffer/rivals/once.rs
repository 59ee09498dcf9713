//! Techniques that go through the triangles once, set up.

use std::time::Instant;

use super::targets::{Blend, Targets};
use super::{Given, Rival, Surfaces, bands, frame, image};
use crate::error::GpuError;
use crate::frame::Band;
use crate::raster::{Path, Rasterizer, Ready};
use crate::timer::{Timer, Writes};

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

    /// Records all of it; `writes` says what each pass notes of its beginning and end, by its
    /// number and how many there are.
    pub(crate) fn record<'w>(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        writes: impl Fn(usize, usize) -> Option<Writes<'w>>,
    ) {
        let first = self.before.len() + usize::from(self.targets.is_some());
        let count = first + self.drawn.len() + self.after.len();
        let mut numbers = 0..count;
        let mut next = || writes(numbers.next().unwrap_or(count), count);
        for pass in &self.before {
            self.rasterizer.record_pass(pass, encoder, next());
        }
        if let Some(targets) = &self.targets {
            targets.clear(encoder, next());
        }
        for pass in &self.drawn {
            match &self.targets {
                None => self.rasterizer.record_pass(pass, encoder, next()),
                Some(targets) => {
                    let into = targets.attachments();
                    self.rasterizer.record_into(pass, &into, encoder, next());
                }
            }
        }
        if let Some(targets) = &self.targets {
            targets.copy(encoder);
        }
        for pass in &self.after {
            self.rasterizer.record_pass(pass, encoder, next());
        }
    }

    /// Seconds of a run, of the only span of a timer.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn time(&self, timer: &Timer) -> Result<f64, GpuError> {
        let gpu = self.rasterizer.gpu;
        let spans = timer.time(gpu, 0..1, |span, encoder, queries| {
            self.record(encoder, |at, of| {
                queries.and_then(|q| q.writes(span, at, of))
            });
        })?;
        Ok(spans[0])
    }

    /// Runs it once, and gives the picture.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn run(&self) -> Result<Vec<[f32; 3]>, GpuError> {
        let mut encoder = self.rasterizer.gpu.encoder();
        self.record(&mut encoder, |_, _| None);
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
