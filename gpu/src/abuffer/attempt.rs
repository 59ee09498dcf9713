//! One attempt at one band: passes and results.

use std::time::Duration;

use triptych_spec::abuffer::{Lists, Opaque, Order};

use super::buffers::Buffers;
use super::{BandResult, Options, Times};
use crate::context::Gpu;
use crate::error::GpuError;
use crate::frame::{Band, Frame};
use crate::lists::until_done;
use crate::raster::{Rasterizer, per_pixel};

/// Steps along a list within one dispatch. Twin: `STEPS` in `abuffer.wgsl`.
pub const STEPS: u64 = 16_384;

/// One attempt at one band.
pub(super) struct Run<'r, 'g> {
    pub(super) rasterizer: &'r Rasterizer<'g>,
    pub(super) options: Options<'r>,
    pub(super) band: Band,
    pub(super) capacity: u32,
    pub(super) times: Times,
}

/// What came of an attempt.
pub(super) enum Tried {
    /// Everything fitted.
    Done(Box<Done>),
    /// There was not enough room; this was stored.
    Overflowed(Lists),
}

/// A band that is done.
pub(super) struct Done {
    pub(super) opaque: Opaque,
    pub(super) band: BandResult,
    /// Empty where the lists were not followed to their ends.
    pub(super) image: Vec<[f32; 3]>,
    pub(super) times: Times,
    /// The lists were found damaged.
    pub(super) damaged: bool,
    /// The stage that followed a list without coming to its end.
    pub(super) endless: Option<&'static str>,
}

impl Run<'_, '_> {
    /// Runs every stage; `inspect` gives the length of the longest list, or `None` if
    /// they must not be followed. With `follow` false they are not, anyway.
    pub(super) fn attempt(
        mut self,
        is_opaque: &impl Fn(u32) -> bool,
        inspect: impl FnOnce(&Lists) -> Option<u32>,
        follow: bool,
    ) -> Result<Tried, GpuError> {
        let buffers = self.buffers()?;
        self.fill(&buffers, is_opaque)?;
        let built = self.lists(&buffers)?;
        if built.attempts > self.capacity {
            return Ok(Tried::Overflowed(built));
        }
        let opaque = Opaque {
            key: self.read(&buffers.opaque_key)?,
            prim: self.read(&buffers.opaque_prim)?,
        };
        let longest = inspect(&built);
        let finished = match longest.filter(|_| follow) {
            Some(longest) => self.finish(&buffers, longest).map(Some),
            None => Ok(None),
        };
        let (finished, endless) = match finished {
            Err(GpuError::Endless { stage, .. }) => (None, Some(stage)),
            finished => (finished?, None),
        };
        let (sorted, image) = finished.unzip();
        Ok(Tried::Done(Box::new(Done {
            opaque,
            image: image.unwrap_or_default(),
            times: self.times,
            damaged: longest.is_none(),
            endless,
            band: BandResult {
                band: self.band,
                built,
                sorted,
            },
        })))
    }

    fn gpu(&self) -> &Gpu {
        self.rasterizer.gpu
    }

    fn pixels(&self) -> u32 {
        self.band.pixels(self.rasterizer.size)
    }

    /// Samples of a pixel.
    fn samples(&self) -> u32 {
        self.rasterizer.samples.count()
    }

    fn buffers(&self) -> Result<Buffers, GpuError> {
        let fault = self.rasterizer.kernels.fault();
        let Some(given) = self.options.given else {
            let pixels = [self.pixels(), self.samples()];
            return Buffers::sampled(self.gpu(), pixels, self.capacity, fault);
        };
        let first = (self.band.first * self.rasterizer.size.width) as usize;
        let pixels = first..first + self.pixels() as usize;
        let pixels = (pixels, self.samples());
        Buffers::given(self.gpu(), given, pixels, self.capacity, fault)
    }

