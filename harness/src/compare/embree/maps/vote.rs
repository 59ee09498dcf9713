//! What the comparison of maps with Embree amounts to.

use std::fmt;

use crate::cause::Cause;
use crate::compare::{DESCRIBED_MAX, Judgement};
use crate::row::Class;

/// Result of one comparison.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MapVote {
    /// Pixels whose rays were traced.
    pub rays: u64,
    /// Pairs of a pixel and a triangle that were looked at.
    pub pairs: u64,
    /// Pairs in class edge.
    pub edge: u64,
    /// Keys in the lists of those pixels.
    pub keys: u64,
    /// Times compared.
    pub times: u64,
    /// Largest error of a time over its bound.
    pub error_over_bound: f64,
    /// What the two see differently.
    pub disagree: u64,
    /// The first of it.
    pub first: Vec<MapDisagreement>,
}

/// Something that Embree and a list see differently.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapDisagreement {
    /// Number of the map.
    pub map: usize,
    /// Row-major number of the pixel in it.
    pub pixel: u32,
    /// What is seen differently.
    pub conflict: MapConflict,
}

/// In what they differ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MapConflict {
    /// Where the triangle is drawn is not where it is.
    Projection {
        /// The triangle.
        prim: u32,
    },
    /// The ray meets the triangle, and Embree does not report it.
    Missed {
        /// The triangle.
        prim: u32,
    },
    /// Embree reports a triangle that the ray does not meet.
    Invented {
        /// The triangle.
        prim: u32,
    },
    /// Embree's time is not within its bound.
    Time {
        /// The triangle.
        prim: u32,
    },
    /// Keys of the list do not rise.
    Order,
    /// A key that no triangle explains.
    Key {
        /// The key.
        key: u32,
    },
    /// A triangle without its key.
    Lost {
        /// The least that it may be.
        low: f64,
        /// The largest.
        high: f64,
    },
}

impl MapVote {
    /// Counts a disagreement.
    pub(super) fn differs(&mut self, disagreement: MapDisagreement) {
        self.disagree += 1;
        self.keep(disagreement);
    }

    fn keep(&mut self, disagreement: MapDisagreement) {
        if self.first.len() < DESCRIBED_MAX {
            self.first.push(disagreement);
        }
    }

    /// Adds the maps that follow.
    pub fn add(&mut self, next: Self) {
        self.rays += next.rays;
        self.pairs += next.pairs;
        self.edge += next.edge;
        self.keys += next.keys;
        self.times += next.times;
        self.error_over_bound = self.error_over_bound.max(next.error_over_bound);
        self.disagree += next.disagree;
        for disagreement in next.first {
            self.keep(disagreement);
        }
    }

    /// As a row has it; `edge_budget` is the largest share of pairs that may be in class edge,
    /// `None` where it is counted only. A vote alone cannot say who errs.
    pub fn judgement(&self, edge_budget: Option<f64>) -> Judgement {
        let cause = (self.disagree > 0).then_some((Cause::OracleDisagreement, self.disagree));
        // Pairs that are admitted unseen say nothing.
        let nothing = self.pairs == self.edge && self.disagree == 0;
        let reason = || match self.pairs {
            0 => "no pixel that was asked about is near a triangle".to_owned(),
            pairs => format!("all {pairs} pairs are in class edge"),
        };
        Judgement {
            skipped: nothing.then(reason),
            compared: self.pairs,
            causes: cause.into_iter().collect(),
            admitted: self.edge,
            admitted_budget: edge_budget,
            error_over_bound: (self.times > 0).then_some(self.error_over_bound),
            described: self.first.iter().map(ToString::to_string).collect(),
            note: self.to_string(),
            ..Judgement::new(Class::Vote, "pairs")
        }
    }
}

impl fmt::Display for MapVote {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{} pixels with {} keys; {} of {} pairs in class edge, {} times, error over bound {:.3}",
            self.rays, self.keys, self.edge, self.pairs, self.times, self.error_over_bound,
        )
    }
}

impl fmt::Display for MapDisagreement {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "map {} pixel {}: ", self.map, self.pixel)?;
        match self.conflict {
            MapConflict::Projection { prim } => {
                write!(f, "triangle {prim} is not drawn where it is")
            }
            MapConflict::Missed { prim } => {
                write!(f, "triangle {prim} is met, but Embree does not report it")
            }
            MapConflict::Invented { prim } => {
                write!(f, "Embree reports triangle {prim}, which is not met")
            }
            MapConflict::Time { prim } => write!(f, "Embree's time of triangle {prim}"),
            MapConflict::Order => write!(f, "the list does not rise"),
            MapConflict::Key { key } => write!(f, "no triangle explains key {key}"),
            MapConflict::Lost { low, high } => {
                write!(
                    f,
                    "a triangle with a key from {low:.1} to {high:.1} is lost"
                )
            }
        }
    }
}
