//! A rotation: its maps by themselves, and what receivers make of them by themselves, over the cores
//! and in order.

use triptych_spec::grid::Blockers;
use triptych_spec::ldm::{
    Hits, Layers, LdmError, Maps, Mirrored, Open, environment, layers, mirror, occlusion,
};
use triptych_spec::rsm::Colour;

use super::setup::{Asker, Setup, Turn};
use super::spec::{LdmTurn, Times};
use super::tally::Tally;
use crate::dispatch::share;
use crate::replay::spec::timed;
use crate::scene::Mistake;

/// Receivers whose finds are held at a time.
const HELD: usize = 1 << 12;

/// Receivers of a piece of work.
const RECEIVERS: usize = 64;

/// What a receiver makes of a rotation's maps.
struct Asked {
    hits: Vec<Hits>,
    open: Open,
    light: Option<Colour>,
    mirrored: Option<Mirrored>,
    times: Times,
}

/// A rotation's maps, and what every receiver makes of them: what they find is counted and hashed, one
/// after another, and not held.
pub(super) fn render(
    setup: &Setup,
    turn: Turn,
    with: [bool; 2],
    tally: &mut Tally,
    times: &mut Times,
) -> Result<LdmTurn, Mistake> {
    let (layers, at) = timed(|| drawn(&turn.maps, &setup.blockers));
    times.layers += at;
    let layers = layers.map_err(|e| e.to_string())?;
    let Turn { maps, sky, lit } = turn;
    tally.map(&maps, &layers);
    tally.dark += lit.iter().filter(|lit| !**lit).count() as u64;
    let mut turn = LdmTurn {
        maps,
        layers,
        sky,
        lit,
        open: Vec::with_capacity(setup.receivers.len()),
        light: Vec::new(),
        mirrored: Vec::new(),
    };
    for askers in setup.receivers.chunks(HELD) {
        let asked = share::map(askers, RECEIVERS, |asker| turn.asked(setup, asker, with));
        for one in asked {
            tally.hits(one.hits.iter());
            times.add(&one.times);
            turn.open.push(one.open);
            turn.light.extend(one.light);
            turn.mirrored.extend(one.mirrored);
        }
    }
    Ok(turn)
}

/// Stage layers, maps by themselves.
fn drawn(maps: &Maps, blockers: &Blockers) -> Result<Layers, LdmError> {
    let each = share::each(maps.maps.len(), |number| {
        let one = Maps {
            maps: vec![maps.maps[number].clone()],
            ..*maps
        };
        layers(&one, blockers)
    });
    let mut all = Layers::none();
    for one in each {
        all.append(one?)?;
    }
    Ok(all)
}

impl LdmTurn {
    /// What a receiver makes of the maps; light and mirrors if they are asked for.
    fn asked(&self, setup: &Setup, asker: &Asker, [with_light, mirrors]: [bool; 2]) -> Asked {
        let receiver = &asker.receiver;
        let mut times = Times::default();
        let (found, at) = timed(|| self.hits(receiver).collect::<Vec<_>>());
        times.neighbours = at;
        let hits = || found.iter().copied();
        let (open, at) = timed(|| occlusion(hits(), receiver.normal, setup.falloff));
        times.occlusion = at;
        let light = with_light.then(|| {
            let lit = self.lit_hits(&found);
            let (light, at) = timed(|| environment(lit, receiver.normal, setup.directions));
            times.environment = at;
            light
        });
        let mirrored = mirrors.then(|| {
            let all = self.all_hits(&found);
            let (mirrored, at) = timed(|| mirror(all, receiver.normal, asker.view));
            times.mirror = at;
            mirrored
        });
        Asked {
            hits: found.into_iter().map(|(_, hits)| hits).collect(),
            open,
            light,
            mirrored,
            times,
        }
    }
}

impl Times {
    fn add(&mut self, more: &Self) {
        self.neighbours += more.neighbours;
        self.occlusion += more.occlusion;
        self.environment += more.environment;
        self.mirror += more.mirror;
    }
}
