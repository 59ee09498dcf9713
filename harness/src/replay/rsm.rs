//! A scene of indirect light with indirect shadows: the family `rsm`.

mod embree;
mod facts;
mod gpu;
mod kernel;
mod limits;
mod pictures;
mod setup;
mod shared;
mod spec;
#[cfg(test)]
mod tests;
mod told;

use std::collections::BTreeSet;

use triptych_gpu::raster::Path;

use super::gpu::Adapter;
use super::lanes::Task;
use super::run::Run;
use super::stop::Stop;
use crate::cache::Uses;
use crate::compare::{Judgement, compare};
use crate::dump::FrameArrays;
use crate::embree::EmbreeError;
use crate::observe::{Embree, Observed};
use crate::plan::RsmPlan;
use crate::row::Class;
use embree::{Seen, ask, rmse};
pub use embree::{reference, values};
pub use gpu::RsmLeg;
pub(super) use gpu::rounded;
pub use setup::{Parts, Setup};
pub use spec::{RsmFrame, RsmRun, Times};

impl Run<'_> {
    /// The spec by itself, Embree, then every adapter.
    pub(super) fn rsm(&mut self) -> Result<(), Stop> {
        self.unit(Uses::Nothing, &["rsm", "spec"], |run| {
            let spec = run.rsm_spec()?;
            run.facts = Some(facts::of(run.loaded, &spec.value, run.options.skip));
            if run.options.pictures {
                run.pictures.extend(pictures::spec(&spec.value));
            }
            run.dump_rsm_spec(&spec).map_err(Stop::Dump)
        })?;
        let mut tasks = Vec::new();
        if self.options.embree {
            tasks.push(Task::apart(|run| {
                run.unit(Uses::Embree, &["rsm", "embree"], Self::rsm_vote)
            }));
        }
        if self.options.gpu {
            tasks.extend(self.on_adapters(Self::rsm_leg));
        }
        self.side_by_side(tasks)
    }

    fn rsm_leg(&mut self, adapter: &Adapter, path: Path) -> Result<(), Stop> {
        let label = adapter.label(path);
        let why = "works on pixels and texels that know their triangle";
        if self.skips_path(adapter, path, why) {
            return Ok(());
        }
        let plan = RsmPlan::new(self.loaded, self.options.skip);
        let spec = self.rsm_spec()?;
        let leg = RsmLeg::new(adapter, path, &spec, &plan.passes);
        let first = self.rows.spots.len();
        match leg.run(&mut self.rows) {
            Ok(made) => {
                let frames = &spec.value.frames;
                let models = frames.iter().map(|frame| &frame.parts.model);
                self.dump_frames(&label, &spec.value, models.zip(&made))
                    .map_err(Stop::Dump)?;
                self.rsm_keep(&label, &spec.value, &made, first);
            }
            Err(error) => self.leg_refused(&label, &error),
        }
        Ok(())
    }

    /// Keeps a leg's pictures for the report. Spots from `first` on are its own.
    fn rsm_keep(&mut self, label: &str, run: &RsmRun, made: &[FrameArrays], first: usize) {
        let pixels: BTreeSet<u32> = self.rows.spots[first..].iter().map(|s| s.pixel).collect();
        for (frame, made) in run.frames.iter().zip(made) {
            self.errors
                .note(&pixels, &frame.frame.picture, &made.picture);
        }
        if self.options.pictures {
            self.pictures.extend(pictures::gpu(run, label, made));
        }
    }

    /// Embree's vote on the rays of stage `block`, and its pictures.
    fn rsm_vote(&mut self) -> Result<(), Stop> {
        let plan = RsmPlan::new(self.loaded, self.options.skip);
        if let Some(reason) = plan.skipped("block") {
            let rows = &mut self.rows;
            rows.skip("block", "spec", "embree", Class::Vote, reason);
            return Ok(());
        }
        let spec = self.rsm_spec()?;
        let run = &spec.value;
        let seen: Result<Vec<Seen>, EmbreeError> =
            run.frames.iter().map(|frame| ask(run, frame)).collect();
        let seen = match seen {
            Ok(seen) => Observed::<Embree, _>::new("embree", seen),
            Err(error) => {
                let words = error.to_string();
                self.rows.fail("block", "spec", "embree", None, words);
                return Ok(());
            }
        };
        // A bare mesh has no [rsm], so there is always a budget.
        let budget = self.loaded.file.budget.edge();
        let judgement = compare(&spec, &seen, |run, seen| judge(run, seen, budget));
        let times = spec.map(|_| ()).taking(run.time(|times| times.block));
        let taken = seen.value.iter().map(|seen| seen.time).sum();
        self.rows
            .add("block", &times, &seen.map(|_| ()).taking(taken), judgement);
        if self.options.pictures {
            self.pictures.extend(pictures::embree(run, &seen.value));
        }
        Ok(())
    }
}

/// The votes of all frames as one, with what their pictures are off by.
fn judge(run: &RsmRun, seen: &[Seen], budget: f64) -> Judgement {
    let mut total = crate::compare::embree::RayVote::default();
    for frame in seen {
        total.add(frame.vote.clone());
    }
    let judgement = total.judgement(Some(budget));
    let off = run.frames.iter().zip(seen).map(|(frame, seen)| {
        let own = rmse(&values(&frame.frame.picture), &seen.reference);
        let embree = rmse(&seen.picture, &seen.reference);
        format!("{own:.2e} and {embree:.2e}")
    });
    let off = off.collect::<Vec<_>>().join("; ");
    let note = format!(
        "{}; RMSE against the reference, of the spec and with Embree's rays: {off}",
        judgement.note
    );
    Judgement { note, ..judgement }
}
