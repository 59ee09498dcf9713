//! The A-buffer of a target, set up once and run many times, each part timed.
//!
//! Where an adapter binds less than all lists take, or the memory that it may use is less, the
//! target is made in bands of rows, one after another in the same buffers (section 5: "allocate a
//! smaller set of buffers and render the scene in tiles"). The time of a part is then that of all
//! bands.

mod part;
mod strip;

use triptych_spec::abuffer::Lists;

use super::Options;
use super::buffers::{self, Buffers};
use crate::error::GpuError;
use crate::frame::Band;
use crate::raster::{Attempts, Rasterizer, Ready};
use crate::timer::Timer;
pub use part::{KEPT_MAX, Part, can_keep, with_layers};
pub(super) use strip::Strip;

/// A frame that is set up. It never overflows: the capacity is that of the spec's count.
pub struct Timed<'r, 'g> {
    rasterizer: &'r Rasterizer<'g>,
    buffers: Buffers,
    strips: Vec<Strip>,
    /// Band and part of all that runs, in this order.
    spans: Vec<[usize; 2]>,
    /// The parts, of which some may have no passes in some bands.
    parts: Vec<Part>,
    /// Pixels, their samples, and nodes that there is room for.
    room: ([u32; 2], u32),
}

impl<'r, 'g> Timed<'r, 'g> {
    /// Sets up what builds the lists of a whole target at once, with room for exactly
    /// `options.capacity` nodes.
    ///
    /// # Errors
    /// A target that does not fit in one band, by name; WGSL errors; what the device
    /// refuses.
    pub fn new(
        rasterizer: &'r Rasterizer<'g>,
        options: Options<'_>,
        is_opaque: impl Fn(u32) -> bool,
    ) -> Result<Self, GpuError> {
        let (gpu, size) = (rasterizer.gpu, rasterizer.size);
        let band = Band::whole(size);
        let need = buffers::need_of(gpu, rasterizer.samples.count());
        let pixels = u64::from(band.pixels(size));
        if pixels > need.pixels_max {
            return Err(GpuError::Limit {
                adapter: gpu.name.clone(),
                what: "a whole target",
                needed: pixels,
                limit: need.pixels_max,
            });
        }
        let bands = [(band, options.capacity.unwrap_or(0))];
        Self::over(rasterizer, options, &bands, is_opaque)
    }

    /// The same in as many bands as it takes, whose buffers hold no more than `budget` bytes
    /// together, or what is left if the device has less. There are `rows` nodes in each row.
    ///
    /// # Errors
    /// A single row that does not fit, by name; WGSL errors; what the device refuses.
    pub fn in_bands(
        rasterizer: &'r Rasterizer<'g>,
        options: Options<'_>,
        rows: &[u32],
        budget: u64,
        is_opaque: impl Fn(u32) -> bool,
    ) -> Result<Self, GpuError> {
        let (gpu, size) = (rasterizer.gpu, rasterizer.size);
        let need = buffers::need_of(gpu, rasterizer.samples.count());
        let mut budget = budget;
        loop {
            let attempts = Attempts::new(gpu, size, need, None).within(budget);
            let bands: Vec<(Band, u32)> = attempts.with_rows(rows.iter().copied()).collect();
            let many = bands.iter().any(|(band, _)| band.rows > 1);
            match Self::over(rasterizer, options, &bands, &is_opaque) {
                // It has less than that: in smaller bands, down to single rows.
                Err(GpuError::Memory { .. }) if many => budget /= 2,
                made => return made,
            }
        }
    }

    fn over(
        rasterizer: &'r Rasterizer<'g>,
        options: Options<'_>,
        bands: &[(Band, u32)],
        is_opaque: impl Fn(u32) -> bool,
    ) -> Result<Self, GpuError> {
        let gpu = rasterizer.gpu;
        let rows = bands.iter().map(|(band, _)| band.rows).max().unwrap_or(0);
        let pixels = rows * rasterizer.size.width;
        let capacity = bands.iter().map(|(_, nodes)| *nodes).max().unwrap_or(0);
        let samples = rasterizer.samples.count();
        let fault = rasterizer.kernels.fault();
        let mut timed = Self {
            rasterizer,
            buffers: Buffers::sampled(gpu, [pixels, samples], capacity, fault)?,
            strips: Vec::new(),
            spans: Vec::new(),
            parts: Vec::new(),
            room: ([pixels, samples], capacity),
        };
        for at in bands {
            let strip = Strip::new(rasterizer, &options, *at, &timed.buffers, &is_opaque)?;
            timed.strips.push(strip);
        }
        timed.number();
        Ok(timed)
    }

    /// Numbers what runs: parts without passes have no times.
    fn number(&mut self) {
        self.spans.clear();
        self.parts.clear();
        for (band, strip) in self.strips.iter().enumerate() {
            let own = strip.parts.iter().enumerate();
            let own = own.filter(|(_, (_, passes))| !passes.is_empty());
            self.spans.extend(own.map(|(part, _)| [band, part]));
        }
        let Some(first) = self.strips.first() else {
            return;
        };
        for (at, (part, _)) in first.parts.iter().enumerate() {
            if self.spans.iter().any(|span| span[1] == at) {
                self.parts.push(*part);
            }
        }
    }

    /// How many bands there are.
    pub fn bands(&self) -> usize {
        self.strips.len()
    }

