//! What came of a step.

use std::path::PathBuf;

use super::{Numbers, Step};
use crate::corpus::Entry;
use crate::replay::embree::WORLD;
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
    /// Depths of Embree's hits in screen space.
    Embree,
    /// Depths of Embree's hits in world space.
    World,
}

/// All of them, in the order of the stages.
pub fn bounded() -> [Bound; 6] {
    use Bound::{Clip, Embree, Resolve, Snap, Transform, World};
    [Transform, Clip, Snap, Resolve, Embree, World]
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
            Self::World => WORLD,
        }
    }

    /// Whether a row is of this stage.
    pub fn is_of(self, row: &Row) -> bool {
        match self {
            Self::Embree => row.class == Class::Vote && row.stage != WORLD,
            Self::World => row.class == Class::Vote && row.stage == WORLD,
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
        self.worst_of(|row| stage.is_of(row))
    }

    /// The same of the rows of which this is true.
    pub(super) fn worst_of(&self, is_of: impl Fn(&Row) -> bool) -> Option<(f64, &Row)> {
        worst_of(&self.rows, is_of)
    }

    /// Largest share of a vote's pairs that are in class edge or unresolved; `None` if
    /// none was asked for.
    pub fn edge(&self, vote: Bound) -> Option<f64> {
        let rows = self.rows.iter().filter(|row| vote.is_of(row));
        let asked = rows.filter(|row| row.skipped.is_none() || row.admitted > 0);
        asked.map(Row::admitted_share).reduce(f64::max)
    }

    /// Largest share of a GPU leg's items that went unjudged.
    pub fn unjudged(&self) -> f64 {
        let rows = self.rows.iter().filter(|row| row.class != Class::Vote);
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

/// The largest error over bound of some rows, and whose; `None` if nothing was compared.
pub(super) fn worst_of(rows: &[Row], is_of: impl Fn(&Row) -> bool) -> Option<(f64, &Row)> {
    let rows = rows.iter().filter(|row| is_of(row));
    let judged = rows.filter(|row| row.skipped.is_none());
    let ratios = judged.filter_map(|row| Some((row.error_over_bound?, row)));
    ratios.reduce(|a, b| if exceeds(b.0, a.0) { b } else { a })
}

/// Whether `b` is the larger of two errors over bound: one that is no number is larger
/// than all.
pub(super) fn exceeds(b: f64, a: f64) -> bool {
    b > a || b.is_nan()
}
