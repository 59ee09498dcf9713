//! Rows of one scene, and what goes with them into the report.

use std::time::Duration;

use crate::cause::Cause;
use crate::compare::Judgement;
use crate::observe::Observed;
use crate::row::{Class, Row};

/// Rows as they come, with the differences that they stand for.
#[derive(Clone, Debug, Default)]
pub struct Rows {
    scene: String,
    family: String,
    /// The rows.
    pub rows: Vec<Row>,
    /// First differences of each row, in words.
    pub described: Vec<String>,
    /// Items that differ and have a pixel, over all rows.
    pub spots: Vec<Spot>,
    /// Stage and leg of the rows that have spots.
    pub seen_by: Vec<(String, String)>,
}

/// An item that differs at a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Spot {
    /// Row-major number of the pixel.
    pub pixel: u32,
    /// Why it differs.
    pub cause: Cause,
    /// Stage and leg, as a number in [`Rows::seen_by`].
    pub by: usize,
}

impl Rows {
    /// No rows yet.
    pub fn new(scene: &str, family: &str) -> Self {
        Self {
            scene: scene.into(),
            family: family.into(),
            ..Self::default()
        }
    }

    /// Adds the outcome of a comparison.
    pub fn add<A, B, T, U>(
        &mut self,
        stage: &str,
        a: &Observed<A, T>,
        b: &Observed<B, U>,
        judgement: Judgement,
    ) {
        let described = judgement.described.iter();
        self.described
            .extend(described.map(|words| format!("{stage}, {}: {words}", b.label)));
        let by = self.seen_by.len();
        let spot = |&(pixel, cause): &(u32, Cause)| Spot { pixel, cause, by };
        self.spots.extend(judgement.marks.iter().map(spot));
        if !judgement.marks.is_empty() {
            self.seen_by.push((stage.into(), b.label.clone()));
        }
        let mut note = judgement.note.clone();
        if let (true, Some(first)) = (note.is_empty(), judgement.described.first()) {
            note.clone_from(first);
        }
        // What was counted and not judged is no comparison.
        let compared = match judgement.skipped {
            Some(_) => 0,
            None => judgement.compared,
        };
        self.rows.push(Row {
            unit: judgement.unit.into(),
            compared,
            differ: judgement.differ(),
            unexplained: judgement.unexplained,
            admitted: judgement.admitted,
            admitted_budget: judgement.admitted_budget,
            error: judgement.error,
            error_over_bound: judgement.error_over_bound,
            causes: judgement.causes,
            ms_a: a.time.map(ms),
            ms_b: b.time.map(ms),
            note,
            skipped: judgement.skipped,
            ..self.blank(stage, &a.label, &b.label, judgement.class)
        });
    }

    /// Adds the rows of a piece of the scene's work.
    pub fn append(&mut self, part: Self) {
        let before = self.seen_by.len();
        let spot = |spot: Spot| Spot {
            by: before + spot.by,
            ..spot
        };
        self.rows.extend(part.rows);
        self.described.extend(part.described);
        self.spots.extend(part.spots.into_iter().map(spot));
        self.seen_by.extend(part.seen_by);
    }

    /// Adds a row that compared nothing, and why.
    pub fn skip(&mut self, stage: &str, a: &str, b: &str, class: Class, reason: String) {
        let skipped = Some(reason);
        self.rows.push(Row {
            skipped,
            ..self.blank(stage, a, b, class)
        });
    }

    /// Adds a row for a leg that failed: a lost device has a cause of its own, and
    /// anything else is unexplained.
    pub fn fail(&mut self, stage: &str, a: &str, b: &str, cause: Option<Cause>, reason: String) {
        let row = self.blank(stage, a, b, Class::Exact);
        self.described.push(format!("{stage}, {b}: {reason}"));
        self.rows.push(Row {
            differ: 1,
            unexplained: u64::from(cause.is_none()),
            causes: cause.into_iter().map(|c| (c, 1)).collect(),
            note: reason,
            ..row
        });
    }

    fn blank(&self, stage: &str, a: &str, b: &str, class: Class) -> Row {
        Row {
            scene: self.scene.clone(),
            family: self.family.clone(),
            stage: stage.into(),
            a: a.into(),
            b: b.into(),
            class,
            unit: String::new(),
            compared: 0,
            differ: 0,
            causes: std::collections::BTreeMap::new(),
            unexplained: 0,
            admitted: 0,
            admitted_budget: None,
            error: None,
            error_over_bound: None,
            skipped: None,
            cached: false,
            ms_a: None,
            ms_b: None,
            note: String::new(),
            again: String::new(),
        }
    }
}

fn ms(time: Duration) -> f64 {
    time.as_secs_f64() * 1e3
}
