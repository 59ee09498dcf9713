//! A run as a page that can be committed beside others.

use super::table::{COLUMNS, ceiling, cells, heading};
use super::{AWAKE, Bench, Machine, WARM_UP, WARM_UP_WORK, paper};
use crate::text::markdown as text;

impl Bench {
    /// The stem of the page and of what lies beside it: family, date and machine.
    pub fn stem(&self) -> String {
        let Self { family, date, .. } = self;
        format!("bench-{family}-{date}-{}", self.machine.slug)
    }
}

/// The page, which shows the front of the same stem.
pub fn page(bench: &Bench) -> String {
    let mut lines = vec![
        format!("# Time against error: A-buffer, {}", bench.date),
        String::new(),
    ];
    lines.extend(machine(&bench.machine));
    lines.extend(
        bench
            .ceilings
            .iter()
            .map(|c| format!("- ceiling of {}", text(&ceiling(c)))),
    );
    lines.extend(bench.remarks.iter().map(|r| format!("- {}", text(r))));
    lines.push(String::new());
    lines.extend(how(bench).lines().map(str::to_owned));
    lines.push(String::new());
    lines.push(format!(
        "![Front of time against error]({}.svg)",
        bench.stem()
    ));
    for scene in bench.scenes() {
        lines.push(String::new());
        lines.push(format!("## {}", text(&heading(bench, scene))));
        lines.push(String::new());
        lines.push(format!("| {} |", COLUMNS.join(" | ")));
        lines.push(format!("|---|{}", "---:|".repeat(COLUMNS.len() - 1)));
        let rows = bench.shown().filter(|row| row.scene == scene);
        lines.extend(rows.map(|row| format!("| {} |", cells(row).map(|c| text(&c)).join(" | "))));
    }
    for section in paper::sections(bench) {
        lines.push(String::new());
        lines.push(format!("## {}", text(&section.heading)));
        lines.push(String::new());
        lines.push(format!("| {} |", section.columns.join(" | ")));
        lines.push(format!(
            "|---|---|{}",
            "---:|".repeat(section.columns.len() - 2)
        ));
        let cells = |row: &Vec<String>| row.iter().map(|c| text(c)).collect::<Vec<_>>().join(" | ");
        lines.extend(section.rows.iter().map(|row| format!("| {} |", cells(row))));
    }
    lines.push(String::new());
    lines.join("\n")
}

/// Where a run took place, as items of a list.
pub(super) fn machine(machine: &Machine) -> Vec<String> {
    let Machine { cores, system, .. } = machine;
    let mut lines = vec![
        format!("- {}, {cores} cores, {system}", text(&machine.cpu)),
        format!("- {}", machine.version),
    ];
    let adapter = |(name, facts): &(String, String)| format!("- {}: {}", text(name), text(facts));
    lines.extend(machine.adapters.iter().map(adapter));
    lines
}

fn how(bench: &Bench) -> String {
    format!(
        "Medians of {} rounds, fewer of software drivers unless asked for, as the CSV says, and one of the \
         spec, with minimum and maximum; every round runs every leg and variant \
         once. Before\nthem come at least {WARM_UP} rounds to warm up, and as many as keep each \
         adapter at work for {} s on each scene, by its own clock; before each of its rounds a board is at work for {} ms.\nTimed is all from snapped triangles to the \
         picture, coverage included: empty\nthe lists, opaque surfaces, build, order, blend; no \
         transfers, no compilation. GPU times are timestamps\nof the device. *From vertices* is the median of the same with transform, clip and snap before it, on the device. Of each leg and number of \
         layers the faster method is shown, the CSV has both:\n*insertion* keeps the n nearest in \
         one walk over the unsorted list, *sort* sorts and stops after n.\n*Of all* is the time \
         over the same leg's with all layers by sorting, round by round. PSNR is of linear\n\
         colours with peak 1 against the spec with all layers; *exact* means no difference at \
         all, and above\n100 dB there is only rounding. *Of bound* is the least time for the \
         bytes or atomics that the technique\nmust move, at the ceilings above, over the median.\nThe ceiling of copies is that of memory: \
         where all data fit in a cache, as on tiny scenes, it can\nexceed 100 %.",
        bench.runs,
        WARM_UP_WORK.as_secs(),
        AWAKE.as_millis(),
    )
}
