//! Where the results of `bench --stress`, `bench grid --stress` and `bench ldm --stress` go.

use std::io::Write;
use std::path::{Path, PathBuf};

use anyhow::Context;

use super::super::{Verdict, reports};
use crate::again::Again;
use crate::json;
use crate::output::{complain, stdout};
use crate::replay::Options;
use crate::replay::gpu::Adapter;
use crate::row::Row;
use crate::stress::{Written, Wrong};

/// Files that a user asks for.
#[derive(clap::Args)]
pub(super) struct Files {
    /// Write one JSON object per comparison, and a summary
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Write one CSV row per comparison to this file as well
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Where Markdown, CSV and scenes go [default: reports/out/bench]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

impl Files {
    /// The folder of the results; told before anything runs if something there cannot be
    /// written. `stem` is what the names of its files start with.
    pub(super) fn ready(&self, stem: &str) -> anyhow::Result<PathBuf> {
        let folder = self.out.clone().unwrap_or_else(reports::bench);
        // The names of the files end with the machine's.
        let own = [&self.json, &self.csv].into_iter().flatten();
        reports::can_write(own.chain([&folder.join(stem)]))?;
        Ok(folder)
    }

    /// Rows as a replay writes them; `steps` are scenes and their rows.
    pub(super) fn json<'m>(
        &self,
        legs: Vec<String>,
        steps: impl Iterator<Item = (&'m Path, &'m [Row])>,
        seconds: f64,
    ) -> anyhow::Result<()> {
        let Some(file) = &self.json else {
            return Ok(());
        };
        let context = || format!("cannot write {}", file.display());
        let again = Again {
            legs,
            options: Vec::new(),
        };
        let mut writer = json::Writer::create(file).with_context(context)?;
        for (path, rows) in steps {
            let command = again.scene(&path.to_string_lossy());
            let rows = rows.iter().map(|row| Row {
                again: command.clone(),
                ..row.clone()
            });
            let rows: Vec<Row> = rows.collect();
            writer.rows(&rows).with_context(context)?;
        }
        writer.finish(seconds).with_context(context)?;
        Ok(())
    }

    /// Says what does not hold, and where the page lies.
    pub(super) fn end(
        &self,
        written: std::io::Result<Written>,
        folder: &Path,
        wrong: &[Wrong],
    ) -> anyhow::Result<Verdict> {
        let written = written.with_context(|| format!("cannot write to {}", folder.display()))?;
        if let Some(file) = &self.csv {
            let copied = std::fs::copy(&written.csv, file);
            copied.with_context(|| format!("cannot write {}", file.display()))?;
        }
        for line in wrong {
            complain(line);
        }
        let mut out = stdout();
        writeln!(out, "Report: {}", written.markdown.display())?;
        Ok(match wrong.is_empty() {
            true => Verdict::Agree,
            false => Verdict::Diverge,
        })
    }
}

/// Labels of all legs that must be heard of.
pub(super) fn legs(adapters: &[Adapter], options: &Options) -> Vec<String> {
    let paths = |adapter: &'_ Adapter| {
        let name = adapter.gpu.name.clone();
        let paths = options.paths.iter();
        paths.map(move |path| format!("gpu@{name}/{}", path.name()))
    };
    let mut legs: Vec<String> = adapters.iter().flat_map(paths).collect();
    legs.push("embree".to_owned());
    legs
}
