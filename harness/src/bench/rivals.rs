//! Techniques that are measured beside the layers of lists, each over a whole target.
//!
//! Another one is a line of [`ALL`], and a function that sets it up.

mod layouts;
mod reduced;

use triptych_gpu::abuffer::rivals::{Once, Peeling, Single, Surfaces, Technique};
use triptych_gpu::error::GpuError;
use triptych_gpu::frame::Band;
use triptych_gpu::layouts::Layout;
use triptych_gpu::raster::{Path, Rasterizer};
use triptych_gpu::timer::{Clock, Timer};
use triptych_spec::abuffer::{LAYERS_MAX, Target, halves, resolve};
use triptych_spec::scene::Scene;

use super::error::Error;
use super::gpu::Refusal;
use super::reference::{Grid, Picture};
use super::scene::Measured;
use super::{Method, counts::Work};
use crate::observe::Observed;
use crate::plan::Plan;
use crate::replay::spec::SpecRun;

/// What one technique is, and how it is set up.
pub(super) struct Kind {
    pub(super) method: Method,
    new: for<'r> fn(&Given<'r>) -> Result<Made<'r>, Refusal>,
}

/// All of them, in the order of tables.
pub(super) const ALL: &[Kind] = &[
    kind(Method::Peel, peel),
    kind(Method::Dual, dual),
    kind(Method::Alpha, alpha),
    kind(Method::Weighted, weighted),
    kind(Method::Half, |given| given.reduced(Method::Half, 1)),
    kind(Method::Quarter, |given| given.reduced(Method::Quarter, 2)),
    kind(Method::Packed, |given| given.laid_out(Layout::Packed)),
    kind(Method::Regions, |given| given.laid_out(Layout::Regions)),
    kind(Method::Ordered, |given| given.laid_out(Layout::Ordered)),
    kind(Method::Precalc, |given| given.laid_out(Layout::Precalc)),
    kind(Method::Bucket, |given| given.laid_out(Layout::Bucket)),
];

const fn kind(method: Method, new: for<'r> fn(&Given<'r>) -> Result<Made<'r>, Refusal>) -> Kind {
    Kind { method, new }
}

/// What a technique is set up from.
pub(super) struct Given<'r> {
    /// The leg's name.
    pub(super) label: &'r str,
    pub(super) rasterizer: &'r Rasterizer<'r>,
    pub(super) grid: &'r Grid,
    pub(super) scene: &'r Scene,
    /// The spec of the whole target.
    pub(super) run: &'r SpecRun,
    pub(super) plan: &'r Plan,
    /// Whatever it takes.
    pub(super) all: bool,
}

/// Triangles and fragments, times how often they are gone through, up to which a software driver
/// does it unless it is asked to: half a minute of one.
const SOFTWARE: u64 = 1 << 26;

/// A technique that is set up, and what it must draw.
struct Made<'r> {
    run: Box<dyn Runs + 'r>,
    must: Picture,
    layers: u32,
    work: Work,
}

/// What all of them do.
trait Runs {
    /// Runs it once, and gives the picture.
    fn picture(&self) -> Result<Vec<[f32; 3]>, GpuError>;
    /// What its parts are called, each a span of a timer.
    fn parts(&self) -> Vec<&'static str> {
        vec!["blend"]
    }
    /// Seconds of each part of a run.
    fn time(&self, timer: &Timer) -> Result<Vec<f64>, GpuError>;
    /// Bytes of its own buffers.
    fn bytes(&self) -> u64;
    /// Bytes of a stored fragment, if it stores any.
    fn of_fragment(&self) -> Option<u64> {
        None
    }
}

struct Peeled<'r>(Peeling<'r, 'r>, u32);

impl Runs for Peeled<'_> {
    fn picture(&self) -> Result<Vec<[f32; 3]>, GpuError> {
        self.0.run(self.1)
    }

    fn time(&self, timer: &Timer) -> Result<Vec<f64>, GpuError> {
        Ok(vec![self.0.time(timer, self.1)?])
    }

    fn bytes(&self) -> u64 {
        self.0.bytes()
    }
}

impl Runs for Once<'_, '_> {
    fn picture(&self) -> Result<Vec<[f32; 3]>, GpuError> {
        self.run()
    }

    fn time(&self, timer: &Timer) -> Result<Vec<f64>, GpuError> {
        Ok(vec![self.time(timer)?])
    }

    fn bytes(&self) -> u64 {
        self.bytes()
    }
}

impl<'r> Given<'r> {
    fn surfaces(&self) -> Result<Surfaces, GpuError> {
        let band = Band::whole(self.rasterizer.size);
        Surfaces::upload(self.rasterizer, &self.run.opaque, band)
    }

    /// Refuses what takes a software driver too long, and was not asked for.
    fn has_time(&self, work: u64, what: impl Fn() -> String) -> Result<(), Refusal> {
        let software = self.rasterizer.gpu.info.device_type == wgpu::DeviceType::Cpu;
        if !software || self.all || work <= SOFTWARE {
            return Ok(());
        }
        let what = what();
        let words = format!("{what}: on a software driver only if asked for, by --rivals");
        Err(Refusal::Skipped(words))
    }

