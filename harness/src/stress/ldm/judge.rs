//! What must hold of every step, and of all of them.

use super::super::judge::{Wrong, of_rows, refusal, unreached};
use super::{Bound, Form, Measured};

/// What the parts of an error may miss of the whole: four sums of at most 2^13 terms below 2 in
/// `f64`.
const REST: f64 = 1e-9;

/// What does not hold of a step. `legs` are all that must have a row.
pub fn judge(measured: &Measured, legs: &[String]) -> Vec<Wrong> {
    let m = measured;
    let refused = refusal((m.sweep, &m.step), m.must_refuse, m.refused.as_deref());
    if let Some(all) = refused {
        return all;
    }
    let mut all = of_rows(m.sweep, &m.step, &m.rows, legs);
    let mut wrong = |stage: &str, what: String| {
        all.push(Wrong {
            sweep: m.sweep.to_owned(),
            step: m.step.clone(),
            stage: stage.to_owned(),
            leg: "spec".to_owned(),
            what,
        });
    };
    let words = |first: &Option<String>| first.clone().unwrap_or_default();
    if m.counts[0] == 0 {
        wrong("all", "nobody asks".to_owned());
    }
    let found = &m.found;
    if found.wrong > 0 {
        let first = words(&found.first);
        let (wrong_of, of) = (found.wrong, found.sides);
        wrong(
            "neighbours",
            format!("{wrong_of} of {of} sides are not as the file has them; {first}"),
        );
    }
    for bound in [Bound::Key, Bound::Distance] {
        let ratio = m.worst(bound).map_or(0.0, |(ratio, _)| ratio);
        if !(..=1.0).contains(&ratio) {
            let name = bound.name();
            wrong(
                "neighbours",
                format!("error over bound of the {name} is {ratio}, must be at most 1"),
            );
        }
    }
    if m.alone.wrong > 0 {
        let (wrong_of, of) = (m.alone.wrong, m.alone.pairs);
        let first = words(&m.alone.first);
        wrong(
            "neighbours",
            format!("{wrong_of} of {of} points meet their own face; {first}"),
        );
    }
    if m.parts.rest > REST {
        wrong(
            "occlusion",
            format!("the parts of an error miss {:e} of it", m.parts.rest),
        );
    }
    if let Some(what) = of_form(m) {
        wrong("occlusion", what);
    }
    all
}

/// What does not hold though it must, as the scene is what it is.
fn of_form(m: &Measured) -> Option<String> {
    match m.form {
        Form::Any | Form::Alike => None,
        // Nothing but its own surface can be in the way of a point, and that only in maps in which
        // it is steeper than is told apart.
        Form::Convex => (m.covered_more > 0).then(|| {
            let of = m.counts[0];
            format!(
                "{} of {of} points are not open, which no steep face explains",
                m.covered_more
            )
        }),
        // A sheet's key at the middle of a pixel is as far from the surface's there as the sheet
        // is, but for the bounds of both, which are alike as they are parallel; and the surface's
        // there is within a band of the point's. So beyond two bands it is beyond the band.
        Form::Sheets => m.found.late.filter(|late| *late > 0.0).map(|late| {
            format!("a sheet is lost at {late} keys more than two bands and bounds of keys")
        }),
    }
}

/// Steps that say something else than the first of those that must be alike: powers of two, by
/// which a scene has the same points on the lattice.
pub fn unlike(all: &[Measured]) -> Vec<Wrong> {
    let alike = |m: &&Measured| m.form == Form::Alike && m.refused.is_none();
    let mut steps = all.iter().filter(alike);
    let Some(first) = steps.next() else {
        return Vec::new();
    };
    let wrong = |m: &Measured| Wrong {
        sweep: m.sweep.to_owned(),
        step: m.step.clone(),
        stage: "occlusion".to_owned(),
        leg: "spec".to_owned(),
        what: format!(
            "what is open is not what it is at {}, to the bit",
            first.step
        ),
    };
    steps.filter(|m| m.open != first.open).map(wrong).collect()
}

/// Bounds that are nowhere of use, over all steps.
pub fn useless(all: &[Measured]) -> Vec<Wrong> {
    unreached(Bound::ALL.map(|bound| {
        let steps = all.iter().filter_map(|m| m.worst(bound));
        let largest = steps.map(|(ratio, _)| ratio).fold(0.0, f64::max);
        (bound.name(), largest)
    }))
}
