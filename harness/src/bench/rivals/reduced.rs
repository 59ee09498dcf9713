//! Fragments at a reduced resolution: lists there are compared as well as the picture that they make.

use triptych_gpu::abuffer::rivals::Reduced;
use triptych_gpu::abuffer::{NODE, Options};
use triptych_gpu::error::GpuError;
use triptych_gpu::raster::{Path, Rasterizer};
use triptych_gpu::timer::Timer;
use triptych_spec::abuffer::{self, Reduction, Upsampling};
use triptych_spec::bound::Bounded;

use super::{Given, Made, Runs};
use crate::bench::Method;
use crate::bench::counts::Counts;
use crate::bench::gpu::Refusal;
use crate::bench::pieces::in_order;
use crate::compare::lists::certify;
use crate::observe::Observed;
use crate::replay::spec::SpecRun;

/// Where a scene states no falloff: a neighbour counts half as much if its surface is a 64th of the depth
/// range away.
const FALLOFF: f32 = 64.0;

/// A resolution that is set up.
struct Low<'r> {
    frame: Reduced<'r, 'r>,
    /// Bytes of its triangles.
    triangles: u64,
}

impl Runs for Low<'_> {
    fn picture(&self) -> Result<Vec<[f32; 3]>, GpuError> {
        self.frame.picture()
    }

    fn parts(&self) -> Vec<&'static str> {
        vec!["build", "sort", "blend"]
    }

    fn time(&self, timer: &Timer) -> Result<Vec<f64>, GpuError> {
        self.frame.time(timer)
    }

    fn bytes(&self) -> u64 {
        self.frame.bytes() + self.triangles
    }

    fn of_fragment(&self) -> Option<u64> {
        Some(NODE)
    }
}

impl<'r> Given<'r> {
    /// Sets up a resolution that is halved so often, whose lists must be the spec's.
    pub(super) fn reduced(&self, method: Method, halvings: u32) -> Result<Made<'r>, Refusal> {
        if self.rasterizer.path == Path::Fragment {
            let words = "hardware has no grid as fine as that of the reduced pixels";
            return Err(Refusal::Skipped(words.to_owned()));
        }
        let each = (self.run.faces.len() + self.run.sorted.fragments.len()) as u64;
        self.has_time(each, || {
            format!("goes through {each} triangles and fragments")
        })?;
        let stated = self.plan.asked.reduced;
        let reduction = Reduction {
            halvings,
            falloff: stated.map_or(FALLOFF, |stated| stated.falloff),
        };
        let primitives = reduction.primitives(&self.run.primitives);
        let few = SpecRun::new(self.scene, primitives, self.plan).map_err(Refusal::Skipped)?;
        let counts = Counts::of(&few);
        if counts.longest() == 0 {
            let words = format!(
                "no fragment is seen at 1 of {} pixels a side",
                reduction.side()
            );
            return Err(Refusal::Skipped(words));
        }
        let low = Low {
            frame: self.frame(reduction, &few, counts.longest())?,
            triangles: counts.triangles(),
        };
        self.judge(method, &few, &low)?;
        let work = counts.reduced(&self.grid.counts);
        Ok(Made {
            run: Box::new(low),
            layers: counts.longest(),
            must: Observed::new("spec", self.must(reduction, few)),
            work,
        })
    }

    fn frame(
        &self,
        reduction: Reduction,
        few: &SpecRun,
        longest: u32,
    ) -> Result<Reduced<'r, 'r>, Refusal> {
        let Rasterizer {
            gpu, kernels, path, ..
        } = *self.rasterizer;
        let low = Rasterizer::new(gpu, kernels, path, &few.primitives, &few.faces)?;
        let nodes = u32::try_from(few.sorted.fragments.len()).expect("a replay's are words");
        let options = Options {
            capacity: Some(nodes),
            ..self.plan.abuffer(self.scene)
        };
        let is_opaque = |prim| few.is_opaque(prim);
        let how = (reduction, longest);
        let surfaces = self.surfaces()?;
        let frame = Reduced::new(self.rasterizer, low, &surfaces, options, how, is_opaque)?;
        Ok(frame)
    }

    /// Whether the lists are sound, all there, and in the spec's order.
    fn judge(&self, method: Method, few: &SpecRun, low: &Low<'_>) -> Result<(), Refusal> {
        let lists = low.frame.lists()?;
        let what = format!("{}, {}, sorted lists", self.label, method.name());
        let (seen, must) = (u64::from(lists.attempts), few.sorted.fragments.len() as u64);
        if seen != must || !certify(&lists).is_sound() {
            let words = format!("{what}: {seen} fragments, must be {must} in sound lists");
            return Err(Refusal::Wrong(words));
        }
        in_order(&what, (&few.sorted, few.primitives.size.width), &lists)
    }

    /// What the spec makes of the reduced target's lists.
    fn must(&self, reduction: Reduction, few: SpecRun) -> Vec<[Bounded; 3]> {
        let SpecRun {
            primitives,
            opaque,
            sorted,
            ..
        } = few;
        let lists = abuffer::Reduced {
            primitives,
            opaque,
            sorted,
        };
        let (full, how) = (self.run, (reduction, Upsampling::Joint));
        abuffer::reduced(self.scene, &full.primitives, &full.opaque, &lists, how)
    }
}

#[cfg(test)]
mod tests;