    pub(super) fn frame(&self) -> Frame {
        let [r, g, b] = self.options.background;
        Frame {
            capacity: self.capacity,
            depth_test: u32::from(self.options.depth_test),
            order: u32::from(self.options.order == Order::Sample),
            once: u32::from(self.options.once),
            background: [r, g, b, 1.0],
            ..self.rasterizer.frame(self.band)
        }
    }

    fn opaque(&mut self, b: &Buffers, is_opaque: &impl Fn(u32) -> bool) -> Result<(), GpuError> {
        let work = self.rasterizer.work(self.band, is_opaque)?;
        for stage in ["opaque_nearest", "opaque_first"] {
            let buffers = b.named();
            self.times.opaque +=
                self.rasterizer
                    .draw("abuffer", stage, self.frame(), &work, &buffers)?;
        }
        Ok(())
    }

    fn build(&mut self, b: &Buffers, is_opaque: &impl Fn(u32) -> bool) -> Result<(), GpuError> {
        let work = self.rasterizer.work(self.band, |prim| !is_opaque(prim))?;
        let buffers = b.named();
        let passes = self.rasterizer.ready_build(self.frame(), &work, &buffers)?;
        self.times.build = self.rasterizer.run(&passes)?;
        Ok(())
    }

    /// Runs the passes that fill the buffers, but for those that hold another leg's
    /// results.
    fn fill(&mut self, b: &Buffers, is_opaque: &impl Fn(u32) -> bool) -> Result<(), GpuError> {
        let given = self.options.given;
        if self.options.opaque && given.is_none() {
            self.opaque(b, is_opaque)?;
        }
        if self.options.lists && given.is_none_or(|given| given.lists.is_none()) {
            self.build(b, is_opaque)?;
        }
        Ok(())
    }

    /// Sorts and resolves lists of at most `longest` nodes; gives the sorted lists and
    /// the picture.
    fn finish(&mut self, b: &Buffers, longest: u32) -> Result<(Lists, Vec<[f32; 3]>), GpuError> {
        if self.options.lists && !self.options.given.is_some_and(|g| g.sorted) {
            self.times.sort = self.until_done(("abuffer", "sort"), self.frame(), longest, b)?;
        }
        // Samples by their true depth change the nodes' keys and order.
        let lists = self.lists(b)?;
        self.times.resolve = match self.samples() {
            1 => self.until_done(("abuffer", "resolve"), self.frame(), longest, b)?,
            _ => self.resolve_samples(longest, b)?,
        };
        let stride = self.samples() as usize;
        let picture = self
            .gpu()
            .read::<[f32; 4]>(&b.picture, self.pixels() as usize * stride)?;
        let image = picture.into_iter().step_by(stride);
        let image = image.map(|[r, g, b, _]| [r, g, b]).collect();
        Ok((lists, image))
    }

    /// Dispatches a stage until no pixel asks for more; what needs more than
    /// [`dispatches`] follows a list that does not end.
    pub(super) fn until_done(
        &self,
        (file, stage): (&str, &'static str),
        frame: Frame,
        longest: u32,
        b: &Buffers,
    ) -> Result<Duration, GpuError> {
        until_done(
            self.gpu(),
            &b.progress,
            (stage, dispatches(longest)),
            || per_pixel(self.rasterizer, file, stage, frame, &b.named()),
        )
    }

    fn lists(&self, b: &Buffers) -> Result<Lists, GpuError> {
        b.lists(self.gpu(), self.pixels(), self.capacity)
    }

    /// One word per sample of the band.
    fn read(&self, buffer: &wgpu::Buffer) -> Result<Vec<u32>, GpuError> {
        self.gpu()
            .read(buffer, self.pixels() as usize * self.samples() as usize)
    }
}

/// The most dispatches that sort and resolve take for lists of at most `longest` nodes:
/// merging a list of n nodes takes at most 4 n steps in each of at most log2(n) + 1
/// passes.
pub(crate) fn dispatches(longest: u32) -> u64 {
    let passes = u64::from(longest.max(1).ilog2()) + 1;
    4 * u64::from(longest) * passes / STEPS + 1
}
