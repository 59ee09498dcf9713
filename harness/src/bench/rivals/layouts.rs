//! The same lists laid out otherwise: their order is compared as well as their picture, and building
//! them is timed apart from what is made of them.

use triptych_gpu::error::GpuError;
use triptych_gpu::frame::Band;
use triptych_gpu::layouts::{Layout, Options, Span, Timed, is_wide, memory};
use triptych_gpu::timer::Timer;
use triptych_spec::abuffer::{Lists, resolve};
use triptych_spec::layouts::packed;

use super::{Given, Made, Runs};
use crate::bench::gpu::Refusal;
use crate::compare::lists::certify;
use crate::observe::Observed;
use crate::replay::layouts::{slots, steps, too_many_steps};

/// A layout that is set up.
struct LaidOut<'r> {
    timed: Timed<'r, 'r>,
    layout: Layout,
}

impl Runs for LaidOut<'_> {
    fn picture(&self) -> Result<Vec<[f32; 3]>, GpuError> {
        self.timed.picture()
    }

    fn parts(&self) -> Vec<&'static str> {
        self.timed.spans().map(name).collect()
    }

    fn time(&self, timer: &Timer) -> Result<Vec<f64>, GpuError> {
        self.timed.time(timer)
    }

    fn bytes(&self) -> u64 {
        self.timed.bytes()
    }

    fn of_fragment(&self) -> Option<u64> {
        Some(memory::of_fragment(self.layout, self.timed.longest))
    }
}

/// A part's name in results.
fn name(span: Span) -> &'static str {
    match span {
        Span::Clear => "clear",
        Span::Build => "build",
        Span::Rank => "sort",
        Span::Blend => "blend",
        Span::Nearest(_) => "nearest",
    }
}

impl<'r> Given<'r> {
    /// Sets a layout up, whose lists must be the spec's.
    pub(super) fn laid_out(&self, layout: Layout) -> Result<Made<'r>, Refusal> {
        self.can_lay_out(layout)?;
        let (run, grid) = (self.run, self.grid);
        let options = Options {
            opaque: &run.opaque,
            depth_test: self.plan.depth_test,
            background: self.scene.background,
            capacity: None,
            arrays: None,
            nearest: &[],
        };
        let inspect = |lists: &Lists| {
            let certificate = certify(lists);
            certificate.longest().filter(|_| certificate.is_sound())
        };
        let is_opaque = |prim| grid.is_opaque(prim);
        let timed = Timed::new(self.rasterizer, layout, options, is_opaque, inspect);
        let what = format!("{}, {}", self.label, layout.name());
        let timed = timed.map_err(|error| match error {
            GpuError::Endless { .. } => Refusal::Wrong(format!("{what}: damaged lists")),
            other => other.into(),
        })?;
        let (seen, must) = (u64::from(timed.fragments), grid.fragments());
        if seen != must {
            let words = format!("{what}: {seen} fragments are counted, must be {must}");
            return Err(Refusal::Wrong(words));
        }
        let (lists, _) = timed.frame()?;
        grid.sorted(&what, Band::whole(self.rasterizer.size), lists)?;
        let draw = match layout {
            Layout::Packed => packed,
            _ => resolve,
        };
        let must = draw(self.scene, &run.primitives, &run.opaque, &run.sorted);
        Ok(Made {
            run: Box::new(LaidOut { timed, layout }),
            must: Observed::new("spec", must),
            layers: grid.counts.longest(),
            work: grid.counts.laid_out(layout, is_wide(self.rasterizer)),
        })
    }

    /// Refuses what cannot be, and what takes a software driver too long.
    fn can_lay_out(&self, layout: Layout) -> Result<(), Refusal> {
        let (run, sorted) = (self.run, &self.run.sorted);
        let each = (run.faces.len() + sorted.fragments.len()) as u64;
        let twice = format!("goes through {each} triangles and fragments twice");
        match layout {
            Layout::Ordered => {
                if let Some(words) = too_many_steps(run, self.rasterizer.path) {
                    return Err(Refusal::Skipped(words));
                }
                let steps = steps(sorted);
                self.has_time(steps, || format!("takes {steps} steps along lists"))
            }
            Layout::Bucket => {
                let slots = slots(sorted);
                self.has_time(slots, || format!("has {slots} places in arrays"))
            }
            Layout::Precalc | Layout::Packed | Layout::Regions => {
                self.has_time(2 * each, || twice.clone())
            }
        }
    }
}

#[cfg(test)]
mod tests;
