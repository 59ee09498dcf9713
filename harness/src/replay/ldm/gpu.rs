//! A GPU leg of a scene of maps: every stage from the spec's input, then all of the device's own.

mod mirror;
mod own;

use std::time::Duration;

use triptych_gpu::error::GpuError;
use triptych_gpu::ldm::{self as device, Open, Stages};
use triptych_spec::ldm::{self, Chains, Hits, Layers, Link, Receiver};
use triptych_spec::rsm::Colour;

use super::setup::Asker;
use super::spec::{LdmRun, LdmTurn};
use crate::compare::Judgement;
use crate::compare::ldm as judge;
use crate::replay::judged::Judged;
use crate::replay::leg::Leg;
use crate::replay::rows::Rows;

/// Traces that are compared at once: 12 bytes each on both sides.
const TRACES: usize = 1 << 22;

/// Why there are no maps, where surfaces are all out of the picture.
const NOBODY: &str = "nobody asks: no pixel sees anything";

/// One GPU leg of one scene.
pub type LdmLeg<'a> = Leg<'a, LdmRun>;

/// What a device made of a rotation and of those before it, from its own points and lists.
#[derive(Clone, Debug, Default)]
pub struct Made {
    /// Its lists.
    pub layers: Layers,
    /// What is open over each receiver, all rotations up to this one together.
    pub open: Vec<Open>,
    /// The light of each receiver, likewise, before [`irradiance`](triptych_gpu::ldm::irradiance);
    /// nothing without a sky.
    pub light: Vec<[f32; 4]>,
}

