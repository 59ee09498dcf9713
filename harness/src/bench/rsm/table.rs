//! Rows as tables: on the terminal, as a page that can be committed, as values.

use super::super::csv::number;
use super::super::table::{aligned, mebibytes, spread};
use super::super::{WARM_UP, markdown};
use super::judge::SAMPLE;
use super::{Frames, OfAdapter, Row};
use crate::text::{clean, markdown as text, quoted};

/// Columns of the tables.
const COLUMNS: [&str; 13] = [
    "scene",
    "leg",
    "kernel",
    "B",
    "blur",
    "rays",
    "frame, ms",
    "parts, ms",
    "rays/s of B",
    "RMSE",
    "largest",
    "lit otherwise",
    "memory",
];

/// Columns of the file of values; times are in milliseconds, colours linear.
const VALUES: [&str; 21] = [
    "scene",
    "leg",
    "clock",
    "pixels",
    "blockers",
    "kernel",
    "stride",
    "divisor",
    "blur",
    "rays",
    "runs",
    "part",
    "time_ms",
    "time_ms_min",
    "time_ms_max",
    "frame_ms",
    "rmse",
    "largest",
    "lit_otherwise",
    "largest_elsewhere",
    "memory_bytes",
];

fn cells(row: &Row) -> [String; COLUMNS.len()] {
    let parts = row
        .parts
        .iter()
        .map(|(name, time)| format!("{name} {:.3}", time.median));
    let block = row.parts.iter().find(|(name, _)| *name == "B");
    [
        clean(&row.scene).into_owned(),
        clean(&row.leg).into_owned(),
        match row.stride {
            1 => format!("{0}x{0}", row.kernel),
            stride => format!("{0}x{0}, every {stride}", row.kernel),
        },
        format!("1/{}", row.divisor),
        row.blur.to_string(),
        row.rays.to_string(),
        spread(row.frame, 1.0, 3),
        parts.collect::<Vec<_>>().join(", "),
        block.map_or_else(String::new, |(_, time)| {
            format!("{:.0} M", row.rays as f64 / time.median / 1000.0)
        }),
        format!("{:.2e}", row.rmse),
        match row.own {
            Some(own) if own.lit_otherwise > 0 => {
                format!(
                    "{:.1e}, elsewhere {:.1e}",
                    row.largest, own.largest_elsewhere
                )
            }
            _ => format!("{:.1e}", row.largest),
        },
        row.own
            .map_or_else(String::new, |own| own.lit_otherwise.to_string()),
        row.own
            .map_or_else(String::new, |own| mebibytes(own.memory)),
    ]
}

/// Lines for the terminal.
pub fn lines(frames: &Frames) -> Vec<String> {
    let mut table = vec![COLUMNS.map(str::to_owned)];
    table.extend(frames.rows.iter().map(cells));
    aligned(&table, 2).collect()
}

/// The page.
pub fn page(frames: &Frames) -> String {
    let date = &frames.date;
    let mut lines = vec![
        format!("# Indirect light: time against error, {date}"),
        String::new(),
    ];
    lines.extend(markdown::machine(&frames.machine));
    lines.extend(frames.remarks.iter().map(|r| format!("- {}", text(r))));
    lines.push(String::new());
    lines.extend(how(frames.runs).lines().map(str::to_owned));
    lines.push(String::new());
    lines.push(format!(
        "![Front of time against error]({}.svg)",
        frames.stem()
    ));
    lines.push(String::new());
    lines.push(format!("| {} |", COLUMNS.join(" | ")));
    lines.push(format!("|---|---|{}", "---:|".repeat(COLUMNS.len() - 2)));
    let row = |row: &Row| format!("| {} |", cells(row).map(|cell| text(&cell)).join(" | "));
    lines.extend(frames.rows.iter().map(row));
    lines.push(String::new());
    lines.join("\n")
}

fn how(runs: u32) -> String {
    format!(
        "Medians of {runs} rounds after {WARM_UP} to warm up, with minimum and maximum; the spec draws \
         each picture once, on one core,\nand large ones not at all, of which software drivers draw one.\n*Frame*: from snapped triangles and the blockers' corners \
         to the picture, in one submission, without transfers and\ncompilation. *Parts* are timed \
         by themselves: *eye* and *map* (coverage, points, lights), *cells* (the blockers' grid, \
         built\nanew), *direct* (places, shadow map), *A* (all texels of the kernel), *B* (rays, \
         their search, blocked light), *compose* (blur\nand picture). *Kernel*: texels of the \
         light's map; *B*: its pixels to the picture's along x and y. *RMSE* and *largest*: \
         linear\ndifference from the scene's own kernel with every pixel's own rays by Embree and \
         no blur.\n*Lit otherwise*: pixels at the border of a shadow whose place in the lamp's map \
         follows from the device's own point; it is\nlit where the spec's is not, or the reverse, and \
         is as far off as direct light is bright; *elsewhere* is *largest* without them.\nThis \
         does not hide an error: what an adapter makes of its own points is compared with what the \
         spec makes of them, before it\nis timed, at each pixel, but for stages gather and block (*A* \
         and *B*), of which at most {SAMPLE} pixels of B are looked at.\n*Memory*: the buffers that \
         stages share, the blockers and their grid among them, without the triangles that are drawn."
    )
}

/// The whole file of values: a line for each part of each row, and one for its frame.
pub fn csv(frames: &Frames) -> String {
    let mut text = VALUES.join(",") + "\n";
    for row in &frames.rows {
        let of = |text: fn(OfAdapter) -> String| row.own.map_or_else(String::new, text);
        let whole = [("frame", row.frame)];
        for (part, time) in whole.iter().chain(&row.parts) {
            let values = [
                quoted(&row.scene).into_owned(),
                quoted(&row.leg).into_owned(),
                row.clock.to_owned(),
                row.pixels.to_string(),
                row.blockers.to_string(),
                row.kernel.to_string(),
                row.stride.to_string(),
                row.divisor.to_string(),
                row.blur.to_string(),
                row.rays.to_string(),
                frames.runs.to_string(),
                (*part).to_owned(),
                number(time.median),
                number(time.min),
                number(time.max),
                number(row.frame.median),
                number(row.rmse),
                number(row.largest),
                of(|own| own.lit_otherwise.to_string()),
                of(|own| number(own.largest_elsewhere)),
                of(|own| own.memory.to_string()),
            ];
            text += &(values.join(",") + "\n");
        }
    }
    text
}
