//! All stages, each from the device's own results.
//!
//! It starts from snapped triangles. Which of them a pixel sees is exact; the device's points may
//! differ from the spec's within bounds, and what is decided on them may differ too. So what is
//! open and lit is held against what the spec makes of the device's own points: no pixel goes
//! unjudged.

use triptych_gpu::error::GpuError;
use triptych_gpu::ldm::{self as device, irradiance};
use triptych_gpu::rsm::gbuffer;
use triptych_spec::ldm::{Open, Receiver, environment, occlusion};
use triptych_spec::rsm::Colour;

use super::{LdmLeg, Made, receivers};
use crate::compare::ldm as judge;
use crate::compare::rsm as seen;
use crate::replay::judged::Judged;
use crate::replay::ldm::{Asker, LdmTurn};
use crate::replay::rows::Rows;
use crate::replay::visible::visible;
use crate::row::Class;

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
            false => self.points(&mut judged, rows)?,
        };
        let made = askers.map_or(Ok(Vec::new()), |askers| self.turns(&askers, &mut judged));
        judged.rows(&self.spec.label, &self.label(), rows);
        made
    }

    /// All rotations, one onto the other, as far as they are sound; then what they add up to.
    fn turns(&self, askers: &[Asker], judged: &mut Judged) -> Result<Vec<Made>, GpuError> {
        let turns = &self.spec.value.turns;
        let mut made = Vec::new();
        let mut sums = Made {
            open: vec![device::Open::default(); askers.len()],
            light: vec![[0.0; 4]; askers.len()],
            ..Made::default()
        };
        for turn in turns {
            let sound = self.whole(turn, askers, &mut sums, judged)?;
            made.push(sums.clone());
            if !sound {
                return Ok(made);
            }
        }
        let (open, light) = self.expected(askers);
        if self.runs("occlusion") {
            judged.part(STAGE, self.judge_open(&open, &sums.open));
        }
        if self.runs("environment") {
            let setup = &self.spec.value.setup;
            let seen = irradiance(&sums.light, setup.directions * setup.rotations);
            judged.part(STAGE, self.judge_light(&light, &seen));
        }
        Ok(made)
    }

    /// Who asks, by the device; `None` if its points are not what they may be, or not where maps are.
    fn points(&self, judged: &mut Judged, rows: &mut Rows) -> Result<Option<Vec<Asker>>, GpuError> {
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
        let beyond = setup.beyond(&askers);
        if beyond > 0 {
            judged.part(STAGE, judgement);
            let reason = format!("{beyond} points lie beyond what maps are cropped to");
            rows.skip(STAGE, &self.spec.label, &self.label(), Class::Exact, reason);
            return Ok(None);
        }
        let others = askers.iter().zip(&setup.receivers).filter(|(a, b)| a != b);
        judgement.note = format!(
            "{} of {} points are others than the spec's",
            others.count(),
            askers.len()
        );
        judged.part(STAGE, judgement);
        Ok(Some(askers))
    }

    /// All stages of a rotation from points and lists that the device made, added to the sums so
    /// far; `false` if the lists are not what they must be. Maps are made in several batches if
    /// there are several: a third of the room that all of them need.
    fn whole(
        &self,
        turn: &LdmTurn,
        askers: &[Asker],
        sums: &mut Made,
        judged: &mut Judged,
    ) -> Result<bool, GpuError> {
        let mut stages = self.stages(turn, budget(turn))?;
        if self.runs("layers") {
            sums.layers = stages.layers()?;
            let (maps, layers) = (&turn.maps, &sums.layers);
            let mut judgement = self.beside(&turn.layers, layers, |must, seen| {
                judge::layers(maps, must, &seen.offsets, &seen.keys)
            });
            let sound = judgement.differ() == 0;
            judgement.note = format!("{}, in {} batches", judgement.note, stages.batches());
            judged.part(STAGE, judgement);
            if !sound {
                return Ok(false);
            }
        } else {
            stages.give_layers(&turn.layers)?;
        }
        let (own, falloff) = (receivers(askers), self.spec.value.setup.falloff);
        if self.runs("occlusion") {
            sums.open = stages.occlusion_onto(&sums.open, &own, falloff)?;
        }
        if self.runs("environment") {
            let sky = (&turn.sky[..], &turn.lit[..]);
            sums.light = stages.environment_onto(&sums.light, &own, sky)?;
        }
        if let Some(judgement) = self.own_reflections(turn, askers, &mut stages)? {
            judged.part(STAGE, judgement);
        }
        Ok(true)
    }

    /// What the spec makes of these points: what it has made where they are its own and there is
    /// one rotation; of several, a device has one sum.
    fn expected(&self, askers: &[Asker]) -> (Vec<Open>, Vec<Colour>) {
        let run = &self.spec.value;
        let setup = &run.setup;
        let (mut open, mut light) = (run.open.clone(), run.light.clone());
        let both = askers.iter().zip(&setup.receivers).enumerate();
        for (at, (asker, _)) in both.filter(|(_, (own, spec))| own != spec || run.turns.len() > 1) {
            let Receiver { normal, .. } = asker.receiver;
            let found = run.turns.iter();
            let found = found.map(|turn| (turn, turn.hits(&asker.receiver).collect()));
            let found: Vec<(_, Vec<_>)> = found.collect();
            let all = found.iter().flat_map(|(_, found)| found).copied();
            open[at] = occlusion(all, normal, setup.falloff);
            if let Some(light) = light.get_mut(at) {
                let lit = found.iter().flat_map(|(turn, found)| turn.lit_hits(found));
                *light = environment(lit, normal, setup.directions * setup.rotations);
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
