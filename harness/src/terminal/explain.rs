//! Lines under a scene that diverges: where first, why, and how to run just that.

use std::collections::BTreeMap;

use console::Style;

use super::SceneResult;
use super::ink::Ink;
use crate::again::Again;
use crate::cause::Cause;
use crate::digest::Pair;
use crate::row::{Class, Row, Verdict};
use crate::text::{clean, count, plural, share};

/// For each pair of legs the first stage that diverges: an error belongs to the
/// first stage that has it, later ones inherit it and are only counted.
pub fn scene(scene: &SceneResult, pairs: &[Pair<'_>], again: &Again, ink: Ink) -> Vec<String> {
    let mut lines = Vec::new();
    if pairs.is_empty() {
        let command = again.scene(&scene.argument);
        lines.push("   nothing was compared, and no reason is known".to_owned());
        lines.push(ink.paint(&format!("     again: {}", clean(&command)), Style::dim));
    }
    let diverges = |row: &&&Row| row.verdict() == Verdict::Diverge;
    for pair in pairs {
        let mut rows = pair.rows.iter().filter(diverges);
        let Some(row) = rows.next() else { continue };
        // A stage may have a row for each of its results.
        let rows = rows.filter(|r| r.stage != row.stage);
        let mut later: Vec<&str> = rows.map(|r| r.stage.as_str()).collect();
        later.dedup();
        if lines.is_empty() && !scene.purpose.is_empty() {
            let purpose = format!("   for: {}", clean(&scene.purpose));
            lines.push(ink.paint(&purpose, Style::dim));
        }
        let head = format!("{} against {}, {}", row.a, row.b, row.stage);
        lines.push(format!(
            "   {} {}",
            ink.paint(&format!("{}:", clean(&head)), Style::bold),
            finding(row)
        ));
        if !row.note.is_empty() {
            lines.push(format!("     {}", clean(&row.note)));
        }
        if !later.is_empty() {
            let later = later.join(", ");
            lines.push(format!("     later stages diverge too: {}", clean(&later)));
        }
        let command = format!("     again: {}", again.row(row, &scene.argument));
        lines.push(ink.paint(&clean(&command), Style::dim));
    }
    lines
}

/// What is wrong with a row that diverges, in a sentence.
fn finding(row: &Row) -> String {
    let mut parts = Vec::new();
    if row.compared == 0 && row.differ == 0 && row.skipped.is_none() {
        parts.push("nothing compared, no reason given".to_owned());
    }
    if row.compared == 0 && row.differ > 0 {
        parts.push("failed before anything was compared".to_owned());
    } else if row.differ > 0 || row.unexplained > 0 {
        let (differ, compared) = (count(row.differ), count(row.compared));
        parts.push(format!(
            "{differ} of {compared} {} differ",
            clean(&row.unit)
        ));
    }
    if !row.causes.is_empty() {
        parts.push(causes(&row.causes));
    }
    if row.unexplained > 0 {
        parts.push(format!(
            "{} without a cause",
            plural(row.unexplained, "item")
        ));
    }
    if let Some(budget) = row.admitted_budget {
        let part = row.admitted_share();
        if part > budget {
            let (part, budget) = (share(part), share(budget));
            let key = match row.class {
                Class::Vote => "; budget.edge in its scene.toml states another",
                _ => "",
            };
            parts.push(format!("{part} not judged, the budget is {budget}{key}"));
        }
    }
    parts.join("; ")
}

/// `overflow 12, tie-order 3`, the most frequent first.
pub fn causes(causes: &BTreeMap<Cause, u64>) -> String {
    let mut causes: Vec<_> = causes.iter().collect();
    causes.sort_by_key(|&(_, n)| std::cmp::Reverse(n));
    let one = |(cause, n): (&Cause, &u64)| format!("{} {}", cause.name(), count(*n));
    causes.into_iter().map(one).collect::<Vec<_>>().join(", ")
}
