//! Where the results of a replay go as they come: the table and the JSON lines, and
//! later the report.

use std::fs::File;
use std::io::BufWriter;
use std::path::Path;

use anyhow::Context;

use super::run_info::scene_report;
use crate::again::Again;
use crate::json;
use crate::replay::Outcome;
use crate::report::SceneReport;
use crate::row::{Row, Summary};
use crate::terminal::{Reporter, SceneResult};

/// The results so far, and who is told of them.
pub struct Results {
    pub reporter: Reporter,
    again: Again,
    json: Option<json::Writer<BufWriter<File>>>,
    rows: Vec<Row>,
    pub scenes: Vec<SceneReport>,
}

impl Results {
    /// None yet of a run of so many scenes; `again` is what its commands repeat.
    pub fn new(total: usize, again: Again, json: Option<&Path>) -> anyhow::Result<Self> {
        let json = json.map(json::Writer::create).transpose();
        Ok(Self {
            reporter: Reporter::new(total).with_again(again.clone()),
            again,
            json: json.context(JSON)?,
            rows: Vec::new(),
            scenes: Vec::new(),
        })
    }

    /// Tells of a scene; `argument` selects it on the command line.
    pub fn add(&mut self, argument: String, mut outcome: Outcome) -> anyhow::Result<()> {
        let command = self.again.scene(&argument);
        for row in &mut outcome.rows {
            row.again.clone_from(&command);
        }
        if let Some(json) = &mut self.json {
            json.rows(&outcome.rows).context(JSON)?;
        }
        for remark in &outcome.remarks {
            self.reporter.remark(remark)?;
        }
        self.rows.extend_from_slice(&outcome.rows);
        self.reporter.scene_done(&SceneResult {
            name: outcome.name.clone(),
            argument,
            purpose: outcome.purpose.clone(),
            rows: outcome.rows.clone(),
        })?;
        self.scenes.push(scene_report(outcome));
        Ok(())
    }

    /// The rows of all scenes so far.
    pub fn rows(&self) -> &[Row] {
        &self.rows
    }

    /// Ends the JSON lines. `seconds` is the run's wall time.
    pub fn summary(&mut self, seconds: f64) -> anyhow::Result<Summary> {
        match self.json.take() {
            Some(json) => json.finish(seconds).context(JSON),
            None => Ok(Summary::of(&self.rows, seconds)),
        }
    }
}

const JSON: &str = "cannot write --json";
