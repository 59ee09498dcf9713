//! The A-buffer of a whole target, set up once and run many times, each part timed.

use triptych_spec::abuffer::Lists;

use super::attempt::dispatches;
use super::buffers::{self, Buffers};
use super::{Options, STEPS};
use crate::error::GpuError;
use crate::frame::{Band, Frame};
use crate::raster::{Rasterizer, Ready};
use crate::timer::Timer;
use crate::wgsl::Sources;

/// The file that ships the kernels of the nearest layers.
const FILE: &str = "nearest";

/// Most layers that [`Part::Nearest`] keeps: two words each in an invocation's own
/// memory, of which drivers have little.
pub const KEPT_MAX: u32 = 64;

/// A part of a frame, which is timed by itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// Empties lists and surfaces.
    Clear,
    /// Both passes of stage opaque.
    Opaque,
    /// Stage build.
    Build,
    /// The picture of so many nearest layers, from the lists as they were built.
    Nearest(u32),
    /// Stage sort.
    Sort,
    /// The picture of so many nearest layers, from the sorted lists.
    NearestSorted(u32),
    /// Stage resolve: the picture of all layers, from the sorted lists.
    Resolve,
}

impl Part {
    /// Whether it makes a picture.
    pub fn draws(self) -> bool {
        matches!(
            self,
            Self::Nearest(_) | Self::NearestSorted(_) | Self::Resolve
        )
    }
}

/// A frame that is set up. It never overflows: the capacity is that of the spec's count.
pub struct Timed<'r, 'g> {
    rasterizer: &'r Rasterizer<'g>,
    buffers: Buffers,
    frame: Frame,
    parts: Vec<(Part, Vec<Ready>)>,
    built: usize,
}

/// The kernels that ship, and those that show so many layers.
pub fn with_layers(sources: Sources, layers: &[u32]) -> Sources {
    let ours = |(name, _): &(&str, &str)| *name == FILE;
    let text = sources.files().find(ours).map(|(_, text)| text.to_owned());
    let text = text.unwrap_or_default();
    layers.iter().fold(sources, |sources, n| {
        let text = text.replacen("LAYERS: u32 = 1u;", &format!("LAYERS: u32 = {n}u;"), 1);
        sources.with(file(*n), text)
    })
}

fn file(layers: u32) -> String {
    format!("{FILE}-{layers}")
}

/// Whether every list of up to `longest` nodes is served by [`Part::Nearest`] in one
/// dispatch: a step for each node, and one for each that an insertion moves.
pub fn can_keep(layers: u32, longest: u32) -> bool {
    let [layers, longest] = [layers, longest].map(u64::from);
    layers <= KEPT_MAX.into() && longest * (1 + layers.min(longest)) + layers <= STEPS
}

