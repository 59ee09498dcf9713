//! `triptych bench --stress`.

use std::io::Write;
use std::path::PathBuf;
use std::time::Instant;

use super::super::Verdict;
use super::super::paths::OnPaths;
use super::super::run_info::run_info;
use super::files::{Files, legs};
use crate::bench::Machine;
use crate::embree;
use crate::output::stdout;
use crate::replay::Options;
use crate::replay::gpu::Adapter;
use crate::stress::{self, Measured, Sweep, Table};

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
    #[command(flatten)]
    files: Files,
}

pub fn run(args: &Args) -> anyhow::Result<Verdict> {
    let start = Instant::now();
    let sweeps = stress::select(stress::sweeps(), &args.patterns).map_err(anyhow::Error::msg)?;
    let folder = args.files.ready("stress")?;
    let library = embree::library()?;
    let found = args.on.usable()?;
    let options = Options {
        broken: found.broken,
        paths: args.on.paths(),
        ..Options::default()
    };
    let run = Run {
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
    let machine = Machine::here(&run.adapters).slug;
    let stem = run.folder.join(format!("stress-{}-{machine}", info.date));
    let written = stress::write(&stem, &info, &sweeps, &all, &wrong);
    let steps = all.iter().map(|m| (m.path.as_path(), m.rows.as_slice()));
    args.files.json(args.on.again(), steps, seconds)?;
    args.files.end(written, &run.folder, &wrong)
}

/// A run under way.
struct Run {
    adapters: Vec<Adapter>,
    options: Options,
    folder: PathBuf,
}

impl Run {
    /// Every step of every sweep, printed as it is done.
    fn sweeps(&self, sweeps: &[Sweep]) -> anyhow::Result<(Vec<Measured>, Vec<stress::Wrong>)> {
        let mut out = stdout();
        let legs = legs(&self.adapters, &self.options);
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
}
