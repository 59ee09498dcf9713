//! Time against error: what each number of nearest layers costs and how wrong it is, on
//! one core of the CPU and on every adapter and path.
//!
//! What is timed: everything from snapped triangles to the picture, that is emptying the
//! lists, stage opaque, stage build with coverage in it, and then either of two ways to
//! the `n` nearest layers. *Insertion* walks each list once, as it was built, and keeps
//! the `n` nearest in an array (`nearest_layers`). *Sort* sorts the lists and stops
//! after `n` layers; with all of them this is what a replay runs, stages sort and
//! resolve. Not timed: transfers, compilation, and the vertex stages.
//!
//! Every round runs every leg and every variant once, so that whatever slows a machine
//! down for a while slows all of them; [`WARM_UP`] rounds come before the first that
//! counts. GPU times are the device's own timestamps. No picture is timed that was not
//! compared with the spec's, inside the spec's bound, before the rounds and after them.

pub mod ceiling;
pub mod counts;
pub mod csv;
pub mod error;
mod gpu;
mod grid;
pub mod legs;
pub mod machine;
pub mod markdown;
mod progress;
mod run;
mod scene;
mod spec;
pub mod spread;
pub mod svg;
pub mod table;

use serde::{Deserialize, Serialize};

pub use ceiling::Ceilings;
pub use machine::Machine;
pub use progress::Progress;
pub use run::{Options, Outcome, run};
pub use spread::Spread;

/// Rounds before the first that counts.
pub const WARM_UP: u32 = 2;

/// The scenes that are measured if none is asked for, each expensive in its own way:
/// opaque walls with a few layers of glass before them, as games have it; 871,414
/// triangles that are smaller than a pixel; and the longest lists of any real mesh here.
pub const SCENES: [&str; 3] = ["abuffer/sponza", "abuffer/dragon-full", "abuffer/furball"];

/// A run: where, what there is at most, and what was measured.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Bench {
    /// What was measured, `abuffer`.
    pub family: String,
    /// When, year-month-day.
    pub date: String,
    /// Where.
    pub machine: Machine,
    /// Rounds that counted.
    pub runs: u32,
    /// What each adapter, and one core, can do at most.
    pub ceilings: Vec<Ceilings>,
    /// What was measured, scene by scene, leg by leg.
    pub rows: Vec<Row>,
    /// What was not, and why; whose clock is not the device's.
    pub remarks: Vec<String>,
}

/// How the nearest layers are found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// One walk over the list as it was built.
    Insertion,
    /// The sorted list, up to the last layer that is shown.
    Sort,
}

impl Method {
    /// Its name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Insertion => "insertion",
            Self::Sort => "sort",
        }
    }
}

/// One leg, one number of layers, one method.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// `family/case`.
    pub scene: String,
    /// Pixels in a row, and rows.
    pub size: [u32; 2],
    /// Fragments in lists.
    pub fragments: u64,
    /// Fragments of the longest list.
    pub longest: u32,
    /// `spec`, or `gpu@adapter/path`.
    pub leg: String,
    /// Whose clock: `device` or `host`.
    pub clock: String,
    /// How.
    pub method: Method,
    /// Nearest layers shown.
    pub layers: u32,
    /// Whether these are all that any list has.
    pub all: bool,
    /// Milliseconds of a frame.
    pub time: Spread,
    /// Times of a round over the same leg's of all layers by sorting, in that round.
    pub ratio: Spread,
    /// Median milliseconds of each part of a frame.
    pub parts: Vec<(String, f64)>,
    /// Decibels, [`error::psnr`]; `None` if nothing differs at all.
    pub psnr: Option<f64>,
    /// The largest difference of a channel from the exact picture.
    pub largest: f64,
    /// Bytes that the technique holds, [`counts`].
    pub memory: u64,
    /// Fragments per second.
    pub fragments_per_second: f64,
    /// What bounds it: `bytes` or `atomics`.
    pub bound: String,
    /// Milliseconds that the bound allows at least.
    pub bound_ms: f64,
    /// `bound_ms` over the median time.
    pub fraction: f64,
}

impl Bench {
    /// The faster method of each leg and number of layers, in the order of the rows.
    pub fn fastest(&self) -> impl Iterator<Item = &Row> {
        let faster = |row: &Row| {
            let rival = |other: &&Row| {
                (&other.scene, &other.leg, other.layers) == (&row.scene, &row.leg, row.layers)
                    && other.method != row.method
            };
            let rival = self.rows.iter().find(rival);
            rival.is_none_or(|other| {
                (row.time.median, row.method) < (other.time.median, other.method)
            })
        };
        self.rows.iter().filter(move |row| faster(row))
    }

    /// The scenes, in the order of the rows.
    pub fn scenes(&self) -> Vec<&str> {
        in_order(self.rows.iter().map(|row| row.scene.as_str()))
    }

    /// The legs, in the order of the rows.
    pub fn legs(&self) -> Vec<&str> {
        in_order(self.rows.iter().map(|row| row.leg.as_str()))
    }
}

fn in_order<'a>(names: impl Iterator<Item = &'a str>) -> Vec<&'a str> {
    let mut seen = Vec::new();
    for name in names {
        if !seen.contains(&name) {
            seen.push(name);
        }
    }
    seen
}