impl<'r, 'g> Timed<'r, 'g> {
    /// Sets up what builds the lists, with room for exactly `options.capacity` nodes.
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
        let capacity = options.capacity.unwrap_or(0);
        let (pixels, need) = (band.pixels(size), buffers::need(gpu));
        if u64::from(pixels) > need.pixels_max {
            return Err(GpuError::Limit {
                adapter: gpu.name.clone(),
                what: "a whole target",
                needed: pixels.into(),
                limit: need.pixels_max,
            });
        }
        let [r, g, b] = options.background;
        let frame = Frame {
            capacity,
            depth_test: u32::from(options.depth_test),
            background: [r, g, b, 1.0],
            ..rasterizer.frame(band)
        };
        let fault = rasterizer.kernels.fault();
        let buffers = Buffers::empty(gpu, pixels, capacity, fault)?;
        let named = buffers.named();
        let mut parts = Vec::new();
        let clear = rasterizer.ready_per_pixel(FILE, "clear_lists", frame, &named)?;
        parts.push((Part::Clear, vec![clear]));
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
            let passes = rasterizer.ready("abuffer", "build", frame, &work, &named)?;
            parts.push((Part::Build, passes));
        }
        // What lies outside the picture has no passes, hence no times.
        parts.retain(|(_, passes)| !passes.is_empty());
        Ok(Self {
            rasterizer,
            frame,
            built: parts.len(),
            parts,
            buffers,
        })
    }

    /// Runs what builds the lists, and gives them to be certified.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn build(&self) -> Result<Lists, GpuError> {
        for part in 0..self.built {
            self.run(part)?;
        }
        self.lists()
    }

    /// Runs all up to stage sort, which [`Self::follow`] set up, and gives the lists to be
    /// compared.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn sorted(&self) -> Result<Lists, GpuError> {
        for (at, part) in self.parts().enumerate() {
            self.run(at)?;
            if part == Part::Sort {
                break;
            }
        }
        self.lists()
    }

    /// The lists as they are.
    fn lists(&self) -> Result<Lists, GpuError> {
        let pixels = self.frame.width * self.frame.rows;
        let gpu = self.rasterizer.gpu;
        self.buffers.lists(gpu, pixels, self.frame.capacity)
    }

    /// Sets up what follows the lists, of which the longest has `longest` nodes for
    /// certain: each number of layers from the lists as they are, where that is possible;
    /// each below that length from the sorted ones; and all.
    ///
    /// # Errors
    /// WGSL errors; what the device refuses.
    pub fn follow(&mut self, longest: u32, layers: &[u32]) -> Result<(), GpuError> {
        self.parts.truncate(self.built);
        for n in layers.iter().filter(|n| can_keep(**n, longest)) {
            let pass = self.pass(&file(*n), "nearest_layers")?;
            self.parts.push((Part::Nearest(*n), vec![pass]));
        }
        let sort = self.until_done("sort", longest)?;
        self.parts.push((Part::Sort, sort));
        for n in layers
            .iter()
            .filter(|n| **n < longest && u64::from(**n) <= STEPS)
        {
            let pass = self.pass(&file(*n), "nearest_layers_sorted")?;
            self.parts.push((Part::NearestSorted(*n), vec![pass]));
        }
        let resolve = self.until_done("resolve", longest)?;
        self.parts.push((Part::Resolve, resolve));
        Ok(())
    }

    fn pass(&self, file: &str, stage: &str) -> Result<Ready, GpuError> {
        let buffers = self.buffers.named();
        self.rasterizer
            .ready_per_pixel(file, stage, self.frame, &buffers)
    }

    /// As many dispatches of a stage as lists of that length may take; those that come
    /// after the last do nothing.
    fn until_done(&self, stage: &str, longest: u32) -> Result<Vec<Ready>, GpuError> {
        let mut passes = vec![self.pass(FILE, "clear_progress")?];
        for _ in 0..dispatches(longest) {
            passes.push(self.pass("abuffer", stage)?);
        }
        Ok(passes)
    }

    /// The parts, in the order in which they run.
    pub fn parts(&self) -> impl Iterator<Item = Part> {
        self.parts.iter().map(|(part, _)| *part)
    }

    fn run(&self, part: usize) -> Result<(), GpuError> {
        let mut encoder = self.rasterizer.gpu.encoder();
        for pass in &self.parts[part].1 {
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
        let pixels = (self.frame.width * self.frame.rows) as usize;
        for (at, part) in self.parts().enumerate() {
            self.run(at)?;
            if part.draws() {
                let gpu = self.rasterizer.gpu;
                let picture: Vec<[f32; 4]> = gpu.read(&self.buffers.picture, pixels)?;
                show(
                    part,
                    picture.iter().map(|[r, g, b, _]| [*r, *g, *b]).collect(),
                );
            }
        }
        Ok(())
    }

    /// Runs every part once, and gives the seconds of each. Parts that may come in any
    /// order change places from round to round, so that none is always first.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn time(&self, timer: &Timer, round: u32) -> Result<Vec<f64>, GpuError> {
        let gpu = self.rasterizer.gpu;
        let order = self.order(round);
        timer.time(gpu, order.into_iter(), |span, encoder, queries| {
            let passes = &self.parts[span as usize].1;
            for (at, pass) in passes.iter().enumerate() {
                let writes = queries.and_then(|q| q.writes(span, at, passes.len()));
                pass.record(self.rasterizer, encoder, writes);
            }
        })
    }

    /// The parts by their numbers: neighbours of one kind rotate.
    fn order(&self, round: u32) -> Vec<u32> {
        let mut order: Vec<u32> = (0..).zip(&self.parts).map(|(at, _)| at).collect();
        let kind = |at: &u32| std::mem::discriminant(&self.parts[*at as usize].0);
        for same in order.chunk_by_mut(|a, b| kind(a) == kind(b)) {
            let by = round as usize % same.len();
            same.rotate_left(by);
        }
        order
    }
}
