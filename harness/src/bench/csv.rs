//! Rows as comma-separated values, one line each, in a fixed order of columns.

use super::rows::{BLENDS, ORDERS};
use super::{Bench, Row, Spread};
use crate::text::{self, quoted};

/// The columns. Times are in milliseconds, rates per second, memory in bytes, PSNR in
/// decibels or `exact`; `ratio` is over the same leg's time of all layers by sorting; `time` is from
/// snapped triangles on, `frame` from vertices on, both to the picture; what was not measured is empty.
///
/// `before_ms` is all that comes before lists, or layers, are put in order: surfaces and `build_ms`, which
/// is what makes lists, or bins; `resolve_ms` is `order_ms` and `blend_ms`.
pub const COLUMNS: [&str; 36] = [
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
    "samples",
    "frame_ms",
    "frame_ms_min",
    "frame_ms_max",
    "bytes_per_fragment",
    "bands",
    "vertices_ms",
    "build_ms",
    "resolve_ms",
];

/// The whole file, with a header.
pub fn csv(bench: &Bench) -> String {
    text::csv(COLUMNS, bench.rows.iter().map(values))
}

fn values(row: &Row) -> [String; COLUMNS.len()] {
    let before = row.of_parts(&["opaque"]) + row.build();
    let frame = |value: fn(Spread) -> f64| row.frame.map_or_else(String::new, |f| number(value(f)));
    let vertices = row.frame.map(|frame| frame.median - row.time.median);
    let vertices = vertices.map_or_else(String::new, number);
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
        row.runs.to_string(),
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
        number(before),
        number(row.of_parts(&ORDERS)),
        number(row.of_parts(&BLENDS)),
        row.samples.to_string(),
        frame(|of| of.median),
        frame(|of| of.min),
        frame(|of| of.max),
        row.of_fragment
            .map_or_else(String::new, |bytes| bytes.to_string()),
        row.bands.to_string(),
        vertices,
        number(row.build()),
        number(row.resolve()),
    ]
}

/// Six digits behind the point tell nanoseconds apart.
pub(super) fn number(value: f64) -> String {
    format!("{value:.6}")
}
