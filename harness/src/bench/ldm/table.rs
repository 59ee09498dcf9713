//! Rows as tables: on the terminal, as a page that can be committed, as values.

use super::super::csv::number;
use super::super::table::{aligned, mebibytes, spread};
use super::super::{WARM_UP, markdown};
use super::case::SAMPLES;
use super::{Row, Sweep};
use crate::text::{clean, markdown as text, quoted};

/// Columns of the tables.
const COLUMNS: [&str; 14] = [
    "scene",
    "leg",
    "directions",
    "resolution",
    "triangles",
    "keys",
    "keys a pixel",
    "frame, ms",
    "parts, ms",
    "of bound",
    "lists",
    "memory",
    "RMSE, same",
    "RMSE, random",
];

/// Columns of the file of values; times are in milliseconds.
const VALUES: [&str; 24] = [
    "scene",
    "leg",
    "clock",
    "directions",
    "resolution",
    "triangles",
    "receivers",
    "pixels",
    "keys",
    "runs",
    "part",
    "time_ms",
    "time_ms_min",
    "time_ms_max",
    "frame_ms",
    "lists_bytes",
    "memory_bytes",
    "build_of_bound",
    "ask_of_bound",
    "rmse_same",
    "largest_same",
    "rmse_random",
    "largest_random",
    "noise",
];

fn cells(row: &Row) -> [String; COLUMNS.len()] {
    let parts = row.parts.iter();
    let parts = parts.map(|(name, time)| format!("{name} {:.3}", time.median));
    [
        clean(&row.scene).into_owned(),
        clean(&row.leg).into_owned(),
        row.directions.to_string(),
        row.resolution.to_string(),
        row.triangles.to_string(),
        row.keys.to_string(),
        format!("{:.2}", row.keys as f64 / row.pixels.max(1) as f64),
        spread(row.frame, 1.0, 3),
        parts.collect::<Vec<_>>().join(", "),
        row.of_bound.map_or_else(String::new, |[build, ask]| {
            format!("{:.0} %, {:.1} %", 100.0 * build, 100.0 * ask)
        }),
        mebibytes(row.memory[0]),
        mebibytes(row.memory[1]),
        format!("{:.2e}", row.same[0]),
        format!("{:.2e} ({:.1e})", row.random[0], row.noise),
    ]
}

/// Lines for the terminal.
pub fn lines(sweep: &Sweep) -> Vec<String> {
    let mut table = vec![COLUMNS.map(str::to_owned)];
    table.extend(sweep.rows.iter().map(cells));
    aligned(&table, 2).collect()
}

/// The page.
pub fn page(sweep: &Sweep) -> String {
    let date = &sweep.date;
    let mut lines = vec![
        format!("# Layered depth maps: time against error, {date}"),
        String::new(),
    ];
    lines.extend(markdown::machine(&sweep.machine));
    lines.extend(sweep.remarks.iter().map(|r| format!("- {}", text(r))));
    lines.push(String::new());
    lines.extend(how(sweep.runs).lines().map(str::to_owned));
    lines.push(String::new());
    lines.push(format!(
        "![Front of time against error]({}.svg)",
        sweep.stem()
    ));
    lines.push(String::new());
    lines.push(format!("| {} |", COLUMNS.join(" | ")));
    lines.push(format!("|---|---|{}", "---:|".repeat(COLUMNS.len() - 2)));
    let row = |row: &Row| format!("| {} |", cells(row).map(|cell| text(&cell)).join(" | "));
    lines.extend(sweep.rows.iter().map(row));
    lines.push(String::new());
    lines.join("\n")
}

fn how(runs: u32) -> String {
    format!(
        "Medians of {runs} rounds after {WARM_UP} to warm up, with minimum and maximum. *Frame*: from corners on \
         the lattice to\nwhat is open over each receiver, the sum of its *parts*: *count*, *scan*, *fill* and *sort* \
         build the lists of all maps,\n*ask* looks into all of them for all receivers. *Resolution*: pixels of a map \
         across the diagonal of what blocks; maps\nare cropped to where receivers are. *Keys a pixel*: the paper has 3.9 of \
         a Sponza, 12.9 of a hairball. *Of bound*: the\nleast time for what must be moved, at the rates that the adapter was \
         measured to copy or count with, over the median: of\nthe build, and of asking, which is arithmetic in the \
         main. *Lists*: 4 bytes a pixel and 4 a key; *memory*: all that a frame\nworks on, but receivers. *RMSE*: of what is \
         open, between 0 and 1, over some 2,000 receivers, from Embree's rays in the\n*same* directions, which is what the \
         resolution costs, and from {SAMPLES} *random* ones, whose own noise is in parentheses.\nLists are compared with the \
         spec's, in as many maps as it draws in seconds, and sums with what it makes of the lists.\nA software driver is measured where it takes seconds, and left out elsewhere: up to 8 M pairs of a triangle and a map, 67 M of a \
         receiver and a map."
    )
}

/// The whole file of values: a line for each part of each row, and one for its frame.
pub fn csv(sweep: &Sweep) -> String {
    let mut text = VALUES.join(",") + "\n";
    for row in &sweep.rows {
        let bound = |i: usize| row.of_bound.map_or_else(String::new, |b| number(b[i]));
        let whole = [("frame", row.frame)];
        for (part, time) in whole.iter().chain(&row.parts) {
            let values = [
                quoted(&row.scene).into_owned(),
                quoted(&row.leg).into_owned(),
                row.clock.to_owned(),
                row.directions.to_string(),
                row.resolution.to_string(),
                row.triangles.to_string(),
                row.receivers.to_string(),
                row.pixels.to_string(),
                row.keys.to_string(),
                sweep.runs.to_string(),
                (*part).to_owned(),
                number(time.median),
                number(time.min),
                number(time.max),
                number(row.frame.median),
                row.memory[0].to_string(),
                row.memory[1].to_string(),
                bound(0),
                bound(1),
                number(row.same[0]),
                number(row.same[1]),
                number(row.random[0]),
                number(row.random[1]),
                number(row.noise),
            ];
            text += &(values.join(",") + "\n");
        }
    }
    text
}
