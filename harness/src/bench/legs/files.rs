//! Rows as a page that can be committed, and as comma-separated values.

use super::super::csv::number;
use super::super::{WARM_UP, markdown};
use super::table::{NAMES, table, verdict};
use super::{Legs, Row};
use crate::text::{markdown as text, quoted};

/// The columns of the file of values. Times are in milliseconds; a ratio is of the time of
/// an item; what is not demanded is empty.
const VALUES: [&str; 20] = [
    "scene",
    "what",
    "items",
    "leg",
    "runs",
    "clock",
    "time_ms",
    "time_ms_min",
    "time_ms_max",
    "items_per_second",
    "against",
    "ratio",
    "ratio_min",
    "ratio_max",
    "at_most",
    "memory_bytes",
    "bound",
    "fraction_of_bound",
    "unlike",
    "unlike_of",
];

impl Legs {
    /// The stem of both files: date and machine.
    pub fn stem(&self) -> String {
        format!("legs-{}-{}", self.date, self.machine.slug)
    }
}

/// The whole file, with a header.
pub fn csv(legs: &Legs) -> String {
    let mut text = VALUES.join(",") + "\n";
    for row in &legs.rows {
        text += &(values(row, legs.runs).join(",") + "\n");
    }
    text
}

fn values(row: &Row, runs: u32) -> [String; VALUES.len()] {
    let against = row.against.as_ref();
    let ratio = |of: fn(&super::Spread) -> f64| {
        against.map_or_else(String::new, |against| number(of(&against.ratio)))
    };
    let more = row.more;
    let of = |n: Option<u64>| n.map_or_else(String::new, |n| n.to_string());
    [
        quoted(&row.scene).into_owned(),
        quoted(&row.what).into_owned(),
        row.items.to_string(),
        quoted(&row.leg).into_owned(),
        runs.to_string(),
        row.clock.to_owned(),
        number(row.time.median),
        number(row.time.min),
        number(row.time.max),
        format!("{:.0}", row.rate()),
        against.map_or_else(String::new, |against| quoted(&against.leg).into_owned()),
        ratio(|r| r.median),
        ratio(|r| r.min),
        ratio(|r| r.max),
        against
            .and_then(|against| against.most)
            .map_or_else(String::new, |most| most.to_string()),
        of(more.memory),
        more.bound
            .map_or_else(String::new, |(name, _)| name.to_owned()),
        more.bound
            .map_or_else(String::new, |(_, part)| number(part)),
        of(more.unlike.map(|[unlike, _]| unlike)),
        of(more.unlike.map(|[_, all]| all)),
    ]
}

/// The page.
pub fn page(legs: &Legs) -> String {
    page_of(legs, "Leg against leg", &how(legs.runs))
}

/// The page of what was measured in the same form, with its title and how it was measured.
pub fn page_of(legs: &Legs, title: &str, how: &str) -> String {
    let mut lines = vec![format!("# {title}, {}", legs.date), String::new()];
    lines.extend(markdown::machine(&legs.machine));
    lines.extend(legs.remarks.iter().map(|r| format!("- {}", text(r))));
    lines.push(String::new());
    lines.extend(how.lines().map(str::to_owned));
    lines.push(String::new());
    if let Some(verdict) = verdict(legs) {
        lines.push(format!("**{verdict}.**"));
        lines.push(String::new());
    }
    let row = |row: &Vec<String>| {
        let cells: Vec<String> = row.iter().map(|cell| text(cell)).collect();
        format!("| {} |", cells.join(" | "))
    };
    let table = table(legs);
    let numbers = table[0].len() - NAMES;
    lines.push(row(&table[0]));
    lines.push(format!(
        "|{}{}",
        "---|".repeat(NAMES),
        "---:|".repeat(numbers)
    ));
    lines.extend(table[1..].iter().map(row));
    lines.push(String::new());
    lines.join("\n")
}

fn how(runs: u32) -> String {
    format!(
        "Medians of {runs} rounds after {WARM_UP} to warm up, with minimum and maximum; a round runs \
         all legs of a scene,\nevery other one backwards, and ratios are taken within a round. A \
         demand is met if the median ratio is\nno larger. *cover*: every fragment as a stream; \
         *build*: the transparent ones in lists; from the same snapped\ntriangles, without \
         transfers and compilation. The spec has one core, a software driver all of them. *hits*: \
         every\nhit of the ray through every sample, by one call of `rtcIntersect1` each with the \
         filter that collects, beside\nthe same ray as a replay asks for it, and the whole leg \
         of a replay: the pairs, their classes, the rays, the verdict."
    )
}
