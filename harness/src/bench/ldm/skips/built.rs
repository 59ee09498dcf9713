//! What is worked on, and rows of two that are timed in turn.

use triptych_spec::ldm::Maps;

use super::super::super::Spread;
use super::super::judge::Made;
use super::super::rounds::Rounds;
use super::{Side, Skip};

/// Maps with their lists.
#[derive(Clone, Copy)]
pub(super) struct Built<'m> {
    pub(super) maps: &'m Maps,
    pub(super) made: &'m Made,
}

impl Built<'_> {
    /// All of the maps.
    pub(super) fn side(self) -> Side {
        self.lit(&vec![true; self.maps.maps.len()])
    }

    /// Some of the maps.
    pub(super) fn lit(self, lit: &[bool]) -> Side {
        let offsets = &self.made.layers.offsets;
        let mut side = NONE;
        for (map, _) in self.maps.maps.iter().zip(lit).filter(|(_, lit)| **lit) {
            let pixels = map.size.width * map.size.height;
            let [start, end] = [map.first, map.first + pixels].map(|at| offsets[at as usize]);
            side.maps += 1;
            side.pixels += u64::from(pixels);
            side.keys += u64::from(end - start);
        }
        side
    }

    /// Lists of so many keys at least.
    pub(super) fn lists(self, least: u32) -> Side {
        let lengths = self
            .made
            .layers
            .offsets
            .windows(2)
            .map(|run| run[1] - run[0]);
        let mut side = Side {
            maps: self.maps.maps.len() as u64,
            ..NONE
        };
        for length in lengths.filter(|length| *length >= least) {
            side.pixels += 1;
            side.keys += u64::from(length);
        }
        side
    }
}

const NONE: Side = Side {
    maps: 0,
    pixels: 0,
    keys: 0,
    time: Spread {
        median: 0.0,
        min: 0.0,
        max: 0.0,
    },
};

/// A row of two frames in turn.
pub(super) fn skip(
    (what, part): (&'static str, &'static str),
    [planned, full]: [Side; 2],
    times: &[Rounds],
    of: impl Fn(&Rounds) -> Spread,
) -> Skip {
    let rounds = times[0].iter().zip(&times[1]);
    let one = |round: &Vec<f64>| of(&vec![round.clone()]).median;
    Skip {
        what,
        part,
        ratio: Spread::of(rounds.map(|(planned, full)| one(full) / one(planned))),
        planned: Side {
            time: of(&times[0]),
            ..planned
        },
        full: Side {
            time: of(&times[1]),
            ..full
        },
    }
}
