//! The report: one HTML file that needs nothing else, not even a network.
//!
//! It works from `file://`, in light and dark, on paper, and without scripts
//! (which only filter and enlarge). Names, purposes and notes come from files that
//! anyone may have written: everything is escaped, and the page's own policy
//! forbids every other script and every request.

mod base64;
mod bench;
mod figures;
mod glossary;
mod head;
mod index;
mod mutants;
mod rows;
mod scene;

use std::borrow::Cow;
use std::fs;
use std::io;
use std::path::Path;

use maud::{DOCTYPE, Markup, PreEscaped, html};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use crate::again::Again;
use crate::bench::Bench;
use crate::digest;
use crate::json::{Merged, MutantRun};
use crate::picture::Image;
use crate::row::{Row, Summary, Verdict};
use crate::text::clean;

const STYLE: &str = include_str!("report/style.css");
const SCRIPT: &str = include_str!("report/page.js");

/// What a report is made of.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReportInput {
    /// What was run, where and with what.
    pub run: RunInfo,
    /// The scenes, in the order in which they are shown.
    pub scenes: Vec<SceneReport>,
    /// Runs of mutants: what the harness finds where something is wrong.
    pub mutants: Vec<MutantRun>,
    /// The last measurement of time against error.
    pub bench: Option<Bench>,
}

/// What was run, where and with what.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RunInfo {
    /// The command line.
    pub command: String,
    /// When, as people write it.
    pub date: String,
    /// Wall time in seconds.
    pub seconds: f64,
    /// Name and version of what took part.
    pub versions: Vec<(String, String)>,
    /// What there is to say of the machine: name and value.
    pub machine: Vec<(String, String)>,
    /// GPU adapters.
    pub adapters: Vec<AdapterInfo>,
}

/// A GPU adapter.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AdapterInfo {
    /// The name that labels of legs use.
    pub name: String,
    /// Driver, limits, sub-pixel bits, known bugs: name and value.
    pub facts: Vec<(String, String)>,
}

/// A scene in the report.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SceneReport {
    /// `family/case`.
    pub name: String,
    /// What the scene is for.
    pub purpose: String,
    /// Its rows.
    pub rows: Vec<Row>,
    /// Its pictures, legs first.
    pub pictures: Vec<Picture>,
    /// What the plan ran and skipped.
    pub plan: Vec<PlanLine>,
    /// The first differences.
    pub differences: Vec<Difference>,
}

/// A picture with its title, such as the label of a leg.
///
/// Pictures of GPU legs that are the same byte for byte are shown once, with all
/// their titles.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Picture {
    /// Which leg, or which map.
    pub title: String,
    /// What is to be seen.
    pub caption: String,
    /// The picture.
    pub image: Image,
}

/// A pass, and why it runs or not.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PlanLine {
    /// Name of the pass.
    pub pass: String,
    /// Whether it runs.
    pub runs: bool,
    /// Why.
    pub reason: String,
    /// Milliseconds saved, where they are known.
    pub saved_ms: Option<f64>,
}

/// A difference in words, and where it helps the whole lists side by side.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Difference {
    /// What differs; line breaks are kept.
    pub words: String,
    /// Leg and the lines of its list.
    pub sides: Vec<(String, Vec<String>)>,
}

impl From<String> for Difference {
    fn from(words: String) -> Self {
        Self {
            words,
            sides: Vec::new(),
        }
    }
}

impl SceneReport {
    /// The commands that replay this scene alone: one, or one for each run that was
    /// merged and that asked for something else.
    fn again(&self) -> Vec<Cow<'_, str>> {
        let mut commands: Vec<Cow<'_, str>> = Vec::new();
        for row in self.rows.iter().filter(|row| !row.again.is_empty()) {
            if !commands.contains(&row.again.as_str().into()) {
                commands.push(row.again.as_str().into());
            }
        }
        if commands.is_empty() {
            commands.push(Again::default().scene(&self.name).into());
        }
        commands
    }

    fn verdict(&self) -> Verdict {
        digest::verdict(&self.rows)
    }
}

impl ReportInput {
    /// What rows alone tell: a report of the JSON lines of other runs.
    pub fn from_rows(run: RunInfo, merged: &Merged) -> Self {
        let scene = |(name, rows): (&str, Vec<Row>)| SceneReport {
            name: name.to_owned(),
            rows,
            ..SceneReport::default()
        };
        Self {
            run: RunInfo {
                seconds: merged.summary.seconds,
                ..run
            },
            scenes: digest::scenes(&merged.rows)
                .into_iter()
                .map(scene)
                .collect(),
            mutants: merged.mutants.clone(),
            bench: None,
        }
    }

    fn summary(&self) -> Summary {
        let rows: Vec<Row> = self.scenes.iter().flat_map(|s| s.rows.clone()).collect();
        Summary {
            scenes: self.scenes.len() as u64,
            ..Summary::of(&rows, self.run.seconds)
        }
    }

    /// How many scenes have a verdict.
    fn count(&self, verdict: Verdict) -> usize {
        self.scenes
            .iter()
            .filter(|s| s.verdict() == verdict)
            .count()
    }
}

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
    fs::write(&part, page(input).into_string()).map_err(named)?;
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
                        @for (i, scene) in input.scenes.iter().enumerate() {
                            (scene::section(i, scene))
                        }
                    }
                    (mutants::section(&input.mutants))
                    (bench::section(input.bench.as_ref()))
                    (head::run(&input.run))
                    (glossary::section())
                }
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
