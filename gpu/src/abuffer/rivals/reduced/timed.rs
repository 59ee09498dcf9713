//! A frame at a reduced resolution, set up once and run many times, each part timed.

use triptych_spec::abuffer::{Lists, Reduction};

use super::Reducing;
use crate::abuffer::buffers::{self, Buffers};
use crate::abuffer::rivals::{Surfaces, frame, image, whole};
use crate::abuffer::timed::{Part, Strip};
use crate::abuffer::{Options, STEPS};
use crate::error::GpuError;
use crate::raster::{Rasterizer, Ready};
use crate::timer::Timer;

/// Lists of a reduced target from its triangles, and what the full one shows of them by the reduced pixels
/// around each of its own.
pub struct Reduced<'r, 'g> {
    full: &'r Rasterizer<'g>,
    low: Rasterizer<'g>,
    buffers: Buffers,
    capacity: u32,
    /// Surfaces and lists of the reduced target; these in order; the picture.
    parts: [Vec<Ready>; 3],
    /// The last pass of the picture, over the full target.
    show: Ready,
    shown: wgpu::Buffer,
    bytes: u64,
}

impl<'r, 'g> Reduced<'r, 'g> {
    /// Parts that are timed: what builds the lists, what puts them in order, what makes the picture.
    pub const PARTS: u32 = 3;

    /// Sets up a frame in front of the full target's surfaces. `low` is the same triangles on the reduced
    /// target; there is room for `options.capacity` nodes, and no list has more than `longest`.
    ///
    /// # Errors
    /// Targets that do not fit at once, by name; WGSL errors; what the device refuses.
    pub fn new(
        full: &'r Rasterizer<'g>,
        low: Rasterizer<'g>,
        surfaces: &Surfaces,
        options: Options<'_>,
        (reduction, longest): (Reduction, u32),
        is_opaque: impl Fn(u32) -> bool,
    ) -> Result<Self, GpuError> {
        let gpu = full.gpu;
        let ((band, pixels), (below, few)) = (whole(full)?, whole(&low)?);
        let capacity = options.capacity.unwrap_or(0);
        let words = [below.pixels(low.size), 1];
        let buffers = Buffers::sampled(gpu, words, capacity, low.kernels.fault())?;
        let mut strip = Strip::new(&low, &options, (below, capacity), &buffers, is_opaque)?;
        strip.follow(&low, &buffers, longest, &[])?;
        let cursors = gpu.storage("cursors", 4 * few)?;
        let unfinished = gpu.storage("unfinished", 4)?;
        let mut named = buffers.named().to_vec();
        named.extend([("cursors", &cursors), ("unfinished", &unfinished)]);
        let blend = |stage| low.ready_per_pixel("reduced", stage, strip.frame, &named);
        let mut blended = vec![blend("reduced_clear")?];
        for _ in 0..=u64::from(longest) / STEPS {
            blended.push(blend("reduced_layers")?);
        }
        let reducing = gpu.uniform("reduction", &Reducing::new(&low, reduction))?;
        let shown = gpu.storage("picture", 16 * pixels)?;
        let mut named = vec![
            ("picture", &shown),
            ("reduced_layer", &buffers.picture),
            ("guide", &buffers.opaque_key),
            ("reduction", &reducing),
        ];
        named.extend(surfaces.named());
        let above = frame(full, band, options.background);
        let show = full.ready_per_pixel("reduced", "reduced", above, &named)?;
        let mut parts = [Vec::new(), Vec::new(), blended];
        for (part, passes) in strip.parts {
            match part {
                Part::Clear | Part::Opaque | Part::Build => parts[0].extend(passes),
                Part::Sort => parts[1].extend(passes),
                // The reduced target's own picture.
                Part::Nearest(_) | Part::NearestSorted(_) | Part::Resolve => {}
            }
        }
        Ok(Self {
            bytes: buffers::bytes(words, capacity, true) + 4 * few + shown.size(),
            full,
            low,
            buffers,
            capacity,
            parts,
            show,
            shown,
        })
    }

    /// Builds the lists of the reduced target and puts them in order; these.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn lists(&self) -> Result<Lists, GpuError> {
        let mut encoder = self.full.gpu.encoder();
        for pass in self.parts[..2].iter().flatten() {
            pass.record(&self.low, &mut encoder, None);
        }
        self.full.gpu.submit(encoder)?;
        let (_, pixels) = whole(&self.low)?;
        let pixels = u32::try_from(pixels).expect("pixels of a target are words");
        self.buffers.lists(self.full.gpu, pixels, self.capacity)
    }

    /// Runs it once, and gives the picture.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn picture(&self) -> Result<Vec<[f32; 3]>, GpuError> {
        let (gpu, (band, _)) = (self.full.gpu, whole(self.full)?);
        let mut encoder = gpu.encoder();
        for pass in self.parts.iter().flatten() {
            pass.record(&self.low, &mut encoder, None);
        }
        self.show.record(self.full, &mut encoder, None);
        gpu.submit(encoder)?;
        image(gpu, &self.shown, band.pixels(self.full.size))
    }

    /// Runs it once, and gives the seconds of each part.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn time(&self, timer: &Timer) -> Result<Vec<f64>, GpuError> {
        timer.time(self.full.gpu, 0..Self::PARTS, |span, encoder, queries| {
            let passes = &self.parts[span as usize];
            let is_last = span + 1 == Self::PARTS;
            let count = passes.len() + usize::from(is_last);
            let writes = |at| queries.and_then(|q| q.writes(span, at, count));
            for (at, pass) in passes.iter().enumerate() {
                pass.record(&self.low, encoder, writes(at));
            }
            if is_last {
                self.show.record(self.full, encoder, writes(passes.len()));
            }
        })
    }

    /// Bytes of its buffers, but for the triangles.
    pub fn bytes(&self) -> u64 {
        self.bytes
    }
}