impl LdmLeg<'_> {
    /// Adds a row for each stage from the spec's input, and rows for all of them from the
    /// device's own points and lists; gives what it made in the latter, nothing where its points
    /// are not what they may be.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn run(&self, rows: &mut Rows) -> Result<Vec<Made>, GpuError> {
        self.each(rows)?;
        self.end_to_end(rows)
    }

    /// Adds a row for each stage from the spec's input.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn each(&self, rows: &mut Rows) -> Result<(), GpuError> {
        let mut judged = Judged::default();
        for turn in &self.spec.value.turns {
            let mut stages = self.stages(turn, u64::MAX)?;
            self.lists(turn, &mut stages, &mut judged)?;
            stages.give_layers(&turn.layers)?;
            self.found(turn, &mut stages, &mut judged)?;
            self.sums(turn, &mut stages, &mut judged)?;
            self.reflections(turn, &mut stages, &mut judged)?;
        }
        judged.rows(&self.spec.label, &self.label(), rows);
        if self.spec.value.turns.is_empty() {
            self.idle(NOBODY, rows);
        }
        self.left_out(rows);
        Ok(())
    }

    fn stages<'s>(&'s self, turn: &'s LdmTurn, budget: u64) -> Result<Stages<'s>, GpuError> {
        let blockers = &self.spec.value.setup.blockers;
        let gpu = &self.adapter.gpu;
        Stages::new(
            gpu,
            self.adapter.kernels(self.path),
            &turn.maps,
            blockers,
            budget,
        )
    }

    /// A share of the spec's time of a stage, which it has for all rotations.
    fn share(&self, time: Duration) -> Duration {
        time / u32::try_from(self.spec.value.turns.len().max(1)).unwrap_or(u32::MAX)
    }

    /// Both kinds of lists, from triangles.
    fn lists(
        &self,
        turn: &LdmTurn,
        stages: &mut Stages<'_>,
        judged: &mut Judged,
    ) -> Result<(), GpuError> {
        let (maps, must) = (&turn.maps, &turn.layers);
        let of_spec = self.share(self.spec.value.times.layers);
        if self.runs("layers") {
            let seen = stages.layers()?;
            let judgement = self.beside(must, seen, |must, seen| {
                judge::layers(maps, must, &seen.offsets, &seen.keys)
            });
            judged.add("layers", judgement, of_spec, stages.time);
        }
        if self.runs("chain") {
            let all = u32::try_from(must.keys.len()).unwrap_or(u32::MAX);
            for (capacity, stage) in [(all, "chain"), (all / 2, "overflow")] {
                let sound =
                    |own: &device::Chains, room| judge::may_follow(&chains(own.clone(), room));
                let seen = chains(stages.chain(capacity, sound)?, capacity);
                let judgement =
                    self.beside(must, seen, |must, seen| judge::chains(maps, must, seen));
                judged.add(stage, judgement, of_spec, stages.time);
            }
        }
        Ok(())
    }

    /// What receivers find in the spec's lists, some receivers at a time.
    fn found(
        &self,
        turn: &LdmTurn,
        stages: &mut Stages<'_>,
        judged: &mut Judged,
    ) -> Result<(), GpuError> {
        if !self.runs("neighbours") {
            return Ok(());
        }
        let maps = turn.maps.maps.len();
        let at_once = (TRACES / maps).max(1);
        let of_spec = self.share(self.spec.value.times.neighbours);
        let mut time = Duration::ZERO;
        let mut parts = Vec::new();
        for askers in self.spec.value.setup.receivers.chunks(at_once) {
            let receivers = receivers(askers);
            let pixels: Vec<u32> = askers.iter().map(|a| a.pixel).collect();
            let seen = by_receiver(&stages.neighbours(&receivers)?, maps);
            time += stages.time;
            let must: Vec<Hits> = receivers
                .iter()
                .flat_map(|receiver| turn.hits(receiver).map(|(_, hits)| hits))
                .collect();
            parts.push(self.beside(must, seen, |must, seen| {
                judge::neighbours(&pixels, (0, maps), must, seen)
            }));
        }
        judged.add("neighbours", Judgement::sum(parts), of_spec, time);
        Ok(())
    }

    /// What receivers sum up, of the spec's lists.
    fn sums(
        &self,
        turn: &LdmTurn,
        stages: &mut Stages<'_>,
        judged: &mut Judged,
    ) -> Result<(), GpuError> {
        let times = self.spec.value.times;
        let askers = &self.spec.value.setup.receivers;
        if self.runs("occlusion") {
            let seen = self.open(askers, stages)?;
            let judgement = self.judge_open(&turn.open, &seen);
            judged.add(
                "occlusion",
                judgement,
                self.share(times.occlusion),
                stages.time,
            );
        }
        if self.runs("environment") {
            let seen = self.light(turn, askers, stages)?;
            let judgement = self.judge_light(&turn.light, &seen);
            let of_spec = self.share(times.environment);
            judged.add("environment", judgement, of_spec, stages.time);
        }
        Ok(())
    }

    fn open(&self, askers: &[Asker], stages: &mut Stages<'_>) -> Result<Vec<Open>, GpuError> {
        stages.occlusion(&receivers(askers), self.spec.value.setup.falloff)
    }

    fn light(
        &self,
        turn: &LdmTurn,
        askers: &[Asker],
        stages: &mut Stages<'_>,
    ) -> Result<Vec<[f32; 3]>, GpuError> {
        let directions = self.spec.value.setup.directions;
        stages.environment(&receivers(askers), (&turn.sky, &turn.lit), directions)
    }

    fn judge_open(&self, must: &[ldm::Open], seen: &[Open]) -> Judgement {
        let seen: Vec<(u32, f32)> = seen.iter().map(|open| (open.whole, open.part)).collect();
        let pixels = self.pixels();
        self.beside(must, seen, |must, seen| judge::open(&pixels, must, seen))
    }

    fn judge_light(&self, must: &[Colour], seen: &[[f32; 3]]) -> Judgement {
        let pixels = self.pixels();
        self.beside(must, seen, |must, seen| judge::light(&pixels, must, seen))
    }

    /// Of those who ask, in order: the same for all legs.
    fn pixels(&self) -> Vec<u32> {
        let askers = self.spec.value.setup.receivers.iter();
        askers.map(|asker| asker.pixel).collect()
    }
}

fn receivers(askers: &[Asker]) -> Vec<Receiver> {
    askers.iter().map(|asker| asker.receiver).collect()
}

/// A device's chains as those of the spec are written.
pub(crate) fn chains(seen: device::Chains, capacity: u32) -> Chains {
    let link = |link: device::Link| Link {
        key: link.key,
        next: link.next,
    };
    Chains {
        heads: seen.heads,
        links: seen.links.into_iter().map(link).collect(),
        attempts: u32::try_from(seen.attempts).unwrap_or(u32::MAX),
        capacity,
    }
}

/// Traces map by map, as traces receiver by receiver.
fn by_receiver(seen: &[Hits], maps: usize) -> Vec<Hits> {
    let receivers = seen.len() / maps;
    let of = |receiver: usize| (0..maps).map(move |map| seen[map * receivers + receiver]);
    (0..receivers).flat_map(of).collect()
}
