//! Time against error: what each number of nearest layers costs and how wrong it is, on
//! one core of the CPU and on every adapter and path.
//!
//! What is timed: everything from snapped triangles to the picture, that is emptying the
//! lists, stage opaque, stage build with coverage in it, and then either of two ways to
//! the `n` nearest layers. *Insertion* walks each list once, as it was built, and keeps
//! the `n` nearest in an array (`nearest_layers`). *Sort* sorts the lists and stops
//! after `n` layers; with all of them this is what a replay runs, stages sort and
//! resolve. *Tiles* are stages bin, jagged and shade, on the legs with a compute rasteriser. Other
//! techniques are in `rivals.rs`. The vertex stages are timed by themselves, and a frame from its
//! vertices on is both. Not timed: transfers and compilation.
//!
//! Every round runs every leg and every variant once, so that whatever slows a machine
//! down for a while slows all of them. Before the first that counts come [`WARM_UP`]
//! rounds, and more of them until each adapter was at work for [`WARM_UP_WORK`] by its own clock. A
//! board's clocks fall while others have their turn, so it is at work for [`AWAKE`] before each of
//! its own. The spec runs once, before the rounds. GPU times are the device's own timestamps. No picture is timed that was not
//! compared with the spec's, inside the spec's bound, before the rounds and after them.

pub mod ceiling;
pub mod counts;
pub mod csv;
pub mod dispatch;
pub mod error;
pub mod full;
mod gpu;
pub mod grid;
pub mod ldm;
pub mod legs;
pub mod machine;
pub mod markdown;
mod method;
pub mod paper;
mod pieces;
mod progress;
mod reference;
mod rivals;
mod rows;
pub mod rsm;
mod run;
mod scene;
pub mod share;
mod spec;
pub mod spread;
mod station;
pub mod svg;
pub mod table;
mod tiles;
mod warm;

use std::time::Duration;

use serde::{Deserialize, Serialize};

pub use ceiling::Ceilings;
pub use machine::Machine;
pub use method::Method;
pub use progress::Progress;
pub use run::{Options, Outcome, named, run};
pub use spread::Spread;

/// Rounds before the first that counts, at least.
pub const WARM_UP: u32 = 2;

/// Rounds that count, unless a number is asked for.
pub const RUNS: u32 = 21;

/// How long each adapter is at work on a scene before the first round that counts, at
/// least.
pub const WARM_UP_WORK: Duration = Duration::from_secs(1);

/// How long a board is at work before each round that counts: an H100 whose clocks fell in a
/// pause of a tenth of a second took six times as long for a frame.
pub const AWAKE: Duration = Duration::from_millis(100);

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

