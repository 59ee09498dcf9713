//! What is left out as tables: on the terminal, as a page, as values.

use super::super::super::csv::number;
use super::super::super::table::{aligned, spread};
use super::super::super::{Spread, WARM_UP, markdown};
use super::super::Sweep;
use super::{ALL_KEYS, Side, Skip, Skips};
use crate::text::{clean, count, markdown as text, quoted, share};

const COLUMNS: [&str; 10] = [
    "scene",
    "leg",
    "left out",
    "timed",
    "maps",
    "pixels or lists",
    "keys",
    "planned, ms",
    "full, ms",
    "full / planned",
];

const KINDS: [&str; 5] = ["0", "1", "2 to 32", "33 to 512", "longer"];

const VALUES: [&str; 23] = [
    "scene",
    "leg",
    "clock",
    "directions",
    "resolution",
    "runs",
    "left_out",
    "part",
    "maps",
    "pixels",
    "keys",
    "time_ms",
    "time_ms_min",
    "time_ms_max",
    "full_maps",
    "full_pixels",
    "full_keys",
    "full_time_ms",
    "full_time_ms_min",
    "full_time_ms_max",
    "ratio",
    "ratio_min",
    "ratio_max",
];

fn cells(of: &Skips, row: &Skip) -> [String; COLUMNS.len()] {
    let (planned, full) = (&row.planned, &row.full);
    let pair = |part: fn(&Side) -> u64| match [part(planned), part(full)] {
        [a, b] if a == b => count(a),
        [a, b] => format!("{} of {}", count(a), count(b)),
    };
    [
        clean(&of.scene).into_owned(),
        clean(&of.leg).into_owned(),
        row.what.to_owned(),
        row.part.to_owned(),
        pair(|side| side.maps),
        pair(|side| side.pixels),
        pair(|side| side.keys),
        spread(planned.time, 1.0, 3),
        spread(full.time, 1.0, 3),
        spread(row.ratio, 1.0, 2),
    ]
}

/// Of a scene's lists and keys, how many are of each length.
fn kinds_of(of: &Skips) -> String {
    let all = [0, 1].map(|i| of.lengths.iter().map(|kind| kind[i]).sum::<u64>());
    let kinds = KINDS.iter().zip(&of.lengths).map(|(name, kind)| {
        let part = |i: usize| share(kind[i] as f64 / all[i].max(1) as f64);
        format!("{name}: {} ({} of keys)", part(0), part(1))
    });
    let kinds = kinds.collect::<Vec<_>>().join(", ");
    let empty = of.rows.iter().find(|row| row.what == ALL_KEYS);
    let empty = empty.and_then(Skip::of_each);
    let empty = empty.map_or(String::new(), |ns| {
        format!("; an empty one costs a sort {ns:.4} ns")
    });
    format!("{} lists by length: {kinds}{empty}", count(all[0]))
}

/// Lines for the terminal.
pub fn lines(sweep: &Sweep) -> Vec<String> {
    let mut table = vec![COLUMNS.map(str::to_owned)];
    for of in &sweep.skips {
        table.extend(of.rows.iter().map(|row| cells(of, row)));
    }
    let kinds = sweep.skips.iter();
    let kinds =
        kinds.map(|of| format!("{}, {}: {}", clean(&of.scene), clean(&of.leg), kinds_of(of)));
    aligned(&table, 4).chain(kinds).collect()
}

/// The page.
pub fn page(sweep: &Sweep) -> String {
    let mut lines = vec![
        format!("# Layered depth maps: what is left out, {}", sweep.date),
        String::new(),
    ];
    lines.extend(markdown::machine(&sweep.machine));
    lines.extend(sweep.remarks.iter().map(|r| format!("- {}", text(r))));
    lines.push(String::new());
    lines.extend(how(sweep.runs).lines().map(str::to_owned));
    lines.push(String::new());
    lines.push(format!("| {} |", COLUMNS.join(" | ")));
    lines.push(format!(
        "|---|---|---|---|{}",
        "---:|".repeat(COLUMNS.len() - 4)
    ));
    for of in &sweep.skips {
        let row =
            |row: &Skip| format!("| {} |", cells(of, row).map(|cell| text(&cell)).join(" | "));
        lines.extend(of.rows.iter().map(row));
    }
    lines.push(String::new());
    for of in &sweep.skips {
        lines.push(format!(
            "- {}, {}: {}.",
            text(&of.scene),
            text(&of.leg),
            kinds_of(of)
        ));
    }
    lines.push(String::new());
    lines.join("\n")
}

