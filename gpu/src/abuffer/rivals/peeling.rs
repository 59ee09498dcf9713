//! Techniques that go through all triangles again for every layer, set up.

use super::{Surfaces, frame};
use crate::context::Gpu;
use crate::error::GpuError;
use crate::frame::Band;
use crate::raster::{Path, Rasterizer, Ready};
use crate::timer::Timer;

/// Which layers come next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Technique {
    /// Stage `peel`: the nearest.
    Peel,
    /// Stage `dual`: the nearest and the farthest.
    Dual,
    /// Stage `alpha` where nothing blends in order by itself: the first of those submitted.
    Alpha,
}

impl Technique {
    /// The stage, which is also the file of its kernels and the one that blends.
    pub fn name(self) -> &'static str {
        match self {
            Self::Peel => "peel",
            Self::Dual => "dual",
            Self::Alpha => "alpha",
        }
    }

    /// Stages that go through the triangles, once a layer. Where one atomic holds key and
    /// triangle together, `wide`, the first pass of [`Self::Peel`] finds both.
    fn drawn(self, wide: bool) -> &'static [&'static str] {
        match (self, wide) {
            (Self::Peel, true) => &["peel_nearest"],
            (Self::Peel, false) => &["peel_nearest", "peel_first"],
            (Self::Dual, _) => &["dual_nearest", "dual_first"],
            (Self::Alpha, _) => &["alpha_next"],
        }
    }

    /// Name and bytes a pixel of its buffers.
    fn needs(self, wide: bool) -> &'static [(&'static str, u64)] {
        match (self, wide) {
            (Self::Peel, true) => &[("picture", 16), ("last", 8), ("near_both", 8)],
            (Self::Peel, false) => &[
                ("picture", 16),
                ("last", 8),
                ("near_key", 4),
                ("near_prim", 4),
            ],
            (Self::Dual, _) => &[("picture", 16), ("between", 16), ("ends", 16), ("back", 16)],
            (Self::Alpha, _) => &[("picture", 16), ("last", 4), ("near_prim", 4)],
        }
    }

    /// Where it keeps what it peeled last: the buffer, and its words a pixel.
    pub(super) fn kept(self) -> (&'static str, u64) {
        match self {
            Self::Peel => ("last", 2),
            Self::Dual => ("between", 4),
            Self::Alpha => ("last", 1),
        }
    }
}

/// A technique that is set up over a band.
pub struct Peeling<'r, 'g> {
    rasterizer: &'r Rasterizer<'g>,
    buffers: Vec<(&'static str, wgpu::Buffer)>,
    pixels: u32,
    clear: Ready,
    layer: Vec<Ready>,
    behind: Ready,
}

impl<'r, 'g> Peeling<'r, 'g> {
    /// Sets up the passes over a band, in front of these surfaces.
    ///
    /// # Errors
    /// WGSL errors; what the device refuses.
    pub fn new(
        rasterizer: &'r Rasterizer<'g>,
        technique: Technique,
        surfaces: &Surfaces,
        (band, background): (Band, [f32; 3]),
        is_opaque: impl Fn(u32) -> bool,
    ) -> Result<Self, GpuError> {
        let gpu = rasterizer.gpu;
        let wide = is_wide(rasterizer);
        let pixels = band.pixels(rasterizer.size);
        let buffer = |(name, bytes): &(&'static str, u64)| {
            Ok((*name, gpu.storage(name, bytes * u64::from(pixels))?))
        };
        let mut buffers: Vec<(&'static str, wgpu::Buffer)> = technique
            .needs(wide)
            .iter()
            .map(buffer)
            .collect::<Result<_, GpuError>>()?;
        buffers.push(("peeled", gpu.storage("peeled", 4)?));
        let mut named: Vec<(&str, &wgpu::Buffer)> = surfaces.named().to_vec();
        named.extend(buffers.iter().map(|(name, buffer)| (*name, buffer)));
        let frame = frame(rasterizer, band, background);
        let file = technique.name();
        let pass = |stage: &str| rasterizer.ready_per_pixel(file, stage, frame, &named);
        let work = rasterizer.work(band, |prim| !is_opaque(prim))?;
        let mut layer = Vec::new();
        for stage in technique.drawn(wide) {
            layer.extend(rasterizer.ready(file, stage, frame, &work, &named)?);
        }
        layer.push(pass(file)?);
        let clear = pass(&format!("{file}_clear"))?;
        let behind = pass(&format!("{file}_behind"))?;
        Ok(Self {
            rasterizer,
            pixels,
            clear,
            layer,
            behind,
            buffers,
        })
    }

    /// What runs for the picture of so many layers, in order: the beginning, each layer's
    /// passes, and what lies behind. Layers that are not there change nothing.
    pub(crate) fn passes(&self, layers: u32) -> impl Iterator<Item = &Ready> {
        let each = (0..layers).flat_map(|_| &self.layer);
        std::iter::once(&self.clear)
            .chain(each)
            .chain(std::iter::once(&self.behind))
    }

    /// The passes of the beginning, of a layer, and of the end.
    pub(super) fn parts(&self) -> [&[Ready]; 3] {
        let one = std::slice::from_ref;
        [one(&self.clear), &self.layer, one(&self.behind)]
    }

    /// A buffer by its variable's name.
    pub(super) fn buffer(&self, name: &str) -> &wgpu::Buffer {
        let found = self.buffers.iter().find(|(other, _)| *other == name);
        &found.expect("it was made for the kernels").1
    }

    /// Bytes of its own buffers: what does not depend on how many layers there are.
    pub fn bytes(&self) -> u64 {
        self.buffers.iter().map(|(_, buffer)| buffer.size()).sum()
    }

    /// Runs so many layers.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn run(&self, layers: u32) -> Result<Vec<[f32; 3]>, GpuError> {
        let gpu: &Gpu = self.rasterizer.gpu;
        let mut encoder = gpu.encoder();
        for pass in self.passes(layers) {
            pass.record(self.rasterizer, &mut encoder, None);
        }
        gpu.submit(encoder)?;
        super::image(gpu, self.buffer("picture"), self.pixels)
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

    /// Fragments that the last run peeled.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn peeled(&self) -> Result<u32, GpuError> {
        self.rasterizer.gpu.word(self.buffer("peeled"), 0)
    }
}

/// Whether one atomic holds key and triangle.
pub fn is_wide(rasterizer: &Rasterizer<'_>) -> bool {
    rasterizer.path == Path::Native && rasterizer.kernels.alike("near", "near_wide")
}