/// One leg, one number of layers, one method.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// `family/case`.
    pub scene: String,
    /// Pixels in a row, and rows.
    pub size: [u32; 2],
    /// Samples of a pixel.
    pub samples: u32,
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
    /// Rounds that counted.
    pub runs: u32,
    /// Milliseconds of a frame from its snapped triangles on.
    pub time: Spread,
    /// The same from its vertices on, if that was measured.
    pub frame: Option<Spread>,
    /// Times of a round over the same leg's of all layers by sorting, in that round.
    pub ratio: Spread,
    /// Median milliseconds of each part of a frame.
    pub parts: Vec<(String, f64)>,
    /// Decibels, [`error::psnr`]; `None` if nothing differs at all.
    pub psnr: Option<f64>,
    /// The largest difference of a channel from the exact picture.
    pub largest: f64,
    /// Bytes that the technique holds at most.
    pub memory: u64,
    /// Bytes of a stored fragment; `None`: it stores none.
    pub of_fragment: Option<u64>,
    /// Bands of rows that it is made in, one after another in the same buffers.
    pub bands: u32,
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
    /// The fastest method of each leg and number of layers: the legs in the order of the
    /// rows, and each leg's from one layer to all.
    pub fn fastest(&self) -> impl Iterator<Item = &Row> {
        self.shown().filter(|row| row.method.has_layers())
    }

    /// The same, and after each leg's all techniques that do not depend on that number.
    pub fn shown(&self) -> impl Iterator<Item = &Row> {
        let faster = |row: &Row| {
            let rival = |other: &&Row| {
                (&other.scene, &other.leg, other.layers) == (&row.scene, &row.leg, row.layers)
                    && other.method != row.method
                    && other.method.has_layers()
            };
            let mut rivals = self.rows.iter().filter(rival);
            !row.method.has_layers()
                || rivals
                    .all(|other| (row.time.median, row.method) < (other.time.median, other.method))
        };
        let mut fastest: Vec<&Row> = self.rows.iter().filter(|row| faster(row)).collect();
        let (scenes, legs) = (self.scenes(), self.legs());
        let place = |all: &[&str], name: &str| all.iter().position(|other| *other == name);
        fastest.sort_by_key(|row| {
            (
                place(&scenes, &row.scene),
                place(&legs, &row.leg),
                !row.method.has_layers(),
                row.layers,
                row.method,
            )
        });
        fastest.into_iter()
    }

    /// What is to be said of the scenes of which rows vary more than their figures bear.
    pub fn varying(&self) -> Vec<String> {
        let words = |scene: &&str| {
            let own = self.rows.iter().filter(|row| row.scene == *scene);
            let (all, vary) = own.fold((0, 0), |(all, vary), row| {
                (all + 1, vary + u32::from(row.time.varies()))
            });
            let words = format!(
                "times vary: {scene}: the maximum is more than twice the minimum in {vary} of \
                 {all} rows"
            );
            (vary > 0).then_some(words)
        };
        self.scenes().iter().filter_map(words).collect()
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

#[cfg(test)]
mod tests {
    use crate::report::bench_example;

    use super::{Bench, Method, Row};

    /// Rows as a run gives them: of each leg first those by insertion, then by sorting.
    fn rows() -> Bench {
        let mut bench = bench_example();
        let row = |leg: &str, method, layers, median| {
            let mut row = Row {
                leg: leg.to_owned(),
                method,
                layers,
                ..bench.rows[0].clone()
            };
            row.time.median = median;
            row
        };
        let of = |leg| {
            let (fast, slow) = (1.0, 2.0);
            [
                row(leg, Method::Insertion, 1, fast),
                row(leg, Method::Insertion, 2, fast),
                row(leg, Method::Insertion, 4, slow),
                row(leg, Method::Insertion, 8, fast),
                row(leg, Method::Sort, 1, slow),
                row(leg, Method::Sort, 2, slow),
                row(leg, Method::Sort, 4, fast),
                row(leg, Method::Sort, 8, slow),
            ]
        };
        bench.rows = [of("spec"), of("gpu@a/compute")].concat();
        bench
    }

    #[test]
    fn the_fastest_come_in_order_of_layers() {
        let bench = rows();
        let fastest = bench.fastest().map(|row| (row.leg.as_str(), row.layers));
        let all = [1, 2, 4, 8];
        let must = [all.map(|n| ("spec", n)), all.map(|n| ("gpu@a/compute", n))];
        assert_eq!(fastest.collect::<Vec<_>>(), must.concat());
        let by_sort = bench.fastest().filter(|row| row.method == Method::Sort);
        assert_eq!(by_sort.map(|row| row.layers).collect::<Vec<_>>(), [4, 4]);
    }

    #[test]
    fn times_that_vary_are_told() {
        let mut bench = rows();
        let mut vary = |at: usize, min, max| {
            let time = &mut bench.rows[at].time;
            (time.min, time.max) = (min, max);
        };
        (0..16).for_each(|at| vary(at, 1.0, 2.0));
        assert_eq!(bench.varying(), [""; 0], "twice is not more than twice");
        let time = &mut bench.rows[3].time;
        (time.min, time.max) = (0.7, 3.3);
        let must = "times vary: abuffer/<script>: the maximum is more than twice the minimum in 1 \
                    of 16 rows";
        assert_eq!(bench.varying(), [must]);
    }
}
