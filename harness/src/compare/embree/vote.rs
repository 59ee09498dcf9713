//! What the comparison with Embree amounts to.

use std::collections::BTreeMap;
use std::fmt;

use crate::cause::Cause;

/// How many disagreements are kept for the note; all are counted.
const KEPT: usize = 8;

/// Result of one comparison. Counts are of pairs unless said otherwise.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EmbreeVote {
    /// Rays traced, one per sample.
    pub rays: u64,
    /// All pairs looked at: those covered or near an edge, and all of Embree's hits.
    pub pairs: u64,
    /// Pairs in class edge.
    pub edge: u64,
    /// Those of them where both say the same.
    pub edge_agreeing: u64,
    /// Pairs that Embree's arithmetic cannot resolve although they are not in
    /// class edge.
    pub unresolved: u64,
    /// Those of them where both say the same.
    pub unresolved_agreeing: u64,
    /// Samples inside a triangle that Embree does not report.
    pub missed: u64,
    /// Hits outside their triangle.
    pub invented: u64,
    /// Pairs inside that Embree reports: their depths are compared.
    pub depths: u64,
    /// Depths outside the bound.
    pub depths_outside: u64,
    /// Largest error of a depth, in keys.
    pub error_keys: f64,
    /// Largest error of a depth over its bound.
    pub error_over_bound: f64,
    /// Places in the rays' lists where the bounds tell two neighbours apart.
    pub steps: u64,
    /// Steps where Embree's order is not that of the keys.
    pub steps_disordered: u64,
    /// Hits reported again for the same ray and triangle; dropped.
    pub repeated: u64,
    /// The first disagreements, by pixel.
    pub first: Vec<Disagreement>,
}

/// One thing that Embree and the spec see differently.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disagreement {
    /// Row-major number of the pixel.
    pub pixel: u32,
    /// Row in the list of primitives.
    pub prim: u32,
    /// What is seen differently.
    pub conflict: Conflict,
}

/// In what they disagree.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Conflict {
    /// The spec covers the sample, Embree does not report the triangle.
    Missed,
    /// Embree reports the triangle, the spec does not cover the sample.
    Invented,
    /// Both see it, at different depths.
    Depth {
        /// The spec's key.
        key: u32,
        /// Embree's t as a key.
        embree: f64,
        /// Largest distance that the bound allows.
        bound: f64,
    },
    /// Embree sees it no farther than a triangle that is clearly nearer.
    Order,
}

impl EmbreeVote {
    /// Everything that the two see differently outside the admitted classes.
    pub fn disagreeing(&self) -> u64 {
        self.missed + self.invented + self.depths_outside + self.steps_disordered
    }

    /// Pairs counted but not judged.
    pub fn admitted(&self) -> u64 {
        self.edge + self.unresolved
    }

    /// The causes of [`Self::disagreeing`]. A vote alone cannot say who errs.
    pub fn causes(&self) -> BTreeMap<Cause, u64> {
        let count = self.disagreeing();
        (count > 0)
            .then_some((Cause::OracleDisagreement, count))
            .into_iter()
            .collect()
    }

    /// Notes a disagreement; the caller counts it.
    pub(super) fn keep(&mut self, disagreement: Disagreement) {
        if self.first.len() < KEPT {
            self.first.push(disagreement);
        }
    }

    /// Adds the rows that follow.
    pub(super) fn add(&mut self, next: Self) {
        self.rays += next.rays;
        self.pairs += next.pairs;
        self.edge += next.edge;
        self.edge_agreeing += next.edge_agreeing;
        self.unresolved += next.unresolved;
        self.unresolved_agreeing += next.unresolved_agreeing;
        self.missed += next.missed;
        self.invented += next.invented;
        self.depths += next.depths;
        self.depths_outside += next.depths_outside;
        self.error_keys = self.error_keys.max(next.error_keys);
        self.error_over_bound = self.error_over_bound.max(next.error_over_bound);
        self.steps += next.steps;
        self.steps_disordered += next.steps_disordered;
        self.repeated += next.repeated;
        for disagreement in next.first {
            self.keep(disagreement);
        }
    }
}

impl fmt::Display for EmbreeVote {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{} of {} pairs in class edge ({} agree), {} unresolved ({} agree), \
             {} depths, error over bound {:.3}",
            self.edge,
            self.pairs,
            self.edge_agreeing,
            self.unresolved,
            self.unresolved_agreeing,
            self.depths,
            self.error_over_bound,
        )?;
        match self.first.first() {
            Some(first) => write!(f, "; {} disagree, first: {first}", self.disagreeing()),
            None => Ok(()),
        }
    }
}

impl fmt::Display for Disagreement {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "pixel {} triangle {}: ", self.pixel, self.prim)?;
        match self.conflict {
            Conflict::Missed => write!(f, "covered, but Embree does not report it"),
            Conflict::Invented => write!(f, "not covered, but Embree reports it"),
            Conflict::Depth { key, embree, bound } => {
                write!(f, "key {key}, Embree {embree:.1}, bound {bound:.1}")
            }
            Conflict::Order => write!(f, "Embree has it before a clearly nearer one"),
        }
    }
}
