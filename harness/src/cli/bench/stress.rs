//! `triptych bench --stress`.

use std::io::Write;
use std::path::PathBuf;
use std::time::Instant;

use anyhow::Context;

use super::super::paths::OnPaths;
use super::super::run_info::run_info;
use super::super::{Verdict, reports};
use crate::again::Again;
use crate::bench::Machine;
use crate::output::{complain, stdout};
use crate::replay::Options;
use crate::replay::gpu::Adapter;
use crate::row::Row;
use crate::stress::{self, Measured, Sweep, Table};
use crate::{embree, json};

#[derive(clap::Args)]
#[command(after_help = "Examples:\n  \
    triptych bench --stress                     every sweep, on every adapter\n  \
    triptych bench --stress scale layers        two of them\n  \
    triptych bench --stress --adapter llvmpipe --json stress.jsonl\n\n\
    Exit code 1: an error exceeds its bound, an exact stage differs, more goes unjudged than a \
    step allows, or a bound is nowhere of use. The scene of each step is kept below --out.")]
pub struct Args {
    /// Parts of names of sweeps: scale, offset, sliver, depth, edge-on, layers; all of them
    /// without one
    #[arg(value_name = "PATTERN")]
    patterns: Vec<String>,
    #[command(flatten)]
    on: OnPaths,
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

pub fn run(args: &Args) -> anyhow::Result<Verdict> {
    let start = Instant::now();
    let sweeps = stress::select(&args.patterns).map_err(anyhow::Error::msg)?;
    let folder = args.out.clone().unwrap_or_else(reports::bench);
    // The names of the files end with the machine's.
    let own = [&args.json, &args.csv].into_iter().flatten();
    reports::can_write(own.chain([&folder.join("stress")]))?;
    let library = embree::library()?;
    let found = args.on.usable()?;
    let options = Options {
        broken: found.broken,
        paths: args.on.paths(),
        ..Options::default()
    };
    let run = Run {
        args,
        adapters: found.open,
        options,
        folder,
    };
    let (all, mut wrong) = run.sweeps(&sweeps)?;
    if args.patterns.is_empty() {
        wrong.extend(stress::useless(&all));
    }
    let seconds = start.elapsed().as_secs_f64();
    let info = run_info(&run.adapters, &run.options.broken, Some(&library), seconds);
    let folder = run.folder.display();
    let machine = Machine::here(&run.adapters).slug;
    let stem = run.folder.join(format!("stress-{}-{machine}", info.date));
    let written = stress::write(&stem, &info, &sweeps, &all, &wrong);
    let written = written.with_context(|| format!("cannot write to {folder}"))?;
    if let Some(file) = &args.csv {
        let copied = std::fs::copy(&written.csv, file);
        copied.with_context(|| format!("cannot write {}", file.display()))?;
    }
    run.json(&all, seconds)?;
    for line in &wrong {
        complain(line);
    }
    let mut out = stdout();
    writeln!(out, "Report: {}", written.markdown.display())?;
    Ok(match wrong.is_empty() {
        true => Verdict::Agree,
        false => Verdict::Diverge,
    })
}

/// A run under way.
struct Run<'a> {
    args: &'a Args,
    adapters: Vec<Adapter>,
    options: Options,
    folder: PathBuf,
}

impl Run<'_> {
    /// Every step of every sweep, printed as it is done.
    fn sweeps(&self, sweeps: &[Sweep]) -> anyhow::Result<(Vec<Measured>, Vec<stress::Wrong>)> {
        let mut out = stdout();
        let legs = self.legs();
        let (mut all, mut wrong) = (Vec::new(), Vec::new());
        for sweep in sweeps {
            writeln!(out, "\n{}: {}", sweep.name, sweep.axis)?;
            writeln!(out, "{}", stress::line(&Table::names()))?;
            let mut table = Table::default();
            for step in sweep.steps() {
                let scenes = self.folder.join("scenes");
                let measured = stress::run(sweep, &step, &scenes, &self.adapters, &self.options)?;
                writeln!(out, "{}", stress::line(&table.cells(&measured)))?;
                wrong.extend(stress::judge(&measured, &legs));
                all.push(measured);
            }
            for note in table.notes() {
                writeln!(out, "  {note}")?;
            }
        }
        Ok((all, wrong))
    }

    /// Labels of all legs that must be heard of.
    fn legs(&self) -> Vec<String> {
        let paths = |adapter: &'_ Adapter| {
            let name = adapter.gpu.name.clone();
            let paths = self.options.paths.iter();
            paths.map(move |path| format!("gpu@{name}/{}", path.name()))
        };
        let mut legs: Vec<String> = self.adapters.iter().flat_map(paths).collect();
        legs.push("embree".to_owned());
        legs
    }

    /// Rows as a replay writes them.
    fn json(&self, all: &[Measured], seconds: f64) -> anyhow::Result<()> {
        let Some(file) = &self.args.json else {
            return Ok(());
        };
        let context = || format!("cannot write {}", file.display());
        let again = Again {
            legs: self.args.on.again(),
            options: Vec::new(),
        };
        let mut writer = json::Writer::create(file).with_context(context)?;
        for measured in all {
            let command = again.scene(&measured.path.to_string_lossy());
            let rows = measured.rows.iter().map(|row| Row {
                again: command.clone(),
                ..row.clone()
            });
            let rows: Vec<Row> = rows.collect();
            writer.rows(&rows).with_context(context)?;
        }
        writer.finish(seconds).with_context(context)?;
        Ok(())
    }
}
