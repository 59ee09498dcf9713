//! What must hold of every step, and of all of them.

use super::super::judge::{Wrong, of_rows, refusal, unreached};
use super::{Bound, Measured};

/// What does not hold of a step. `legs` are all that must have a row.
pub fn judge(measured: &Measured, legs: &[String]) -> Vec<Wrong> {
    let wrong = |stage: &str, leg: &str, what: String| Wrong {
        sweep: measured.sweep.to_owned(),
        step: measured.step.clone(),
        stage: stage.to_owned(),
        leg: leg.to_owned(),
        what,
    };
    let refused = refusal(
        (measured.sweep, &measured.step),
        measured.must_refuse,
        measured.refused.as_deref(),
    );
    if let Some(all) = refused {
        return all;
    }
    let mut all = of_rows(measured.sweep, &measured.step, &measured.rows, legs);
    let walks = &measured.walks;
    if walks.longest > walks.bound {
        let what = format!(
            "a ray passes {} cells, may at most {}",
            walks.longest, walks.bound
        );
        all.push(wrong("trace", "spec", what));
    }
    if walks.steps > walks.cells {
        let what = format!("{} steps over bricks, {} cells", walks.steps, walks.cells);
        all.push(wrong("trace", "spec", what));
    }
    all
}

/// Bounds that are nowhere of use, over all steps.
pub fn useless(all: &[Measured]) -> Vec<Wrong> {
    unreached(Bound::ALL.map(|bound| {
        let steps = all.iter().filter_map(|m| m.worst(bound));
        let largest = steps.map(|(ratio, _)| ratio).fold(0.0, f64::max);
        (bound.name(), largest)
    }))
}
