//! Rows as tables: on the terminal, as a page that can be committed, as values.

use super::super::csv::number;
use super::super::table::{aligned, mebibytes, spread};
use super::super::{Spread, WARM_UP, markdown};
use super::case::SAMPLES;
use super::flip::RAYS;
use super::{Asked, Row, Sweep};
use crate::text::{clean, markdown as text, quoted};

/// Columns of the tables.
const COLUMNS: [&str; 17] = [
    "scene",
    "leg",
    "layout",
    "directions",
    "resolution",
    "triangles",
    "keys",
    "keys a pixel",
    "build, ms",
    "frame, ms",
    "parts, ms",
    "of bound",
    "lists",
    "memory",
    "RMSE, same",
    "RMSE, random",
    "FLIP",
];

/// Columns of the file of values; times are in milliseconds.
const VALUES: [&str; 28] = [
    "scene",
    "leg",
    "clock",
    "layout",
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
    "build_ms",
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
    "flip",
    "flip_of_halves",
];

fn flip([mean, halves]: [f64; 2]) -> String {
    format!("{mean:.4} ({halves:.4})")
}

fn cells(row: &Row) -> [String; COLUMNS.len()] {
    let parts = row.parts.iter();
    let parts = parts.map(|(name, time)| format!("{name} {:.3}", time.median));
    let asked = |of: &dyn Fn(&Asked) -> String| row.asked.as_ref().map_or_else(String::new, of);
    let build = row.of_bound.map(|part| format!("{:.0} %", 100.0 * part));
    let ask = row.asked.as_ref().and_then(|asked| asked.of_bound);
    let ask = ask.map(|part| format!("{:.1} %", 100.0 * part));
    [
        clean(&row.scene).into_owned(),
        clean(&row.leg).into_owned(),
        row.layout.name().to_owned(),
        row.directions.to_string(),
        row.resolution.to_string(),
        row.triangles.to_string(),
        row.keys.to_string(),
        format!("{:.2}", row.keys as f64 / row.pixels.max(1) as f64),
        spread(row.build, 1.0, 3),
        asked(&|asked| spread(asked.frame, 1.0, 3)),
        parts.collect::<Vec<_>>().join(", "),
        build.into_iter().chain(ask).collect::<Vec<_>>().join(", "),
        mebibytes(row.memory[0]),
        mebibytes(row.memory[1]),
        asked(&|asked| format!("{:.2e}", asked.same[0])),
        asked(&|asked| format!("{:.2e} ({:.1e})", asked.random[0], asked.noise)),
        asked(&|asked| asked.flip.map_or_else(String::new, flip)),
    ]
}

/// Lines for the terminal.
pub fn lines(sweep: &Sweep) -> Vec<String> {
    let mut table = vec![COLUMNS.map(str::to_owned)];
    table.extend(sweep.rows.iter().map(cells));
    aligned(&table, 3).collect()
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
    for (scene, _) in &sweep.pictures {
        lines.push(format!(
            "![{}: open by random rays, open by maps, FLIP between both]({})",
            text(scene),
            sweep.picture(scene)
        ));
        lines.push(String::new());
    }
    lines.push(format!("| {} |", COLUMNS.join(" | ")));
    lines.push(format!(
        "|---|---|---|{}",
        "---:|".repeat(COLUMNS.len() - 3)
    ));
    let row = |row: &Row| format!("| {} |", cells(row).map(|cell| text(&cell)).join(" | "));
    lines.extend(sweep.rows.iter().map(row));
    lines.push(String::new());
    lines.join("\n")
}

fn how(runs: u32) -> String {
    format!(
        "Medians of {runs} rounds after {WARM_UP} to warm up, with minimum and maximum. *Frame*: from corners on \
         the lattice to\nwhat is open over each receiver, the sum of its *parts*. Lists as *runs*: *count*, *scan*, \
         *fill* and *sort* build those of all\nmaps, *ask* looks into all of them for all receivers. As the paper's \
         *chains*: *link* sets heads and counter and links\nevery key, *sort* links each list anew, in order. Chains \
         are the same lists as the runs, entry by entry, and built alone:\nasking looks for a key by halves of a run, and \
         a chain has none. *Resolution*: pixels of a map across the diagonal of\nwhat blocks; maps are cropped to where \
         receivers are. *Keys a pixel*: the paper has 3.9 of a Sponza, 12.9 of a hairball.\n*Of bound*: the least time for \
         what must be moved, at the rates that the adapter was measured to copy or count with,\nover the median: of the \
         build, and of asking, which is arithmetic in the main. *Lists*: 4 bytes a pixel and 4 a key, of\nchains 8 a key; \
         *memory*: all that a frame works on, but receivers; chains have 32 bytes a pixel to sort by. *RMSE*: of what\nis \
         open, between 0 and 1, over some 2,000 receivers, from Embree's rays in the *same* directions, which is what \
         the\nresolution costs, and from {SAMPLES} *random* ones, whose own noise is in parentheses. *FLIP*: how \
         wrong\nthe picture of what is open looks, from 0 to 1 (mean, at 67 pixels a degree; greys by the sRGB transfer \
         function), from one\nof {RAYS} random rays a pixel; in parentheses two pictures of half of these rays from each \
         other. Of a large view, each kth\npixel along both axes, 200 of them at most, is the picture. Lists are compared with \
         the spec's,\nin as many maps as it draws in seconds, and sums with what it makes of the lists. A software driver \
         is measured where it\ntakes seconds, and left out elsewhere: up to 8 M pairs of a triangle and a map, 67 M of a receiver and a map."
    )
}

/// The whole file of values: a line for each part of each row, for its build, and for its frame.
pub fn csv(sweep: &Sweep) -> String {
    let mut text = VALUES.join(",") + "\n";
    for row in &sweep.rows {
        let frame = row.asked.as_ref().map(|asked| ("frame", asked.frame));
        let wholes = frame.into_iter().chain([("build", row.build)]);
        for (part, time) in wholes.chain(row.parts.iter().copied()) {
            text += &(values(row, sweep.runs, (part, time)).join(",") + "\n");
        }
    }
    text
}

fn values(row: &Row, runs: u32, (part, time): (&str, Spread)) -> [String; VALUES.len()] {
    let or_empty = |value: Option<f64>| value.map_or_else(String::new, number);
    let asked = |of: fn(&Asked) -> f64| or_empty(row.asked.as_ref().map(of));
    let flip = |i: usize| or_empty(row.asked.as_ref().and_then(|asked| Some(asked.flip?[i])));
    [
        quoted(&row.scene).into_owned(),
        quoted(&row.leg).into_owned(),
        row.clock.to_owned(),
        row.layout.name().to_owned(),
        row.directions.to_string(),
        row.resolution.to_string(),
        row.triangles.to_string(),
        row.receivers.to_string(),
        row.pixels.to_string(),
        row.keys.to_string(),
        runs.to_string(),
        part.to_owned(),
        number(time.median),
        number(time.min),
        number(time.max),
        number(row.build.median),
        asked(|asked| asked.frame.median),
        row.memory[0].to_string(),
        row.memory[1].to_string(),
        or_empty(row.of_bound),
        or_empty(row.asked.as_ref().and_then(|asked| asked.of_bound)),
        asked(|asked| asked.same[0]),
        asked(|asked| asked.same[1]),
        asked(|asked| asked.random[0]),
        asked(|asked| asked.random[1]),
        asked(|asked| asked.noise),
        flip(0),
        flip(1),
    ]
}
