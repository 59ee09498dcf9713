//! What a report is made of.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};
use triptych_spec::scene::Size;

use crate::again::Again;
use crate::bench::Bench;
use crate::digest;
use crate::json::{Merged, MutantRun};
use crate::picture::Image;
use crate::replay::worst::Worst;
use crate::row::{Row, Summary, Verdict};
use crate::sheet::Sheet;

/// What a report is made of.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReportInput {
    /// What was run, where and with what.
    pub run: RunInfo,
    /// The scenes; those that diverge are shown first.
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
    /// Size of the target, if it is known.
    pub size: Option<Size>,
    /// Its pictures, legs first.
    pub pictures: Vec<Picture>,
    /// Its lists.
    pub sheets: Vec<Sheet>,
    /// Pixels that differ, the worst first.
    pub worst: Worst,
    /// What is left out of the page, in words.
    pub left_out: Vec<String>,
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
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
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
    pub(super) fn again(&self) -> Vec<Cow<'_, str>> {
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

    pub(super) fn verdict(&self) -> Verdict {
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

    pub(super) fn summary(&self) -> Summary {
        let rows: Vec<Row> = self.scenes.iter().flat_map(|s| s.rows.clone()).collect();
        Summary {
            scenes: self.scenes.len() as u64,
            ..Summary::of(&rows, self.run.seconds)
        }
    }

    /// The scenes with their numbers: those that diverge first, then as they came.
    pub(super) fn in_order(&self) -> Vec<(usize, &SceneReport)> {
        let mut scenes: Vec<(usize, &SceneReport)> = self.scenes.iter().enumerate().collect();
        scenes.sort_by_key(|(_, scene)| scene.verdict() != Verdict::Diverge);
        scenes
    }

    /// How many scenes have a verdict.
    pub(super) fn count(&self, verdict: Verdict) -> usize {
        self.scenes
            .iter()
            .filter(|s| s.verdict() == verdict)
            .count()
    }
}
