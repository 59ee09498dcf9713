//! All stages, each from the device's own results.
//!
//! It starts from snapped triangles. Which of them a pixel sees is exact; the device's points may
//! differ from the spec's within bounds, and what is decided on them may differ too. So what is
//! open and lit is held against what the spec makes of the device's own points: no pixel goes
//! unjudged.

use triptych_gpu::error::GpuError;
use triptych_gpu::rsm::gbuffer;
use triptych_spec::ldm::{Open, environment, occlusion};
use triptych_spec::rsm::Colour;

use super::{LdmLeg, Made};
use crate::compare::ldm as judge;
use crate::compare::rsm as seen;
use crate::replay::judged::Judged;
use crate::replay::ldm::{Asker, LdmTurn};
use crate::replay::rows::Rows;
use crate::replay::visible::visible;

/// What the rows are about.
const STAGE: &str = "end to end";

impl LdmLeg<'_> {
    /// Adds rows for all stages from the device's own results, and gives what it made.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn end_to_end(&self, rows: &mut Rows) -> Result<Vec<Made>, GpuError> {
        let mut judged = Judged::default();
        let turns = &self.spec.value.turns;
        let askers = match turns.is_empty() {
            true => None,
            false => self.points(&mut judged)?,
        };
        let made = askers.map_or(Ok(Vec::new()), |askers| {
            let turns = turns.iter();
            turns
                .map(|turn| self.whole(turn, &askers, &mut judged))
                .collect()
        });
        judged.rows(&self.spec.label, &self.label(), rows);
        made
    }

    /// Who asks, by the device; `None` if its points are not what they may be.
    fn points(&self, judged: &mut Judged) -> Result<Option<Vec<Asker>>, GpuError> {
        let setup = &self.spec.value.setup;
        let (view, model) = (&setup.eye, &setup.model);
        let nearest = visible((self.adapter, self.path), view, model)?;
        let judgement = self.beside(&setup.seen, &nearest, |spec, device| {
            seen::visible("pixels", spec, &device.keys, &device.triangles)
        });
        if !judged.may_follow(STAGE, judgement) {
            return Ok(None);
        }
        let kernels = self.adapter.kernels(self.path);
        let of = (model, view, setup.offset);
        let surfaces = gbuffer(&self.adapter.gpu, kernels, of, &nearest.triangles)?;
        let mut judgement = self.beside(&setup.seen, &surfaces, |a, b| seen::surfaces(a, b));
        if judgement.differ() > 0 {
            judged.part(STAGE, judgement);
            return Ok(None);
        }
        let askers = setup.receivers_of(&surfaces);
        let others = askers.iter().zip(&setup.receivers).filter(|(a, b)| a != b);
        judgement.note = format!(
            "{} of {} points are others than the spec's",
            others.count(),
            askers.len()
        );
        judged.part(STAGE, judgement);
        Ok(Some(askers))
    }

    /// All stages from points and lists that the device made, in several batches if there are
    /// several maps: a third of the room that all of them need.
    fn whole(
        &self,
        turn: &LdmTurn,
        askers: &[Asker],
        judged: &mut Judged,
    ) -> Result<Made, GpuError> {
        let mut made = Made::default();
        let mut stages = self.stages(turn, budget(turn))?;
        if self.runs("layers") {
            made.layers = stages.layers()?;
            let (maps, layers) = (&turn.maps, &made.layers);
            let mut judgement = self.beside(&turn.layers, layers, |must, seen| {
                judge::layers(maps, must, &seen.offsets, &seen.keys)
            });
            let sound = judgement.differ() == 0;
            judgement.note = format!("{}, in {} batches", judgement.note, stages.batches());
            judged.part(STAGE, judgement);
            if !sound {
                return Ok(made);
            }
        } else {
            stages.give_layers(&turn.layers)?;
        }
        let (open, light) = self.expected(turn, askers);
        if self.runs("occlusion") {
            made.open = self.open(askers, &mut stages)?;
            judged.part(STAGE, self.judge_open(&open, &made.open));
        }
        if self.runs("environment") {
            made.light = self.light(turn, askers, &mut stages)?;
            judged.part(STAGE, self.judge_light(&light, &made.light));
        }
        if let Some(judgement) = self.own_reflections(turn, askers, &mut stages)? {
            judged.part(STAGE, judgement);
        }
        Ok(made)
    }

    /// What the spec makes of these points: what it has made where they are its own.
    fn expected(&self, turn: &LdmTurn, askers: &[Asker]) -> (Vec<Open>, Vec<Colour>) {
        let setup = &self.spec.value.setup;
        let (mut open, mut light) = (turn.open.clone(), turn.light.clone());
        let both = askers.iter().zip(&setup.receivers).enumerate();
        for (at, (asker, _)) in both.filter(|(_, (own, spec))| own != spec) {
            let receiver = &asker.receiver;
            let found: Vec<_> = turn.hits(receiver).collect();
            open[at] = occlusion(found.iter().copied(), receiver.normal, setup.falloff);
            if let Some(light) = light.get_mut(at) {
                *light = environment(turn.lit_hits(&found), receiver.normal, setup.directions);
            }
        }
        (open, light)
    }
}

/// Bytes for a third of a rotation's lists, or for the largest map's.
fn budget(turn: &LdmTurn) -> u64 {
    let words = |pixels: u64, keys: u64| 4 * (pixels + 1).max(keys);
    let offsets = &turn.layers.offsets;
    let largest = turn.maps.maps.iter().map(|map| {
        let pixels = map.size.width * map.size.height;
        let [first, end] = [map.first, map.first + pixels].map(|at| offsets[at as usize]);
        words(pixels.into(), (end - first).into())
    });
    let all = words(turn.maps.pixels.into(), turn.layers.keys.len() as u64);
    largest.max().unwrap_or(0).max(all / 3)
}
