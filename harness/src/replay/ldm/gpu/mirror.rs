//! Stage `mirror` on a device: from the spec's lists, and from its own points and lists.

use triptych_gpu::error::GpuError;
use triptych_gpu::ldm::Stages;
use triptych_spec::grid::lattice::Point;
use triptych_spec::ldm::{Mirrored, mirror};

use super::{LdmLeg, receivers};
use crate::compare::Judgement;
use crate::compare::ldm as judge;
use crate::replay::judged::Judged;
use crate::replay::ldm::{Asker, LdmTurn};

impl LdmLeg<'_> {
    /// What receivers mirror, of the spec's lists.
    pub(super) fn reflections(
        &self,
        turn: &LdmTurn,
        stages: &mut Stages<'_>,
        judged: &mut Judged,
    ) -> Result<(), GpuError> {
        if !self.runs("mirror") {
            return Ok(());
        }
        let askers = &self.spec.value.setup.receivers;
        let judgement = self.mirrored((turn, &turn.mirrored), askers, stages)?;
        let of_spec = self.share(self.spec.value.times.mirror);
        judged.add("mirror", judgement, of_spec, stages.time);
        Ok(())
    }

    /// The same from points and lists that the device made, held against what the spec makes of
    /// these points.
    pub(super) fn own_reflections(
        &self,
        turn: &LdmTurn,
        askers: &[Asker],
        stages: &mut Stages<'_>,
    ) -> Result<Option<Judgement>, GpuError> {
        if !self.runs("mirror") {
            return Ok(None);
        }
        let mut must = turn.mirrored.clone();
        let both = askers.iter().zip(&self.spec.value.setup.receivers);
        for (must, (asker, _)) in must.iter_mut().zip(both).filter(|(_, (a, b))| a != b) {
            let found: Vec<_> = turn.hits(&asker.receiver).collect();
            *must = mirror(turn.all_hits(&found), asker.receiver.normal, asker.view);
        }
        self.mirrored((turn, &must), askers, stages).map(Some)
    }

    fn mirrored(
        &self,
        (turn, must): (&LdmTurn, &[Mirrored]),
        askers: &[Asker],
        stages: &mut Stages<'_>,
    ) -> Result<Judgement, GpuError> {
        let views: Vec<Point> = askers.iter().map(|asker| asker.view).collect();
        let seen = stages.mirror(&receivers(askers), &views, &turn.sky)?;
        let pixels = self.pixels();
        Ok(self.beside(must, seen, |must, seen| {
            judge::mirrored(&pixels, must, seen)
        }))
    }
}
