//! What came of a step.

use std::path::PathBuf;

use super::{Numbers, Step};
use crate::corpus::Entry;
use crate::row::{Class, Row};

/// A stage whose results have a bound.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Bound {
    /// Positions.
    Transform,
    /// Corners of clipped polygons.
    Clip,
    /// Corners on the grid.
    Snap,
    /// Blended colours.
    Resolve,
    /// Depths of Embree's hits.
    Embree,
}

/// All of them, in the order of the stages.
pub fn bounded() -> [Bound; 5] {
    use Bound::{Clip, Embree, Resolve, Snap, Transform};
    [Transform, Clip, Snap, Resolve, Embree]
}

impl Bound {
    /// What tables call it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Transform => "transform",
            Self::Clip => "clip",
            Self::Snap => "snap",
            Self::Resolve => "resolve",
            Self::Embree => "embree",
        }
    }

    /// Whether a row is of this stage.
    pub fn is_of(self, row: &Row) -> bool {
        match self {
            Self::Embree => row.class == Class::Vote,
            stage => row.class == Class::Interval && row.stage == stage.name(),
        }
    }
}

/// What came of a step.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// Name of its sweep.
    pub sweep: &'static str,
    /// The number that the sweep varies, as it is written.
    pub step: String,
    /// The number.
    pub value: f64,
    /// Its scene, to replay it again.
    pub path: PathBuf,
    /// The comparisons.
    pub rows: Vec<Row>,
    /// How many of its numbers `f32` cannot hold well.
    pub numbers: Numbers,
}

impl Measured {
    /// From a step's rows. One of which everything went unjudged, inside its budget, has
    /// compared nothing, and says so.
    pub fn new(
        sweep: &'static str,
        step: &Step,
        entry: &Entry,
        mut rows: Vec<Row>,
        numbers: Numbers,
    ) -> Self {
        for row in &mut rows {
            let nothing = row.skipped.is_none() && row.differ == 0 && row.admitted > 0;
            let within = row.admitted_budget.is_some_and(|budget| budget >= 1.0);
            if nothing && within && row.compared <= row.admitted {
                let Row { admitted, unit, .. } = &row;
                row.skipped = Some(format!("all {admitted} {unit} unjudged"));
                row.compared = 0;
            }
        }
        Self {
            sweep,
            step: step.label.clone(),
            value: step.value,
            path: entry.path.clone(),
            rows,
            numbers,
        }
    }

    /// The largest error over bound of a stage, and whose; `None` if nothing was compared.
    pub fn worst(&self, stage: Bound) -> Option<(f64, &Row)> {
        let rows = self.rows.iter().filter(|row| stage.is_of(row));
        let judged = rows.filter(|row| row.skipped.is_none());
        let ratios = judged.filter_map(|row| Some((row.error_over_bound?, row)));
        ratios.reduce(|a, b| if b.0 > a.0 || b.0.is_nan() { b } else { a })
    }

    /// Share of Embree's pairs that are in class edge or unresolved.
    pub fn edge(&self) -> Option<f64> {
        let mut rows = self.rows.iter().filter(|row| Bound::Embree.is_of(row));
        rows.next().map(Row::admitted_share)
    }

    /// Largest share of a GPU leg's items that went unjudged.
    pub fn unjudged(&self) -> f64 {
        let rows = self.rows.iter().filter(|row| !Bound::Embree.is_of(row));
        rows.map(Row::admitted_share).fold(0.0, f64::max)
    }

    /// Items compared, over all legs.
    pub fn compared(&self) -> u64 {
        self.rows.iter().map(|row| row.compared).sum()
    }

    /// What was not compared, and why.
    pub fn skipped(&self) -> impl Iterator<Item = (&Row, &str)> {
        let reason = |row: &'_ Row| row.skipped.is_some();
        let rows = self.rows.iter().filter(move |row| reason(row));
        rows.map(|row| (row, row.skipped.as_deref().unwrap_or_default()))
    }
}
