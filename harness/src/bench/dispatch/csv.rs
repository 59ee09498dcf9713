//! Rows as comma-separated values.

use super::{Measured, Row};
use crate::text::{self, quoted};

/// The columns; what was not measured is empty.
const COLUMNS: [&str; 17] = [
    "scene",
    "width",
    "height",
    "triangles",
    "rays",
    "method",
    "threads",
    "frames",
    "runs",
    "fps",
    "fps_min",
    "fps_max",
    "speed_up",
    "speed_up_min",
    "speed_up_max",
    "idle_ms_per_thread",
    "access_ms_all_threads",
];

/// The whole file, with a header.
pub fn csv(measured: &Measured) -> String {
    let rows = measured.rows.iter();
    text::csv(COLUMNS, rows.map(|row| values(measured, row)))
}

fn values(measured: &Measured, row: &Row) -> [String; COLUMNS.len()] {
    let number = |value: f64| format!("{value:.5}");
    let spent = |of: fn(super::Spent) -> f64| row.spent.map_or(String::new(), |s| number(of(s)));
    [
        quoted(&row.scene).into_owned(),
        row.size[0].to_string(),
        row.size[1].to_string(),
        row.triangles.to_string(),
        row.rays.to_string(),
        quoted(measured.name(row.method)).into_owned(),
        row.threads.to_string(),
        measured.frames.to_string(),
        measured.runs.to_string(),
        number(row.fps.median),
        number(row.fps.min),
        number(row.fps.max),
        number(row.speed_up.median),
        number(row.speed_up.min),
        number(row.speed_up.max),
        spent(|s| s.idle),
        spent(|s| s.access),
    ]
}