    /// Peels so many times, for a picture that must be this one.
    fn peels(&self, technique: Technique, times: u32, must: Picture) -> Result<Made<'r>, Refusal> {
        let each = (self.grid.faces.len() as u64) + self.grid.fragments();
        if times > LAYERS_MAX {
            let words = format!("{times} layers, more than {LAYERS_MAX}");
            return Err(Refusal::Skipped(words));
        }
        self.has_time(u64::from(times) * each, || {
            format!("goes through {each} triangles and fragments {times} times")
        })?;
        let surfaces = self.surfaces()?;
        let at = (Band::whole(self.rasterizer.size), self.scene.background);
        let grid = self.grid;
        let is_opaque = |prim| grid.is_opaque(prim);
        let peeling = Peeling::new(self.rasterizer, technique, &surfaces, at, is_opaque)?;
        Ok(Made {
            run: Box::new(Peeled(peeling, times)),
            must,
            layers: grid.counts.longest(),
            work: grid.counts.gone_through(times),
        })
    }

    fn once(&self, single: Single, must: Picture) -> Result<Made<'r>, Refusal> {
        let surfaces = self.surfaces()?;
        let at = (Band::whole(self.rasterizer.size), self.scene.background);
        let grid = self.grid;
        let is_opaque = |prim| grid.is_opaque(prim);
        let once = Once::new(self.rasterizer, single, &surfaces, at, is_opaque)?;
        Ok(Made {
            run: Box::new(once),
            must,
            layers: grid.counts.longest(),
            work: grid.counts.gone_through(1),
        })
    }
}

fn peel<'r>(given: &Given<'r>) -> Result<Made<'r>, Refusal> {
    let (scene, run) = (given.scene, given.run);
    let must = resolve(scene, &run.primitives, &run.opaque, &run.sorted);
    let layers = run.layers();
    given.peels(Technique::Peel, layers, Observed::new("spec", must))
}

fn dual<'r>(given: &Given<'r>) -> Result<Made<'r>, Refusal> {
    let (scene, run) = (given.scene, given.run);
    let must = halves(scene, &run.primitives, &run.opaque, &run.sorted);
    // Two layers a time.
    let times = run.layers().div_ceil(2);
    given.peels(Technique::Dual, times, Observed::new("spec", must))
}

fn alpha<'r>(given: &Given<'r>) -> Result<Made<'r>, Refusal> {
    if given.rasterizer.path != Path::Fragment {
        let words = "only the hardware blends in the order of the triangles";
        return Err(Refusal::Skipped(words.to_owned()));
    }
    let half = !given.rasterizer.gpu.blends_floats();
    let target = if half { Target::Half } else { Target::Single };
    let must = given.run.rivals.alpha(target, given.scene, given.run);
    let must = Observed::new("spec", must.image.clone());
    given.once(Single::Alpha { half }, must)
}

fn weighted<'r>(given: &Given<'r>) -> Result<Made<'r>, Refusal> {
    let gpu = given.rasterizer.gpu;
    if given.rasterizer.path == Path::Fragment && !gpu.blends_floats() {
        let words = "the adapter blends no 32-bit floats: compute adds them";
        return Err(Refusal::Skipped(words.to_owned()));
    }
    let must = given.run.rivals.weighted(given.scene, given.run);
    let must = Observed::new("spec", must.image.clone());
    given.once(Single::Weighted, must)
}

/// A technique of a leg, whose picture was right.
pub(super) struct Beside<'r> {
    pub(super) method: Method,
    made: Made<'r>,
    grid: &'r Grid,
    timer: Timer,
    error: Error,
    /// Seconds of each part, round by round.
    rounds: Vec<Vec<f64>>,
}

impl<'r> Beside<'r> {
    /// Sets one up, and compares its picture.
    pub(super) fn new(kind: &Kind, given: &Given<'r>, clock: &Clock) -> Result<Self, Refusal> {
        let made = (kind.new)(given)?;
        let parts = u32::try_from(made.run.parts().len()).expect("a few parts");
        let mut beside = Self {
            method: kind.method,
            made,
            grid: given.grid,
            timer: Timer::new(given.rasterizer.gpu, clock, parts)?,
            error: given.grid.error_of_spec(0),
            rounds: Vec::new(),
        };
        beside.error = beside.compare(given.label)?;
        Ok(beside)
    }

    /// Compares its picture.
    pub(super) fn compare(&self, label: &str) -> Result<Error, Refusal> {
        let picture = self.made.run.picture()?;
        let what = format!("{label}, {}", self.method.name());
        let whole = Band::whole(self.grid.primitives.size);
        let wrong = self.grid.unlike(&what, &self.made.must, &picture, whole);
        match wrong {
            Some(words) => Err(Refusal::Wrong(words)),
            None => Ok(self.grid.error(&picture)),
        }
    }

    /// Runs it once.
    pub(super) fn time(&self) -> Result<Vec<f64>, Refusal> {
        Ok(self.made.run.time(&self.timer)?)
    }

    /// Runs it once, and keeps the time.
    pub(super) fn round(&mut self) -> Result<(), Refusal> {
        let seconds = self.time()?;
        self.rounds.push(seconds);
        Ok(())
    }

    /// The frame that was measured; `before` is what comes before it.
    pub(super) fn measured(&self, before: &Measured) -> Measured {
        let mut parts = before.parts.clone();
        let own = self.made.run.parts().into_iter().enumerate();
        let seconds = |at: usize| self.rounds.iter().map(|r| r[at]).collect();
        parts.extend(own.map(|(at, name)| (name, seconds(at))));
        Measured {
            method: self.method,
            layers: self.made.layers,
            parts,
            error: self.error,
            memory: self.grid.counts.triangles() + self.made.run.bytes() + before.memory,
            of_fragment: self.made.run.of_fragment(),
            bands: 1,
            work: self.made.work.and(before.work),
        }
    }
}

#[cfg(test)]
mod tests;
