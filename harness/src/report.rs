//! The report: one HTML file that needs nothing else, not even a network.
//!
//! It works from `file://`, in light and dark, on paper, by keyboard, and without
//! scripts: these filter, compare two pictures, and show the lists of a pixel. Names, purposes and notes come from files that
//! anyone may have written: everything is escaped, and the page's own policy
//! forbids every other script and every request.

mod base64;
mod bench;
mod budget;
mod figures;
mod glossary;
mod head;
mod index;
mod input;
mod mutants;
mod rows;
mod scene;
mod viewer;
mod worst;

use std::fs;
use std::io;
use std::path::Path;

use maud::{DOCTYPE, Markup, PreEscaped, html};
use sha2::{Digest, Sha256};

use crate::row::Verdict;
use crate::text::clean;
pub use input::{AdapterInfo, Difference, Picture, PlanLine, ReportInput, RunInfo, SceneReport};

const STYLE: &str = concat!(
    include_str!("report/style.css"),
    include_str!("report/viewer.css"),
    include_str!("report/narrow.css"),
);
const SCRIPT: &str = concat!(
    include_str!("report/sheet.js"),
    include_str!("report/align.js"),
    include_str!("report/lists.js"),
    include_str!("report/looked.js"),
    include_str!("report/viewer.js"),
    include_str!("report/page.js"),
);

/// Writes the report; its folder is made if absent, and the file appears whole or
/// not at all.
///
/// # Errors
///
/// If a folder or file cannot be written, naming it.
pub fn write(path: &Path, input: &ReportInput) -> io::Result<()> {
    let named = |e: io::Error| io::Error::new(e.kind(), format!("{}: {e}", path.display()));
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder).map_err(named)?;
    }
    let mut part = path.as_os_str().to_owned();
    part.push(".part");
    fs::write(&part, budget::fit(input, budget::PAGE_BYTES)).map_err(named)?;
    fs::rename(&part, path).map_err(named)
}

/// The page.
pub fn page(input: &ReportInput) -> Markup {
    let policy = format!(
        "default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'sha256-{}'",
        base64::encode(&Sha256::digest(SCRIPT))
    );
    let summary = input.summary();
    html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta http-equiv="Content-Security-Policy" content=(policy);
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                title { "Triptych: " (head::headline(input, &summary)) }
                style { (PreEscaped(STYLE)) }
            }
            body {
                header { (head::banner(input, &summary)) }
                main {
                    (index::section(input))
                    section aria-labelledby="details" {
                        h2 #details { "Scene by scene" }
                        @for (i, scene) in input.in_order() {
                            (scene::section(i, scene))
                        }
                    }
                    (mutants::section(&input.mutants))
                    (bench::section(input.bench.as_ref()))
                    (head::run(&input.run))
                    (glossary::section())
                }
                (head::keys())
                script { (PreEscaped(SCRIPT)) }
            }
        }
    }
}

/// A verdict as a sign with a word: never colour alone.
fn sign(verdict: Verdict) -> Markup {
    let (class, mark, word) = match verdict {
        Verdict::Agree => ("agree", "✓", "agrees"),
        Verdict::Skipped => ("skipped", "–", "skipped"),
        Verdict::Diverge => ("diverge", "✗", "diverges"),
    };
    html! { span class={"sign " (class)} { span aria-hidden="true" { (mark) } " " (word) } }
}

/// The name of a verdict as filters use it.
fn verdict_name(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Agree => "agree",
        Verdict::Skipped => "skipped",
        Verdict::Diverge => "diverge",
    }
}

/// Text from outside, on one line and without characters that play tricks.
fn text(untrusted: &str) -> Markup {
    html! { (clean(untrusted)) }
}

#[cfg(test)]
pub(crate) use bench::tests::example as bench_example;

#[cfg(test)]
mod tests;