    /// Bytes of the buffers, but for the triangles: those of the largest band, whether or not its
    /// lists are sorted.
    pub fn bytes(&self, sorts: bool) -> u64 {
        buffers::bytes(self.room.0, self.room.1, sorts)
    }

    /// Runs what builds the lists, and gives those of each band to be certified.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn build(&self, mut show: impl FnMut(Band, Lists)) -> Result<(), GpuError> {
        for strip in &self.strips {
            for (_, passes) in strip.built() {
                self.run(passes)?;
            }
            show(strip.band, self.lists(strip)?);
        }
        Ok(())
    }

    /// Runs all up to stage sort, which [`Self::follow`] set up, and gives the lists of each band
    /// to be compared.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn sorted(&self, mut show: impl FnMut(Band, Lists)) -> Result<(), GpuError> {
        for strip in &self.strips {
            for (part, passes) in &strip.parts {
                self.run(passes)?;
                if *part == Part::Sort {
                    break;
                }
            }
            show(strip.band, self.lists(strip)?);
        }
        Ok(())
    }

    /// The lists of a band as they are.
    fn lists(&self, strip: &Strip) -> Result<Lists, GpuError> {
        let pixels = strip.band.pixels(self.rasterizer.size);
        let gpu = self.rasterizer.gpu;
        self.buffers.lists(gpu, pixels, strip.frame.capacity)
    }

    /// Sets up what follows the lists, of which the longest has `longest` nodes for
    /// certain: each number of layers from the lists as they are, where that is possible;
    /// each below that length from the sorted ones; and all. With several samples a pixel, only
    /// all.
    ///
    /// # Errors
    /// WGSL errors; what the device refuses.
    pub fn follow(&mut self, longest: u32, layers: &[u32]) -> Result<(), GpuError> {
        for strip in &mut self.strips {
            strip.follow(self.rasterizer, &self.buffers, longest, layers)?;
        }
        self.number();
        Ok(())
    }

    /// The parts, in the order in which they run.
    pub fn parts(&self) -> impl Iterator<Item = Part> {
        self.parts.iter().copied()
    }

    /// How many spans a timer of them needs.
    pub fn spans(&self) -> u32 {
        u32::try_from(self.spans.len()).expect("a few parts of each band")
    }

    fn run(&self, passes: &[Ready]) -> Result<(), GpuError> {
        let mut encoder = self.rasterizer.gpu.encoder();
        for pass in passes {
            pass.record(self.rasterizer, &mut encoder, None);
        }
        self.rasterizer.gpu.submit(encoder)
    }

    /// Runs every part once, one after another, and shows the picture of each that makes
    /// one.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn pictures(&self, mut show: impl FnMut(Part, Vec<[f32; 3]>)) -> Result<(), GpuError> {
        let gpu = self.rasterizer.gpu;
        let mut all: Vec<(Part, Vec<[f32; 3]>)> = Vec::new();
        for strip in &self.strips {
            let stride = strip.frame.samples as usize;
            let count = strip.band.pixels(self.rasterizer.size) as usize * stride;
            for (part, passes) in &strip.parts {
                self.run(passes)?;
                if !part.draws() {
                    continue;
                }
                let picture: Vec<[f32; 4]> = gpu.read(&self.buffers.picture, count)?;
                let pixels = picture
                    .iter()
                    .step_by(stride)
                    .map(|[r, g, b, _]| [*r, *g, *b]);
                match all.iter_mut().find(|(other, _)| other == part) {
                    Some((_, picture)) => picture.extend(pixels),
                    None => all.push((*part, pixels.collect())),
                }
            }
        }
        for (part, picture) in all {
            show(part, picture);
        }
        Ok(())
    }

    /// Runs every part once, and gives the seconds of each, over all bands. Parts that may come
    /// in any order change places from round to round, so that none is always first.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn time(&self, timer: &Timer, round: u32) -> Result<Vec<f64>, GpuError> {
        let gpu = self.rasterizer.gpu;
        let order = self.order(round);
        let all = timer.time(gpu, order.into_iter(), |span, encoder, queries| {
            let [band, part] = self.spans[span as usize];
            let passes = &self.strips[band].parts[part].1;
            for (at, pass) in passes.iter().enumerate() {
                let writes = queries.and_then(|q| q.writes(span, at, passes.len()));
                pass.record(self.rasterizer, encoder, writes);
            }
        })?;
        let mut seconds = vec![0.0; self.parts.len()];
        for ([band, part], taken) in self.spans.iter().zip(all) {
            let part = self.strips[*band].parts[*part].0;
            let at = self.parts.iter().position(|own| *own == part);
            seconds[at.expect("it has passes, so it is listed")] += taken;
        }
        Ok(seconds)
    }

    /// What runs, by its numbers: neighbours of one kind in a band rotate.
    fn order(&self, round: u32) -> Vec<u32> {
        let mut order: Vec<u32> = (0..self.spans()).collect();
        let kind = |at: &u32| {
            let [band, part] = self.spans[*at as usize];
            let part = self.strips[band].parts[part].0;
            (band, std::mem::discriminant(&part))
        };
        for same in order.chunk_by_mut(|a, b| kind(a) == kind(b)) {
            let by = round as usize % same.len();
            same.rotate_left(by);
        }
        order
    }
}
