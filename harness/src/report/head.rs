//! What the run amounts to, and what was run.

use maud::{Markup, html};

use super::{ReportInput, RunInfo, text};
use crate::digest;
use crate::row::{Summary, Verdict};
use crate::text::{count, plural, time};

/// The sections of the page, as the navigation lists them: identifier and name.
const SECTIONS: [(&str, &str); 6] = [
    ("scenes", "Scenes"),
    ("details", "Scene by scene"),
    ("mutants", "Mutants"),
    ("bench", "Time against error"),
    ("run", "This run"),
    ("glossary", "Glossary"),
];

/// The keys that the script listens to.
const KEYS: [(&str, &str); 10] = [
    ("n, p", "next scene that diverges, and the one before"),
    (
        "w, W",
        "next of the worst pixels of the scene, and the one before",
    ),
    ("v", "to the pictures of the scene"),
    ("arrows", "move the cursor by a pixel; with Shift by ten"),
    ("Enter", "show the lists of the pixel"),
    ("+, -", "enlarge, reduce"),
    ("x", "swap the two pictures"),
    ("Tab, arrows", "the slider moves like any other"),
    ("/", "filter by name"),
    ("?", "these keys; Escape closes"),
];

/// The verdict in one line.
pub fn headline(input: &ReportInput, summary: &Summary) -> String {
    let scenes = plural(input.scenes.len() as u64, "scene");
    match input.count(Verdict::Diverge) {
        0 if summary.compared == 0 => "nothing was compared".to_owned(),
        0 => match input.count(Verdict::Agree) {
            1 => "1 scene agrees".to_owned(),
            n => format!("{} agree", plural(n as u64, "scene")),
        },
        1 => format!("1 of {scenes} diverges"),
        n => format!("{n} of {scenes} diverge"),
    }
}

/// The verdict and the totals.
pub fn banner(input: &ReportInput, summary: &Summary) -> Markup {
    let good = input.count(Verdict::Diverge) == 0 && summary.compared > 0;
    let rows = || input.scenes.iter().flat_map(|s| &s.rows);
    let admitted = digest::sum(rows().map(|r| r.admitted));
    let cached = rows().filter(|r| r.cached).count();
    let skipped = input.count(Verdict::Skipped);
    let tiles = [
        (count(input.scenes.len() as u64), "scenes"),
        (count(summary.compared), "items compared"),
        (count(digest::sum(rows().map(|r| r.differ))), "differences"),
        (count(summary.unexplained), "without a cause"),
        (count(admitted), "not judged"),
        (count(skipped as u64), "skipped scenes"),
        (count(summary.skipped), "skipped rows"),
        (count(cached as u64), "cached rows"),
        (time(summary.seconds * 1000.0), "wall time"),
    ];
    html! {
        p.brand { "Triptych" span { " replays scenes through the spec, the GPU and Embree" } }
        h1 class={"verdict " (if good { "agree" } else { "diverge" })} {
            span aria-hidden="true" { (if good { "✓ " } else { "✗ " }) }
            (capital(&headline(input, summary)))
        }
        dl.tiles {
            @for (value, name) in &tiles {
                div { dt { (name) } dd { (value) } }
            }
        }
        nav aria-label="Sections" {
            @for (i, (id, name)) in SECTIONS.iter().enumerate() {
                @if i > 0 { " · " }
                a href={"#" (id)} { (name) }
            }
        }
    }
}

/// Command, machine, adapters, versions.
pub fn run(run: &RunInfo) -> Markup {
    html! {
        section aria-labelledby="run" {
            h2 #run { "This run" }
            dl.facts {
                @if !run.command.is_empty() {
                    dt { "command" } dd { code { (text(&run.command)) } }
                }
                @if !run.date.is_empty() { dt { "date" } dd { (text(&run.date)) } }
                @for (name, value) in run.machine.iter().chain(&run.versions) {
                    dt { (text(name)) } dd { (text(value)) }
                }
            }
            @if !run.adapters.is_empty() {
                h3 { "Adapters" }
                div.cards {
                    @for adapter in &run.adapters {
                        div.card {
                            h4 { (text(&adapter.name)) }
                            dl.facts {
                                @for (name, value) in &adapter.facts {
                                    dt { (text(name)) } dd { (text(value)) }
                                }
                            }
                        }
                    }
                }
            }
        }
    }
}

/// What the keys do, for the script to show.
pub fn keys() -> Markup {
    html! {
        dialog #keys aria-labelledby="keys-title" {
            h2 #keys-title { "Keys" }
            dl.facts { @for (key, what) in KEYS { dt { kbd { (key) } } dd { (what) } } }
            form method="dialog" { button { "Close" } }
        }
    }
}

fn capital(words: &str) -> String {
    let mut letters = words.chars();
    let first = letters.next().map(|c| c.to_ascii_uppercase());
    first.into_iter().chain(letters).collect()
}
