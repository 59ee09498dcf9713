//! What is left out because it can change nothing, in time: each thing with and without, in turn on
//! one adapter, and the same answers both ways.
//!
//! - *Directions*: maps in whose direction no receiver's weight is more than 0.
//! - *Cropping*: of all maps, what lies beside the box around the receivers.
//! - *Dark directions*: maps through which no light comes, when stage `environment` asks.
//! - *Lists of one*: their keys, when lists are sorted. Against them stand kernels that take the
//!   only key of a run up and put it down again, and that merge a chain of one entry.
//! - *All keys*: a sort of the same maps with nothing in them. An empty list is no work to leave
//!   out: a sort reads where it begins and ends. What that costs is this time over all lists.
//!
//! How many lists there are of which length is counted.

mod built;
mod measure;
mod patch;
mod table;

use triptych_spec::ldm::Layers;

use super::super::Spread;

pub(super) use measure::measure;
pub use table::{csv, lines, page};

/// Lengths of lists that kernels treat differently, each up to this one: a sort leaves the first two,
/// has an invocation for one of the third kind, a workgroup for one of the fourth, and passes of
/// their own for longer ones.
const LENGTHS: [usize; 5] = [0, 1, 32, 512, usize::MAX];

/// What a sort of empty lists leaves out.
const ALL_KEYS: &str = "all keys";

/// A scene on an adapter.
#[derive(Clone, Debug, PartialEq)]
pub struct Skips {
    /// `family/case`, or the name of a scene of ours.
    pub scene: String,
    /// `gpu@adapter`.
    pub leg: String,
    /// Whose clock: `device` or `host`.
    pub clock: &'static str,
    /// Directions of the set.
    pub directions: u32,
    /// Pixels across the scene's diagonal.
    pub resolution: u32,
    /// What is left out.
    pub rows: Vec<Skip>,
    /// Lists of each of five kinds by their length (0, 1, 2 to 32, 33 to 512, longer), and their keys.
    pub lengths: [[u64; 2]; 5],
}

/// Something that is left out.
#[derive(Clone, Debug, PartialEq)]
pub struct Skip {
    /// What.
    pub what: &'static str,
    /// What is timed.
    pub part: &'static str,
    /// It is left out, as always.
    pub planned: Side,
    /// It is not.
    pub full: Side,
    /// The full time over the planned one, in each round.
    pub ratio: Spread,
}

impl Skip {
    /// Nanoseconds of each list that the planned side works on; `None` if there is none.
    fn of_each(&self) -> Option<f64> {
        let lists = self.planned.pixels;
        (lists > 0).then(|| 1e6 * self.planned.time.median / lists as f64)
    }
}

/// What is worked on, and for how long.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Side {
    /// Maps that are worked on.
    pub maps: u64,
    /// Their pixels; of a sort, lists that it works on.
    pub pixels: u64,
    /// Their keys.
    pub keys: u64,
    /// Milliseconds.
    pub time: Spread,
}

/// Lists of each kind, and their keys.
fn lengths(layers: &Layers) -> [[u64; 2]; 5] {
    let mut all = [[0; 2]; 5];
    for run in layers.offsets.windows(2) {
        let length = (run[1] - run[0]) as usize;
        let kind = LENGTHS.partition_point(|most| *most < length);
        all[kind][0] += 1;
        all[kind][1] += length as u64;
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_are_of_five_kinds() {
        let layers = Layers {
            offsets: vec![0, 0, 1, 1, 3, 35, 68, 580, 1093],
            keys: Vec::new(),
        };
        let must = [[2, 0], [1, 1], [2, 2 + 32], [2, 33 + 512], [1, 513]];
        assert_eq!(lengths(&layers), must);
    }
}