fn how(runs: u32) -> String {
    format!(
        "Medians of {runs} rounds after {WARM_UP} to warm up, with minimum and maximum; both ways in turn in each round, \
         and the\nratio within it. *Planned*: as always, with something left out; *full*: without leaving that out, all \
         else as planned.\nBoth ways every sum is the same to the bit. *Directions*: in which no receiver's weight is more \
         than 0. *Cropping*: what\nlies beside the box around the receivers. *Dark directions*: through which no light \
         comes, in stage `environment`; only\nwhere there is a sky. *Lists of one*: a sort has nothing to do; in full, kernels take \
         its key up and put it down\nagain, and merge a chain of one entry. *All keys*: planned, a sort of the same maps with nothing \
         in them, all lists empty;\nits time over their number is what a pixel costs that is not cropped, but empty.\n*Frame*: from corners to what is open; *ask* and *sort* are parts."
    )
}

/// The whole file of values: a line for each thing that is left out, and one for each length of lists.
pub fn csv(sweep: &Sweep) -> String {
    let mut text = VALUES.join(",") + "\n";
    for of in &sweep.skips {
        let head = [
            quoted(&of.scene).into_owned(),
            quoted(&of.leg).into_owned(),
            of.clock.to_owned(),
            of.directions.to_string(),
            of.resolution.to_string(),
            sweep.runs.to_string(),
        ];
        for row in &of.rows {
            let mut values = head.to_vec();
            values.extend([quoted(row.what).into_owned(), row.part.to_owned()]);
            for side in [&row.planned, &row.full] {
                values.extend([side.maps, side.pixels, side.keys].map(|n| n.to_string()));
                values.extend(three(side.time));
            }
            values.extend(three(row.ratio));
            text += &(values.join(",") + "\n");
        }
        for (name, [lists, keys]) in KINDS.iter().zip(of.lengths) {
            let mut values = head.to_vec();
            values.extend([format!("lists of {name}"), String::new(), String::new()]);
            values.extend([lists.to_string(), keys.to_string()]);
            values.resize(VALUES.len(), String::new());
            text += &(values.join(",") + "\n");
        }
    }
    text
}

fn three(of: Spread) -> [String; 3] {
    [of.median, of.min, of.max].map(number)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_and_cells_fill_their_columns() {
        let side = |n| Side {
            maps: n,
            pixels: 1000 * n,
            keys: 7,
            time: Spread::of([0.5 * n as f64]),
        };
        let row = |what| Skip {
            what,
            part: "sort",
            planned: side(2),
            full: side(4),
            ratio: Spread::of([2.0]),
        };
        let skips = Skips {
            scene: "a|b".into(),
            leg: "gpu@x, native".into(),
            clock: "host",
            directions: 4,
            resolution: 9,
            rows: ["lists of one, runs", ALL_KEYS].map(row).to_vec(),
            lengths: [[50, 0], [25, 25], [25, 75], [0, 0], [0, 0]],
        };
        let sweep = Sweep {
            date: "2000-01-02".into(),
            machine: crate::bench::Machine::default(),
            runs: 1,
            rows: Vec::new(),
            contests: Vec::new(),
            skips: vec![skips],
            pictures: Vec::new(),
            remarks: Vec::new(),
        };
        let csv = csv(&sweep)
            .replace("\"gpu@x, native\"", "x")
            .replace("\"lists of one, runs\"", "y");
        let widths = csv.lines().map(|line| line.split(',').count());
        assert_eq!(
            widths.collect::<Vec<_>>(),
            [VALUES.len(); 1 + 2 + 5],
            "{csv}"
        );
        let page = page(&sweep);
        assert!(page.contains("| 2 of 4 | 2,000 of 4,000 | 7 |"), "{page}");
        assert!(page.contains("1: 25.0 % (25.0 % of keys)"), "{page}");
        // 1 ms over 2,000 lists.
        assert!(
            page.contains("an empty one costs a sort 500.0000 ns"),
            "{page}"
        );
        assert_eq!(lines(&sweep).len(), 1 + 2 + 1);
    }
}
