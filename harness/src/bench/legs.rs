//! Leg against leg: the spec on one core beside every adapter's hardware path, and the
//! Embree leg beside bare calls of `rtcIntersect1`.
//!
//! Of the spec and of each adapter the same two stages are timed, from the same snapped
//! triangles: `cover`, every fragment as a stream, and `build`, the fragments of
//! transparent triangles in lists, whatever opaque surface lies in front. The spec's stream
//! goes into memory that it had before, as an adapter's does; its lists grow, as in every
//! replay. Not timed: transfers, compilation, emptying an adapter's lists.
//!
//! Embree is asked for every hit of the ray through every sample, four times: by
//! [`crate::embree::bare::Bare::trace`], which is one call of `rtcIntersect1` with the
//! filter that collects; by `hits`, as a replay asks; again bare, on all threads; and by
//! [`crate::compare::embree::compare`], which is the leg of a replay. Tree, rays, filter
//! and threads are the same.
//!
//! Rounds run all of a scene in turn, every other one backwards; [`super::WARM_UP`] rounds
//! come before the first that counts. Ratios are taken within a round. A leg is measured only if
//! it counts as many fragments or hits as it must.

mod embree;
mod files;
mod run;
mod stages;
mod table;

pub(super) use run::stations;
pub(super) use stages::Station;

use super::{Machine, Spread};

pub use files::{csv, page, page_of};
pub use run::{Options, run};
pub use table::lines;

/// The scenes on which the spec is held against adapters, if none is asked for, beside
/// [`LAYERS`].
pub const STAGES: [&str; 1] = ["abuffer/dragon-full"];

/// A scene that is not of the corpus: 64 layers over a whole target.
pub const LAYERS: &str = include_str!("legs/layers.toml");

/// The scenes with many hits on which Embree is asked, if none is asked for.
pub const HITS: [&str; 3] = [
    "abuffer/dragon-full",
    "abuffer/sponza-glass",
    "abuffer/furball",
];

/// A run: where, and what was measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Legs {
    /// When, year-month-day.
    pub date: String,
    /// Where.
    pub machine: Machine,
    /// Rounds that counted.
    pub runs: u32,
    /// What was measured.
    pub rows: Vec<Row>,
    /// What was not, and why; whose clock is not the device's; what else the machine did.
    pub remarks: Vec<String>,
}

/// What one leg took for one thing.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// `family/case`.
    pub scene: String,
    /// `cover`, `build` or `hits`; of grids `build`, or how rays of which kind are traced.
    pub what: String,
    /// `spec`, `gpu@adapter/fragment`, or how Embree was asked.
    pub leg: String,
    /// Whose clock: `device` or `host`.
    pub clock: &'static str,
    /// Fragments or hits.
    pub items: u64,
    /// Milliseconds of a round.
    pub time: Spread,
    /// What it is held against; `None`: it is what others are held against.
    pub against: Option<Against>,
    /// What else is known.
    pub more: More,
}

/// What is known of some legs beside their times.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct More {
    /// Bytes that it works on.
    pub memory: Option<u64>,
    /// What bounds it, and the time that this allows at least over the median.
    pub bound: Option<(&'static str, f64)>,
    /// Items that it decides unlike the spec, of those that it was asked for beforehand.
    pub unlike: Option<[u64; 2]>,
}

/// A leg beside another.
#[derive(Clone, Debug, PartialEq)]
pub struct Against {
    /// The other.
    pub leg: String,
    /// Time of an item over the other's, round by round.
    pub ratio: Spread,
    /// The largest median that meets the demand; `None`: nothing is demanded.
    pub most: Option<f64>,
}

impl Row {
    /// Items per second, in the median round.
    pub fn rate(&self) -> f64 {
        1000.0 * self.items as f64 / self.time.median
    }
}

impl Against {
    /// Whether the demand is met; `None` if there is none.
    pub fn met(&self) -> Option<bool> {
        self.most.map(|most| self.ratio.median <= most)
    }
}

/// What a leg took, round by round.
pub(super) struct Taken {
    leg: String,
    clock: &'static str,
    items: u64,
    pub(super) seconds: Vec<f64>,
    pub(super) more: More,
}

impl Taken {
    pub(super) fn new(leg: impl Into<String>, clock: &'static str, items: u64) -> Self {
        Self {
            leg: leg.into(),
            clock,
            items,
            seconds: Vec::new(),
            more: More::default(),
        }
    }

    /// The median.
    pub(super) fn median(&self) -> f64 {
        Spread::of(self.seconds.iter().copied()).median
    }

    /// Times of an item over the other's.
    fn over(&self, other: &Self) -> Spread {
        let items = other.items as f64 / self.items as f64;
        let pairs = self.seconds.iter().zip(&other.seconds);
        Spread::of(pairs.map(|(own, others)| own / others * items))
    }

    pub(super) fn row(
        &self,
        scene: &str,
        what: &str,
        against: Option<(&Self, Option<f64>)>,
    ) -> Row {
        Row {
            scene: scene.to_owned(),
            what: what.to_owned(),
            leg: self.leg.clone(),
            clock: self.clock,
            items: self.items,
            time: Spread::of(self.seconds.iter().map(|s| 1000.0 * s)),
            against: against.map(|(other, most)| Against {
                leg: other.leg.clone(),
                ratio: self.over(other),
                most,
            }),
            more: self.more,
        }
    }
}

/// The order in which a round runs so many things: every other one backwards.
pub(super) fn order(round: u32, count: usize) -> impl Iterator<Item = usize> {
    let backwards = round % 2 == 1;
    (0..count).map(move |at| if backwards { count - 1 - at } else { at })
}

#[cfg(test)]
mod tests;
