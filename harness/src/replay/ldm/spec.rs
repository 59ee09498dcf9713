//! The spec's side: the maps of every rotation, and what is open and lit through them.

use std::time::Duration;

use triptych_spec::bound::{Bounded, Real};
use triptych_spec::ldm::{
    self, Hits, Layers, Map, Maps, Mirrored, Open, nearness, neighbours, openness, weight,
};
use triptych_spec::rsm::{Colour, DARK};

use super::limits;
use super::setup::{Setup, Turn};
use super::tally::Tally;
use super::turned::render;
use crate::plan::LdmPlan;
use crate::replay::rows::Spot;
use crate::report::Picture;
use crate::scene::{Loaded, Mistake};

/// Everything that the spec says about a scene with maps.
pub struct LdmRun {
    /// What all rotations share.
    pub setup: Setup,
    /// The rotations, in order.
    pub turns: Vec<LdmTurn>,
    /// What is open over each receiver, all rotations together.
    pub open: Vec<Open>,
    /// The part of its hemisphere that is open, from 0 to about 1.
    pub openness: Vec<Bounded>,
    /// Irradiance over pi of each receiver, the mean of all rotations.
    pub light: Vec<Colour>,
    /// Whether there is a sky, and so light.
    pub lit: bool,
    /// What each receiver mirrors, in the nearest direction of all rotations; nothing if nothing
    /// mirrors.
    pub mirrored: Vec<Mirrored>,
    /// Linear colour where nothing is seen.
    pub background: [f32; 3],
    /// What was counted, and hashed where it is not held.
    pub tally: Tally,
    /// Time of each stage.
    pub times: Times,
}

/// A rotation.
pub struct LdmTurn {
    /// Its maps: those that somebody needs.
    pub maps: Maps,
    /// All their lists.
    pub layers: Layers,
    /// Radiance from both sides of each map.
    pub sky: Vec<ldm::Sky>,
    /// Which maps light comes through.
    pub lit: Vec<bool>,
    /// What is open over each receiver.
    pub open: Vec<Open>,
    /// Irradiance over pi of each receiver; nothing without a sky.
    pub light: Vec<Colour>,
    /// What each receiver mirrors; nothing if nothing mirrors.
    pub mirrored: Vec<Mirrored>,
}

/// Time of each stage.
#[derive(Clone, Copy, Debug, Default)]
pub struct Times {
    /// Stage layers.
    pub layers: Duration,
    /// Stage neighbours.
    pub neighbours: Duration,
    /// Stage occlusion.
    pub occlusion: Duration,
    /// Stage environment.
    pub environment: Duration,
    /// Stage mirror.
    pub mirror: Duration,
}

impl LdmRun {
    /// Runs all stages of all rotations, but for directions and stages that the plan leaves out,
    /// which would give the same.
    ///
    /// # Errors
    /// One line for a scene beyond a limit, with the key to change.
    pub fn new(loaded: &Loaded, skip: bool) -> Result<Self, Mistake> {
        let setup = Setup::new(loaded)?;
        let plan = LdmPlan::new(loaded, skip);
        // Without anybody who asks there is nothing to look at.
        let rotations = match setup.receivers.is_empty() && skip {
            true => 0,
            false => setup.rotations,
        };
        let turns = (0..rotations).map(|rotation| setup.turn(loaded, rotation, skip));
        let turns: Vec<Turn> = turns.collect::<Result<_, _>>()?;
        limits::check(&setup.blockers, &turns)?;
        let mut tally = Tally::default();
        let mut times = Times::default();
        let [lit, mirrors] = ["environment", "mirror"].map(|name| plan.skipped(name).is_none());
        let render = |turn| render(&setup, turn, [lit, mirrors], &mut tally, &mut times);
        let turns: Vec<LdmTurn> = turns.into_iter().map(render).collect::<Result<_, _>>()?;
        let (open, light) = summed(&turns, setup.receivers.len());
        let directions = setup.directions * setup.rotations;
        Ok(Self {
            openness: open.iter().map(|o| openness(o, directions)).collect(),
            mirrored: nearest(&setup, &turns),
            background: loaded.scene.background,
            open,
            light,
            lit,
            setup,
            turns,
            tally,
            times,
        })
    }

    /// The sum of a receiver's weights in all maps of all rotations, whatever is open: that of
    /// [`Open::whole`] where everything is.
    pub fn weights(&self, receiver: usize) -> u32 {
        let normal = self.setup.receivers[receiver].receiver.normal;
        let maps = self.turns.iter().flat_map(|turn| &turn.maps.maps);
        maps.map(|map| weight(map, normal).unsigned_abs()).sum()
    }

