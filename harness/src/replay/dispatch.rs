//! A scene of rays in work queues: the family `dispatch`.

mod dumps;
mod facts;
mod gpu;
mod pictures;
mod setup;
mod spec;

use std::time::Instant;

use triptych_gpu::raster::Path;
use triptych_spec::dispatch::Ray;
use triptych_spec::grid::ray::Ray as Way;
use triptych_spec::grid::trace::Query;

use super::gpu::Adapter;
use super::lanes::Task;
use super::rows::Spot;
use super::run::Run;
use super::stop::Stop;
use crate::cache::Uses;
use crate::compare::compare;
use crate::compare::embree::{RayVote, compare_rays};
use crate::embree::EmbreeError;
use crate::embree::rays::RayScene;
use crate::observe::{Embree, Observed};
use crate::plan::DispatchPlan;
use crate::report::Picture;
use crate::row::Class;
pub use gpu::DispatchLeg;
pub use setup::Setup;
pub use spec::{Bounce, DispatchRun, Times};

impl Run<'_> {
    /// The spec by itself, Embree, then every adapter.
    pub(super) fn dispatch(&mut self) -> Result<(), Stop> {
        self.unit(Uses::Nothing, &["dispatch", "spec"], |run| {
            let spec = run.dispatch_spec()?;
            run.facts = Some(facts::of(run.loaded, &spec.value, run.options.skip));
            if run.options.pictures {
                run.pictures.extend(pictures::spec(&spec.value));
            }
            run.dump_traced_spec(&spec).map_err(Stop::Dump)
        })?;
        let mut tasks = Vec::new();
        if self.options.embree {
            tasks.push(Task::apart(|run| {
                run.unit(Uses::Embree, &["dispatch", "embree"], Self::dispatch_vote)
            }));
        }
        if self.options.gpu {
            tasks.extend(self.on_adapters(Self::dispatch_leg));
        }
        self.side_by_side(tasks)
    }

    fn dispatch_leg(&mut self, adapter: &Adapter, path: Path) -> Result<(), Stop> {
        let label = adapter.label(path);
        let why = "works on rays, in compute kernels";
        if self.skips_path(adapter, path, why) {
            return Ok(());
        }
        let plan = DispatchPlan::new(self.loaded, self.options.skip);
        let spec = self.dispatch_spec()?;
        let leg = DispatchLeg::new(adapter, path, &spec, &plan.passes);
        match leg.run(&mut self.rows) {
            Ok(made) => {
                if self.options.pictures {
                    let shown = pictures::gpu(&spec.value, &label, &made.sums);
                    self.pictures.extend(shown);
                }
                self.dump_traced_gpu(&label, &spec, &made)
                    .map_err(Stop::Dump)?;
            }
            Err(error) => self.leg_refused(&label, &error),
        }
        Ok(())
    }

    /// Embree's vote on what rays meet, bounce after bounce: rays that ask for the nearest surface, and
    /// shadow rays.
    fn dispatch_vote(&mut self) -> Result<(), Stop> {
        let plan = DispatchPlan::new(self.loaded, self.options.skip);
        if let Some(reason) = plan.skipped("intersect") {
            let rows = &mut self.rows;
            rows.skip("intersect", "spec", "embree", Class::Vote, reason);
            return Ok(());
        }
        let spec = self.dispatch_spec()?;
        // A bare mesh has no [dispatch], so there is always a budget.
        let budget = self.loaded.file.budget.edge();
        let start = Instant::now();
        let vote = match vote(&spec.value) {
            Ok(vote) => Observed::<Embree, _>::new("embree", vote).taking(start.elapsed()),
            Err(error) => {
                let words = error.to_string();
                self.rows.fail("intersect", "spec", "embree", None, words);
                return Ok(());
            }
        };
        let judgement = compare(&spec, &vote, |_, vote| vote.judgement(Some(budget)));
        let times = spec.map(|_| ()).taking(spec.value.times.intersect);
        self.rows
            .add("intersect", &times, &vote.map(|_| ()), judgement);
        Ok(())
    }
}

/// What Embree says of the rays that ask for the nearest surface, bounce after bounce, and then of
/// shadow rays.
fn vote(run: &DispatchRun) -> Result<RayVote, EmbreeError> {
    let blockers = &run.setup.world.blockers;
    let scene = RayScene::new(blockers)?;
    let ways = |of: fn(&Bounce) -> &[Ray]| -> Vec<Way> {
        let rays = run.bounces.iter().flat_map(of);
        rays.map(|ray| ray.way).collect()
    };
    let [nearest, shadow] = [ways(|b| &b.rays), ways(|b| &b.shadows)];
    let mut vote = RayVote::default();
    let mut first = 0;
    for (name, rays, query) in [
        ("nearest", nearest, Query::Closest),
        ("shadow", shadow, Query::Any),
    ] {
        let of_kind = compare_rays(&run.setup.grid, blockers, &rays, query, &scene)?;
        vote.add_kind(name, of_kind, first);
        first += rays.len();
    }
    Ok(vote)
}

impl DispatchRun {
    /// Which pixels differ, and why; `None` if none does.
    pub fn causes(&self, spots: &[Spot]) -> Option<Picture> {
        pictures::causes(self, spots)
    }
}
