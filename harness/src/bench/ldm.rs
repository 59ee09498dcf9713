//! Layered depth maps: how long maps take to be made and asked, against how far what they say is
//! open is from what rays say; over the number of directions and the resolution.
//!
//! Lists are runs of one array; at a scene's own setting, and at a resolution of 50, they are built
//! as the paper's linked lists as well.
//!
//! A frame is everything from corners on the lattice to what is open over each receiver: lists of
//! all maps built anew, and all of them asked. Not timed: transfers, compilation, what the eye
//! sees, the rows of maps.
//!
//! [`skips`] measures what the plan leaves out, [`rival`] horizons in screen space.
//!
//! Two references separate what the parameters cost: Embree's rays in the same directions, from
//! which maps differ by their resolution alone, and its rays in random directions, whose own
//! variance is told. An adapter is measured only if its lists are the spec's, in maps that are
//! drawn by the spec for that, and its sums what the spec makes of them, at some receivers.

mod case;
mod flip;
mod front;
mod gpu;
mod judge;
pub mod rival;
mod rounds;
mod run;
mod scenes;
pub mod skips;
mod table;

use super::{Machine, Spread};

pub use front::svg;
pub use run::{Options, run};
pub use table::{csv, lines, page};

/// Scenes that are not of the corpus, by name: the paper's Figures 8 and 9, a Sponza and a ball of
/// fur in place of its hairball.
pub const SCENES: [(&str, &str); 2] = [
    ("sponza", include_str!("ldm/sponza.toml")),
    ("furball", include_str!("ldm/furball.toml")),
];

/// A run: where, and what was measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Sweep {
    /// When, year-month-day.
    pub date: String,
    /// Where.
    pub machine: Machine,
    /// Rounds that counted.
    pub runs: u32,
    /// What was measured.
    pub rows: Vec<Row>,
    /// Maps and their rival, if that was asked for.
    pub contests: Vec<rival::Contest>,
    /// What the plan leaves out, if that was asked for.
    pub skips: Vec<skips::Skips>,
    /// Of each scene, what random rays and maps say is open, and FLIP between them, as PNG.
    pub pictures: Vec<(String, Vec<u8>)>,
    /// What was not, and why; whose clock is not the device's.
    pub remarks: Vec<String>,
}

/// Maps of a scene on one adapter.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// `family/case`, or the name of a scene of ours.
    pub scene: String,
    /// `gpu@adapter`.
    pub leg: String,
    /// Whose clock: `device` or `host`.
    pub clock: &'static str,
    /// How lists lie in memory.
    pub layout: Layout,
    /// Directions of the set.
    pub directions: u32,
    /// Pixels across the scene's diagonal.
    pub resolution: u32,
    /// Triangles in each map.
    pub triangles: u64,
    /// Points that ask.
    pub receivers: u64,
    /// Pixels of all maps.
    pub pixels: u64,
    /// Keys in them.
    pub keys: u64,
    /// Milliseconds from the first pass to lists in order.
    pub build: Spread,
    /// Milliseconds of each part.
    pub parts: Vec<(&'static str, Spread)>,
    /// Bytes of lists, and of all that a frame works on but receivers.
    pub memory: [u64; 2],
    /// The least time that the adapter needs for what a build must move, over the median.
    pub of_bound: Option<f64>,
    /// What asking the lists took, and found.
    pub asked: Option<Asked>,
}

/// How lists lie in memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layout {
    /// As runs of one array: counted, summed up, filled, sorted.
    Runs,
    /// As the paper's linked lists: linked in whatever order triangles come, then sorted. Nothing
    /// asks them: with keys as far apart as entries lie, there is no looking for one by halves.
    Chains,
}

/// Maps that were asked.
#[derive(Clone, Debug, PartialEq)]
pub struct Asked {
    /// Milliseconds from the first pass to the end of the last.
    pub frame: Spread,
    /// The least time that the adapter needs for what asking must move, over the median.
    pub of_bound: Option<f64>,
    /// Root of the mean squared difference of what is open from rays in the same directions, and
    /// the largest.
    pub same: [f64; 2],
    /// The same from random rays.
    pub random: [f64; 2],
    /// Root of the mean variance of what those say.
    pub noise: f64,
    /// The mean of FLIP between the picture of all that is open and that of random rays, and between
    /// two pictures of half of those rays; `None`: nobody looked.
    pub flip: Option<[f64; 2]>,
}

impl Layout {
    /// As tables have it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Runs => "runs",
            Self::Chains => "chains",
        }
    }
}

impl Sweep {
    /// The stem of the files.
    pub fn stem(&self) -> String {
        let what = match () {
            () if !self.contests.is_empty() => "ldm-rival",
            () if !self.skips.is_empty() => "ldm-skips",
            () => "ldm",
        };
        format!("{what}-{}-{}", self.date, self.machine.slug)
    }

    /// The name of a scene's picture.
    pub fn picture(&self, scene: &str) -> String {
        let plain = |c: char| if c.is_ascii_alphanumeric() { c } else { '-' };
        let scene: String = scene.chars().map(plain).collect();
        format!("{}-{scene}.png", self.stem())
    }
}