    /// The picture by the light of the sky, with bounds: the colour of what is seen times the
    /// light that it gets.
    pub fn picture(&self) -> Vec<Colour> {
        let background = self.background.map(|c| Bounded::exact(f64::from(c)));
        let mut picture = vec![background; self.setup.eye.size.pixels()];
        for (asker, light) in self.setup.receivers.iter().zip(&self.light) {
            let colour = self.setup.model.colours[asker.triangle as usize];
            let lit = |i: usize| light[i].mul(Bounded::exact(f64::from(colour[i])));
            picture[asker.pixel as usize] = [lit(0), lit(1), lit(2)];
        }
        picture
    }
}

impl LdmRun {
    /// Sub-pixel bits of all maps.
    pub fn bits(&self) -> u32 {
        self.turns.first().map_or(0, |turn| turn.maps.bits)
    }

    /// Which pixels differ, and why; `None` if none does.
    pub fn causes(&self, spots: &[Spot]) -> Option<Picture> {
        super::pictures::causes(self, spots)
    }
}

impl LdmTurn {
    /// What a receiver finds in each map, in order.
    pub fn hits<'t>(
        &'t self,
        receiver: &'t ldm::Receiver,
    ) -> impl Iterator<Item = (&'t Map, Hits)> + 't {
        let maps = self.maps.maps.iter();
        maps.map(|map| (map, neighbours(&self.maps, map, &self.layers, receiver)))
    }

    /// What was found in all maps, with the light from both sides of each.
    pub fn all_hits<'t>(
        &'t self,
        found: &'t [(&'t Map, Hits)],
    ) -> impl Iterator<Item = (&'t Map, Hits, &'t ldm::Sky)> {
        let of = found.iter().zip(&self.sky);
        of.map(|((map, hits), sky)| (*map, *hits, sky))
    }

    /// What was found in the maps that light comes through, with the light.
    pub fn lit_hits<'t>(
        &'t self,
        found: &'t [(&'t Map, Hits)],
    ) -> impl Iterator<Item = (&'t Map, Hits, &'t ldm::Sky)> {
        let of = found.iter().zip(self.sky.iter().zip(&self.lit));
        let of = of.filter(|(_, (_, lit))| **lit);
        of.map(|((map, hits), (sky, _))| (*map, *hits, sky))
    }
}

/// What is mirrored in the nearest direction of all rotations; of equals in the first.
fn nearest(setup: &Setup, turns: &[LdmTurn]) -> Vec<Mirrored> {
    let near = |turn: &LdmTurn, receiver: usize| {
        let (asker, found) = (&setup.receivers[receiver], turn.mirrored[receiver]);
        let map = &turn.maps.maps[found.map? as usize];
        let near = nearness(map, asker.receiver.normal, asker.view)?;
        Some((near, found))
    };
    let asked = turns.first().map_or(0, |turn| turn.mirrored.len());
    let nearest = |receiver| {
        let all = turns.iter().filter_map(|turn| near(turn, receiver));
        let nearer = all.reduce(|best, one| if one.0 > best.0 { one } else { best });
        nearer.map_or(Mirrored::default(), |(_, found)| found)
    };
    (0..asked).map(nearest).collect()
}

/// Sums over rotations: what is open, and the mean of the light.
fn summed(turns: &[LdmTurn], receivers: usize) -> (Vec<Open>, Vec<Colour>) {
    let mut open = vec![
        Open {
            whole: 0,
            part: Bounded::exact(0.0),
        };
        receivers
    ];
    let mut light = vec![DARK; receivers];
    for turn in turns {
        for (sum, one) in open.iter_mut().zip(&turn.open) {
            // At most 4096 weights of 2^19.
            sum.whole += one.whole;
            sum.part = sum.part.add(one.part);
        }
        for (sum, one) in light.iter_mut().zip(&turn.light) {
            *sum = [0, 1, 2].map(|i| sum[i].add(one[i]));
        }
    }
    let share = Bounded::once(1.0 / f64::from(u32::try_from(turns.len().max(1)).expect("few")));
    let mean = |colour: Colour| match turns.len() {
        0 | 1 => colour,
        _ => colour.map(|channel| channel.mul(share)),
    };
    (open, light.into_iter().map(mean).collect())
}
