//! What must hold of every step, and of all of them.

use std::fmt;

use super::measure::{Bound, Measured, bounded};
use crate::row::{Row, Verdict};

/// A bound whose largest error is below this share of it says nothing.
pub const USEFUL: f64 = 1e-3;

/// What does not hold, and where.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Wrong {
    /// Name of the sweep, or of all.
    pub sweep: String,
    /// The step; empty if it is of all steps.
    pub step: String,
    /// The stage.
    pub stage: String,
    /// Adapter and path, or Embree.
    pub leg: String,
    /// What is wrong, in words.
    pub what: String,
}

impl fmt::Display for Wrong {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            sweep,
            step,
            stage,
            leg,
            what,
        } = self;
        let space = if step.is_empty() { "" } else { " " };
        write!(f, "{sweep}{space}{step}, stage {stage}, {leg}: {what}")
    }
}

/// What does not hold of a step. `legs` are all that must have a row, were it to refuse.
pub fn judge(measured: &Measured, legs: &[String]) -> Vec<Wrong> {
    of_rows(measured.sweep, &measured.step, &measured.rows, legs)
}

/// What is wrong with what a step was refused with, or was not; `None` if it was not refused and
/// need not be, so that there is more to judge. `must` is a part of the words.
pub(super) fn refusal(
    (sweep, step): (&str, &str),
    must: Option<&str>,
    refused: Option<&str>,
) -> Option<Vec<Wrong>> {
    let what = match (must, refused) {
        (None, None) => return None,
        (Some(part), Some(words)) if words.contains(part) => return Some(Vec::new()),
        (Some(part), Some(words)) => {
            format!("is refused with \"{words}\", must be with \"{part}\"")
        }
        (Some(part), None) => format!("must be refused with \"{part}\""),
        (None, Some(words)) => format!("is refused: {words}"),
    };
    Some(vec![Wrong {
        sweep: sweep.to_owned(),
        step: step.to_owned(),
        stage: "all".to_owned(),
        leg: "spec".to_owned(),
        what,
    }])
}

/// What does not hold of a step's rows.
pub(super) fn of_rows(sweep: &str, step: &str, given: &[Row], legs: &[String]) -> Vec<Wrong> {
    let wrong = |stage: &str, leg: &str, what: String| Wrong {
        sweep: sweep.to_owned(),
        step: step.to_owned(),
        stage: stage.to_owned(),
        leg: leg.to_owned(),
        what,
    };
    let rows = given.iter();
    let mut all: Vec<Wrong> = rows
        .filter_map(|row| Some(wrong(&row.stage, &row.b, of_row(row)?)))
        .collect();
    let silent = legs
        .iter()
        .filter(|leg| !given.iter().any(|row| row.b == **leg));
    all.extend(silent.map(|leg| wrong("all", leg, "not a word of it".to_owned())));
    all
}

/// What is wrong with a row.
fn of_row(row: &Row) -> Option<String> {
    let Row {
        differ,
        compared,
        unit,
        note,
        ..
    } = row;
    let ratio = row.error_over_bound.unwrap_or(0.0);
    if *differ > 0 || row.unexplained > 0 {
        return Some(format!("{differ} of {compared} {unit} differ; {note}"));
    }
    if ratio > 1.0 || ratio.is_nan() {
        return Some(format!("error over bound is {ratio}, must be at most 1"));
    }
    let share = row.admitted_share();
    match row.admitted_budget {
        Some(budget) if share > budget => {
            Some(format!("share unjudged is {share}, at most {budget}"))
        }
        _ if row.verdict() == Verdict::Diverge => {
            Some("nothing was compared, and no reason is stated".to_owned())
        }
        _ => None,
    }
}

/// Stages whose bound is nowhere of use, over all steps.
pub fn useless(all: &[Measured]) -> Vec<Wrong> {
    let largest = |stage: Bound| {
        let steps = all.iter().filter_map(|m| m.worst(stage));
        steps.map(|(ratio, _)| ratio).fold(0.0, f64::max)
    };
    unreached(bounded().map(|stage| (stage.name(), largest(stage))))
}

/// Bounds of which the largest error over all steps is too small to be of use.
pub(super) fn unreached<'s>(largest: impl IntoIterator<Item = (&'s str, f64)>) -> Vec<Wrong> {
    let found = largest.into_iter().filter(|(_, ratio)| *ratio < USEFUL);
    let wrong = |(stage, ratio): (&str, f64)| Wrong {
        sweep: "all sweeps".to_owned(),
        step: String::new(),
        stage: stage.to_owned(),
        leg: "all legs".to_owned(),
        what: format!("error over bound is at most {ratio}, must reach {USEFUL} somewhere"),
    };
    found.map(wrong).collect()
}
