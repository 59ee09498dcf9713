//! What GPU legs of different families have in common.

use triptych_gpu::raster::Path;

use super::gpu::Adapter;
use super::rows::Rows;
use crate::compare::{Judgement, compare};
use crate::observe::{Gpu, Observed, Spec};
use crate::plan::Pass;
use crate::row::Class;

/// One GPU leg of one scene, of which the spec made an `S`.
pub struct Leg<'a, S> {
    /// On which it runs.
    pub adapter: &'a Adapter,
    /// With words or with native integers.
    pub path: Path,
    /// What the spec found.
    pub spec: &'a Observed<Spec, S>,
    /// Which stages run.
    pub passes: &'a [Pass],
}

impl<'a, S> Leg<'a, S> {
    /// The leg of an adapter on a path.
    pub fn new(
        adapter: &'a Adapter,
        path: Path,
        spec: &'a Observed<Spec, S>,
        passes: &'a [Pass],
    ) -> Self {
        Self {
            adapter,
            path,
            spec,
            passes,
        }
    }

    /// The leg's name in rows.
    pub fn label(&self) -> String {
        self.adapter.label(self.path)
    }

    /// Whether the plan has a stage run.
    pub(super) fn runs(&self, stage: &str) -> bool {
        let pass = self.passes.iter().find(|pass| pass.name == stage);
        pass.is_none_or(|pass| pass.runs)
    }

    /// Puts the device's results beside the spec's by their types.
    pub(super) fn beside<T, U>(
        &self,
        spec: T,
        seen: U,
        judged: impl FnOnce(&T, &U) -> Judgement,
    ) -> Judgement {
        let spec = self.spec.derive(spec);
        let seen = Observed::<Gpu, _>::new(self.label(), seen);
        compare(&spec, &seen, judged)
    }

    /// A row for each stage that does not run, with the reason.
    pub(super) fn left_out(&self, rows: &mut Rows) {
        for pass in self.passes.iter().filter(|pass| !pass.runs) {
            self.skip(pass, format!("plan: {}", pass.reason), rows);
        }
    }

    /// A row for each stage that the plan has run, though what the spec saw leaves nothing to do.
    pub(super) fn idle(&self, reason: &str, rows: &mut Rows) {
        for pass in self.passes.iter().filter(|pass| pass.runs) {
            self.skip(pass, reason.to_owned(), rows);
        }
    }

    fn skip(&self, pass: &Pass, reason: String, rows: &mut Rows) {
        let label = self.label();
        rows.skip(pass.name, &self.spec.label, &label, Class::Exact, reason);
    }
}
