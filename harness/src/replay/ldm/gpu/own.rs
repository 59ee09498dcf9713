//! All stages, each from the device's own results.

use triptych_gpu::error::GpuError;

use super::{LdmLeg, Made};
use crate::compare::ldm as judge;
use crate::replay::judged::Judged;
use crate::replay::ldm::LdmTurn;
use crate::replay::rows::Rows;

/// What the rows are about.
const STAGE: &str = "end to end";

impl LdmLeg<'_> {
    /// Adds rows for all stages from the device's own lists, and gives what it made.
    pub(super) fn end_to_end(&self, rows: &mut Rows) -> Result<Vec<Made>, GpuError> {
        let mut judged = Judged::default();
        let turns = self.spec.value.turns.iter();
        let made: Result<Vec<Made>, GpuError> =
            turns.map(|turn| self.whole(turn, &mut judged)).collect();
        judged.rows(&self.spec.label, &self.label(), rows);
        made
    }

    /// All stages from lists that the device made, in several batches if there are several maps:
    /// a third of the room that all of them need.
    fn whole(&self, turn: &LdmTurn, judged: &mut Judged) -> Result<Made, GpuError> {
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
        if self.runs("occlusion") {
            made.open = self.open(&mut stages)?;
            judged.part(STAGE, self.judge_open(turn, &made.open));
        }
        if self.runs("environment") {
            made.light = self.light(turn, &mut stages)?;
            judged.part(STAGE, self.judge_light(turn, &made.light));
        }
        Ok(made)
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
