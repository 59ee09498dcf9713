//! Rows as a table, on the terminal and as cells for others.

use super::super::table::{aligned, mebibytes, spread};
use super::{Against, Legs, Row};
use crate::text::{clean, count, share};

/// The columns, of which the first are names.
const COLUMNS: [&str; 11] = [
    "scene",
    "what",
    "leg",
    "clock",
    "time, ms",
    "items/s",
    "time an item over",
    "demand",
    "memory",
    "of bound",
    "unlike the spec",
];

/// Those that hold words, from the left.
pub(super) const NAMES: usize = 4;

/// The heading and a row's cells, line by line, without columns that are empty in every row.
pub(super) fn table(legs: &Legs) -> Vec<Vec<String>> {
    let rows: Vec<_> = legs.rows.iter().map(cells).collect();
    let filled = |at: &usize| *at < NAMES || rows.iter().any(|row| !row[*at].is_empty());
    let kept: Vec<usize> = (0..COLUMNS.len()).filter(filled).collect();
    let heading = COLUMNS.map(str::to_owned);
    let lines = std::iter::once(&heading).chain(&rows);
    let of = |row: &[String; COLUMNS.len()]| kept.iter().map(|at| row[*at].clone()).collect();
    lines.map(of).collect()
}

/// A row's cells.
fn cells(row: &Row) -> [String; COLUMNS.len()] {
    let over = |against: &Against| {
        let ratio = spread(against.ratio, 1.0, 2);
        format!("{ratio} of {}", clean(&against.leg))
    };
    [
        clean(&row.scene).into_owned(),
        format!("{} {}", count(row.items), row.what),
        clean(&row.leg).into_owned(),
        row.clock.to_owned(),
        spread(row.time, 1.0, 2),
        format!("{:.1} M", row.rate() * 1e-6),
        row.against.as_ref().map_or_else(String::new, over),
        row.against.as_ref().map_or_else(String::new, demand),
        row.more.memory.map_or_else(String::new, mebibytes),
        row.more.bound.map_or_else(String::new, |(name, part)| {
            format!("{} {name}", share(part))
        }),
        row.more.unlike.map_or_else(String::new, |[unlike, of]| {
            format!("{unlike} of {}", count(of))
        }),
    ]
}

/// What was demanded, and whether it is met.
fn demand(against: &Against) -> String {
    let words = |most: f64| match against.met() {
        Some(true) => format!("at most {most}: met"),
        _ => format!("at most {most}: not met"),
    };
    against.most.map_or_else(String::new, words)
}

/// What all demands come to, in a line; `None` if there are none.
pub(super) fn verdict(legs: &Legs) -> Option<String> {
    let against = legs.rows.iter().filter_map(|row| row.against.as_ref());
    let met: Vec<bool> = against.filter_map(Against::met).collect();
    let yes = met.iter().filter(|met| **met).count();
    (!met.is_empty()).then(|| format!("{yes} of {} demands are met", met.len()))
}

/// Lines for a terminal.
pub fn lines(legs: &Legs) -> Vec<String> {
    let table = table(legs);
    let mut lines: Vec<String> = aligned(&table, NAMES - 1).collect();
    lines.extend(verdict(legs));
    lines
}
