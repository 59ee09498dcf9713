//! Rows as comma-separated values, one line each, in a fixed order of columns.

use super::{Bench, Row};
use crate::text::quoted;

/// The columns. Times are in milliseconds, rates per second, memory in bytes, PSNR in
/// decibels or `exact`; `ratio` is over the same leg's time of all layers by sorting.
pub const COLUMNS: [&str; 27] = [
    "scene",
    "width",
    "height",
    "fragments",
    "longest",
    "leg",
    "method",
    "layers",
    "all",
    "runs",
    "clock",
    "time_ms",
    "time_ms_min",
    "time_ms_max",
    "ratio",
    "ratio_min",
    "ratio_max",
    "psnr_db",
    "largest_difference",
    "memory_bytes",
    "fragments_per_second",
    "bound",
    "bound_ms",
    "fraction_of_bound",
    "before_ms",
    "order_ms",
    "blend_ms",
];

/// The whole file, with a header.
pub fn csv(bench: &Bench) -> String {
    let mut text = COLUMNS.join(",");
    text.push('\n');
    for row in &bench.rows {
        text.push_str(&values(row, bench.runs).join(","));
        text.push('\n');
    }
    text
}

fn values(row: &Row, runs: u32) -> [String; COLUMNS.len()] {
    let of = |names: &[&str]| {
        let parts = row
            .parts
            .iter()
            .filter(|(n, _)| names.contains(&n.as_str()));
        number(parts.fold(0.0, |sum, (_, ms)| sum + ms))
    };
    [
        // Names of scenes come from folders, which may be called anything.
        quoted(&row.scene).into_owned(),
        row.size[0].to_string(),
        row.size[1].to_string(),
        row.fragments.to_string(),
        row.longest.to_string(),
        quoted(&row.leg).into_owned(),
        row.method.name().to_owned(),
        row.layers.to_string(),
        row.all.to_string(),
        runs.to_string(),
        row.clock.clone(),
        number(row.time.median),
        number(row.time.min),
        number(row.time.max),
        number(row.ratio.median),
        number(row.ratio.min),
        number(row.ratio.max),
        row.psnr.map_or_else(|| "exact".to_owned(), number),
        format!("{:e}", row.largest),
        row.memory.to_string(),
        format!("{:.0}", row.fragments_per_second),
        row.bound.clone(),
        number(row.bound_ms),
        number(row.fraction),
        of(&["clear", "opaque", "build"]),
        of(&["nearest", "sort"]),
        of(&["blend"]),
    ]
}

/// Six digits behind the point tell nanoseconds apart.
pub(super) fn number(value: f64) -> String {
    format!("{value:.6}")
}
