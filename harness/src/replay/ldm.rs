//! A scene of layered depth maps: the family `ldm`.

mod cloud;
mod embree;
mod facts;
mod gpu;
pub mod limits;
mod pictures;
mod setup;
mod spec;
mod tally;
#[cfg(test)]
mod tests;
mod turned;

use std::time::Instant;

use triptych_gpu::raster::Path;

use super::gpu::Adapter;
use super::lanes::Task;
use super::run::Run;
use super::stop::Stop;
use crate::cache::Uses;
use crate::compare::{Judgement, compare};
use crate::observe::{Embree, Observed};
use crate::plan::LdmPlan;
use crate::row::Class;
pub use embree::{Off, SAMPLES, Seen, ask, passes, random, same};
pub(crate) use gpu::chains;
pub use gpu::{LdmLeg, Made};
pub use setup::{Asker, Setup, Turn, bounds};
pub use spec::{LdmRun, LdmTurn, Times};
pub use tally::Tally;

impl Run<'_> {
    /// The spec by itself, Embree, then every adapter.
    pub(super) fn ldm(&mut self) -> Result<(), Stop> {
        self.unit(Uses::Nothing, &["ldm", "spec"], |run| {
            let spec = run.ldm_spec()?;
            run.facts = Some(facts::of(run.loaded, &spec.value, run.options.skip));
            if run.options.pictures {
                run.pictures.extend(pictures::spec(run.loaded, &spec.value));
            }
            run.dump_ldm_spec(&spec).map_err(Stop::Dump)
        })?;
        let mut tasks = Vec::new();
        if self.options.embree {
            tasks.push(Task::apart(|run| {
                run.unit(Uses::Embree, &["ldm", "embree"], Self::ldm_vote)
            }));
        }
        if self.options.gpu {
            tasks.extend(self.on_adapters(Self::ldm_leg));
        }
        self.side_by_side(tasks)
    }

    fn ldm_leg(&mut self, adapter: &Adapter, path: Path) -> Result<(), Stop> {
        let label = adapter.label(path);
        let why = "works on maps, pixels and points, in compute kernels";
        if self.skips_path(adapter, path, why) {
            return Ok(());
        }
        let plan = LdmPlan::new(self.loaded, self.options.skip);
        let spec = self.ldm_spec()?;
        let leg = LdmLeg::new(adapter, path, &spec, &plan.passes);
        match leg.run(&mut self.rows) {
            Ok(made) => self
                .dump_ldm_gpu(&label, &spec, &made)
                .map_err(Stop::Dump)?,
            Err(error) => self.leg_refused(&label, &error),
        }
        Ok(())
    }

    /// Embree's vote on stage `layers`, and how far what is open is from what its rays say.
    fn ldm_vote(&mut self) -> Result<(), Stop> {
        let plan = LdmPlan::new(self.loaded, self.options.skip);
        if let Some(reason) = plan.skipped("layers") {
            let rows = &mut self.rows;
            rows.skip("layers", "spec", "embree", Class::Vote, reason);
            return Ok(());
        }
        let spec = self.ldm_spec()?;
        let start = Instant::now();
        let seen = match ask(&spec.value, self.loaded.file.seed) {
            Ok(seen) => Observed::<Embree, _>::new("embree", seen).taking(start.elapsed()),
            Err(error) => {
                let words = error.to_string();
                self.rows.fail("layers", "spec", "embree", None, words);
                return Ok(());
            }
        };
        // What lies near edges hangs on the mesh and on the resolution, and has no share that is
        // right for all: it is held to one where the scene states it.
        let budget = self.loaded.file.budget.edge.map(|share| share.0);
        let judgement = compare(&spec, &seen, |_, seen| {
            let judgement = seen.vote.judgement(budget);
            let off = seen.off.map_or(String::new(), |off| format!("; {off}"));
            let note = format!("{}{off}", judgement.note);
            Judgement { note, ..judgement }
        });
        let times = spec.map(|_| ()).taking(spec.value.times.layers);
        self.rows.add("layers", &times, &seen, judgement);
        Ok(())
    }
}
