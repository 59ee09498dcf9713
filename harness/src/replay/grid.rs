//! A scene whose triangles block rays: the family `grid`.

mod embree;
mod gpu;
mod own;
mod pictures;
mod spec;
#[cfg(test)]
mod tests;
mod view;

use std::sync::Arc;

use triptych_gpu::error::GpuError;
use triptych_gpu::raster::Path;

use super::facts::Facts;
use super::gpu::Adapter;
use super::lanes::Task;
use super::run::Run;
use super::stop::Stop;
use crate::cache::Uses;
use crate::cause::Cause;
use crate::observe::Observed;
use crate::plan::GridPlan;
use crate::registry::{Chain, stages_of};
use crate::row::Class;
pub use gpu::GridLeg;
pub use own::OwnGrid;
pub use spec::{GridRun, blockers};

impl Run<'_> {
    /// The same run, of a scene with a grid whose spec has run.
    pub(super) fn on_grid(mut self, spec: GridRun) -> Self {
        self.grid = Some(Arc::new(Observed::new("spec", spec)));
        self
    }

    /// The spec by itself, then Embree and every adapter.
    pub(super) fn grid(&mut self) -> Result<(), Stop> {
        self.unit(Uses::Nothing, &["grid", "spec"], |run| {
            let spec = run.grid_spec()?;
            run.facts = Some(Facts::of_grid(run.loaded, &spec.value, run.options.skip));
            if run.shows_grid() {
                match pictures::spec(&spec.value, &run.loaded.scene) {
                    Some(shown) => run.pictures.extend(shown),
                    None => run.remarks.push(format!(
                        "{}: no pictures, as their rays would pass more than {} cells and triangles \
                         in their lists",
                        run.loaded.name,
                        view::MOST
                    )),
                }
            }
            run.dump_grid_spec(&spec).map_err(Stop::Dump)
        })?;
        let mut tasks = Vec::new();
        if self.options.embree {
            tasks.push(Task::apart(|run| {
                run.unit(Uses::Embree, &["grid", "embree"], Self::grid_vote)
            }));
        }
        if self.options.gpu {
            tasks.extend(self.on_adapters(Self::grid_leg));
        }
        self.side_by_side(tasks)
    }

    fn grid_vote(&mut self) -> Result<(), Stop> {
        let plan = GridPlan::new(self.loaded, self.options.skip);
        if let Some(reason) = plan.skipped() {
            let rows = &mut self.rows;
            rows.skip("trace", "spec", "embree", Class::Vote, reason);
            return Ok(());
        }
        let spec = self.grid_spec()?;
        let stated = self.loaded.file.budget.edge.map(|share| share.0);
        let budget = stated.unwrap_or_else(|| embree::drawn_for_edges(&spec.value));
        embree::run(&spec, budget, &mut self.rows);
        if self.shows_grid() {
            match pictures::embree(&spec.value, &self.loaded.scene) {
                Ok(picture) => self.pictures.extend(picture),
                Err(error) => {
                    let words = error.to_string();
                    self.rows.fail("trace", "spec", "embree", None, words);
                }
            }
        }
        Ok(())
    }

    fn grid_leg(&mut self, adapter: &Adapter, path: Path) -> Result<(), Stop> {
        let label = adapter.label(path);
        let why = "works on triangles, cells and rays, not on fragments";
        if self.skips_path(adapter, path, why) {
            return Ok(());
        }
        let plan = GridPlan::new(self.loaded, self.options.skip);
        if let Some(reason) = plan.skipped() {
            for stage in stages_of(Chain::Rays) {
                let reason = reason.clone();
                self.rows
                    .skip(stage.name, "spec", &label, Class::Exact, reason);
            }
            return Ok(());
        }
        let spec = self.grid_spec()?;
        let capacity = self.loaded.file.grid.unwrap_or_default().capacity;
        let leg = GridLeg::new(adapter, path, &spec, capacity);
        let more = leg.run(&mut self.rows).and_then(|()| self.beside(&leg));
        match more {
            Ok(dumped) => dumped.map_err(Stop::Dump),
            Err(error) => {
                self.leg_refused(&label, &error);
                Ok(())
            }
        }
    }

    /// Picture and dump of a leg. Where its lists are damaged, which a row says, there is
    /// neither.
    fn beside(&mut self, leg: &GridLeg<'_>) -> Result<std::io::Result<()>, GpuError> {
        if self.shows_grid() {
            self.pictures.extend(leg.look(&self.loaded.scene)?);
        }
        if self.options.dump.is_none() {
            return Ok(Ok(()));
        }
        let own = leg.own()?;
        Ok(own.map_or(Ok(()), |own| self.dump_grid(&leg.spec.value, &own)))
    }

    /// Whether pictures are kept, and there is something to see.
    fn shows_grid(&self) -> bool {
        self.options.pictures && !self.loaded.scene.triangles.is_empty()
    }

    /// Whether a path has nothing of its own to run in a family of compute kernels, which a row
    /// then says; `why` is said of the fragment path.
    pub(super) fn skips_path(&mut self, adapter: &Adapter, path: Path, why: &str) -> bool {
        let reason = match path {
            Path::Fragment => why,
            Path::Native if adapter.native.is_none() => {
                "no 64-bit integers: compute takes its place"
            }
            _ => return false,
        };
        let label = adapter.label(path);
        let reason = reason.to_owned();
        self.rows.skip("leg", "spec", &label, Class::Exact, reason);
        true
    }

    /// What kept a device from a result. All its buffers are sized by the scene: a limit is a
    /// reason to skip.
    pub(super) fn leg_refused(&mut self, label: &str, error: &GpuError) {
        let reason = error.to_string();
        let cause = match error {
            GpuError::Limit { .. } | GpuError::Memory { .. } => {
                self.rows.skip("leg", "spec", label, Class::Exact, reason);
                return;
            }
            GpuError::Lost { .. } => Some(Cause::DeviceLost),
            GpuError::Endless { .. } => Some(Cause::Cycle),
            _ => None,
        };
        self.rows.fail("leg", "spec", label, cause, reason);
    }
}
