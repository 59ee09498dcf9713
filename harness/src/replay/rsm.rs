//! A scene of indirect light with indirect shadows: the family `rsm`.

mod embree;
mod facts;
mod kernel;
mod pictures;
mod setup;
mod spec;

use std::rc::Rc;

use super::run::{Run, Stop};
use crate::cache::Uses;
use crate::compare::{Judgement, compare};
use crate::embree::EmbreeError;
use crate::observe::{Embree, Observed, Spec};
use crate::plan::RsmPlan;
use crate::row::Class;
use embree::{Seen, ask, rmse, values};
pub use setup::{Parts, Setup};
pub use spec::{RsmFrame, RsmRun, Times, WORK_MAX};

impl<'a> Run<'a> {
    /// The spec by itself, Embree, then every adapter.
    pub(super) fn rsm(&mut self) -> Result<(), Stop> {
        self.unit(Uses::Nothing, &["rsm", "spec"], |run| {
            let spec = run.rsm_spec()?;
            run.facts = Some(facts::of(run.loaded, &spec.value, run.options.skip));
            if run.options.pictures {
                run.pictures.extend(pictures::spec(&spec.value));
            }
            Ok(())
        })?;
        match self.options.embree {
            true => self.unit(Uses::Embree, &["rsm", "embree"], Self::rsm_vote),
            false => Ok(()),
        }
    }

    /// The spec's results, computed when first asked for.
    fn rsm_spec(&mut self) -> Result<Rc<Observed<Spec, RsmRun<'a>>>, Stop> {
        if let Some(spec) = &self.rsm {
            return Ok(spec.clone());
        }
        let run = RsmRun::new(self.loaded, self.options.skip).map_err(Stop::Input)?;
        let spec = Rc::new(Observed::new("spec", run));
        self.rsm = Some(spec.clone());
        Ok(spec)
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
        let budget = self.loaded.file.budget.edge.0;
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
fn judge(run: &RsmRun<'_>, seen: &[Seen], budget: f64) -> Judgement {
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
