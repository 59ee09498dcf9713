//! Rows as a table, on the terminal and as cells for others.

use super::super::table::{aligned, spread};
use super::{Against, Legs, Row};
use crate::text::{clean, count};

/// The columns, of which the first three are names.
pub(super) const COLUMNS: [&str; 8] = [
    "scene",
    "what",
    "leg",
    "clock",
    "time, ms",
    "items/s",
    "time an item over",
    "demand",
];

/// A row's cells.
pub(super) fn cells(row: &Row) -> [String; COLUMNS.len()] {
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
    let mut table = vec![COLUMNS.map(str::to_owned)];
    table.extend(legs.rows.iter().map(cells));
    let mut lines: Vec<String> = aligned(&table, 3).collect();
    lines.extend(verdict(legs));
    lines
}
