//! A run as a page that can be committed beside others.

use super::table::{COLUMNS, ceiling, cells, heading};
use super::{AWAKE, Bench, Machine, WARM_UP, WARM_UP_WORK, paper};
use crate::text::markdown as text;

impl Bench {
    /// The stem of the page and of what lies beside it: family, date and machine. Targets of nothing but
    /// fragments, measured alone, have one of their own, as they may be measured on the same day.
    pub fn stem(&self) -> String {
        let Self { family, date, .. } = self;
        let scenes = self.scenes();
        let full = !scenes.is_empty() && scenes.iter().all(|scene| scene.starts_with("full/"));
        let alone = if full { "-full" } else { "" };
        format!("bench-{family}{alone}-{date}-{}", self.machine.slug)
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
    for paragraph in how(bench) {
        lines.extend([String::new(), paragraph]);
    }
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
        lines.extend([section.note.to_owned(), String::new()]);
        lines.push(format!("| {} |", section.columns.join(" | ")));
        lines.push(format!(
            "|{}{}",
            "---|".repeat(section.names),
            "---:|".repeat(section.columns.len() - section.names)
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

/// How to read a page, a paragraph each.
fn how(bench: &Bench) -> [String; 4] {
    let rounds = format!(
        "Medians of {} rounds, fewer of software drivers unless asked for, as the CSV says, and one of the spec, with \
         minimum and maximum; every round runs every leg and variant once. Before them come at least {WARM_UP} rounds to \
         warm up, and as many as keep each adapter at work for {} s on each scene, by its own clock; before each of its \
         rounds a board is at work for {} ms. No picture is timed that was not compared with the spec's, before and after.",
        bench.runs,
        WARM_UP_WORK.as_secs(),
        AWAKE.as_millis(),
    );
    let parts = "Timed is all from snapped triangles to the picture, coverage included: empty the lists, opaque surfaces, \
                 build, order, blend; no transfers, no compilation. GPU times are timestamps of the device. *From vertices* \
                 is the median of the same with transform, clip and snap before it, on the device. *Of all* is the time \
                 over the same leg's with all layers by sorting, round by round. *Memory*: all buffers of a frame at once; \
                 *bands* of rows are made one after another in the same buffers. *B/fragment*: bytes of a stored fragment.";
    let methods = "Of each leg and number of layers the fastest method is shown, the CSV has all: *insertion* keeps the n \
                   nearest in one walk over the unsorted list, *sort* sorts and stops after n; *tiles*, *linked* and *local* \
                   draw tile by tile, with runs, linked lists, or nothing in memory. Below them, where they were measured, \
                   are depth peeling (*peel*), dual depth peeling (*dual*), the triangles blended as they come (*alpha*), \
                   weighted blended transparency (*weighted*), fragments at half and at a quarter of the resolution along x and \
                   y, upsampled by place and depth (*half*, *quarter*), and the same lists in other layouts, which the last \
                   tables explain. A leg is an adapter and a path: *fragment* has the hardware's rasteriser, *compute* and *native* \
                   ours, with 64-bit integers made of words or the adapter's own; *spec* is one core.";
    let errors = "PSNR is of linear colours with peak 1 against the spec with all layers; *largest* is the largest difference \
                  of a channel; *exact* means no difference at all, and above 100 dB there is only rounding. *Of bound* is \
                  the least time for the bytes or atomics that the technique must move, at the ceilings above, over the \
                  median. The ceiling of copies is that of memory: where all data fit in a cache, as on tiny scenes, it can \
                  exceed 100 %.";
    let [parts, methods, errors] = [parts, methods, errors].map(str::to_owned);
    [rounds, parts, methods, errors]
}
