//! `triptych bench ldm --stress`.

use std::io::Write;
use std::path::PathBuf;
use std::time::Instant;

use super::super::super::Verdict;
use super::super::super::paths::OnPaths;
use super::super::super::run_info::run_info;
use super::super::files::{Files, legs};
use crate::bench::Machine;
use crate::embree;
use crate::output::stdout;
use crate::replay::Options;
use crate::replay::gpu::Adapter;
use crate::stress::ldm::{self, LdmShot, Measured, Table};
use crate::stress::{Sweep, Wrong, select};

#[derive(clap::Args)]
#[command(after_help = "Examples:\n  \
    triptych bench ldm --stress                every sweep, on every adapter\n  \
    triptych bench ldm --stress layers slope   two of them\n  \
    triptych bench ldm --stress --adapter llvmpipe --json stress.jsonl\n\n\
    Exit code 1: a leg disagrees, an error exceeds its bound, a point finds what is not there, \
    misses what must be or meets its own surface, a scene beyond a limit is not refused by name, \
    or a bound is nowhere of use. How far what is open is from rays has no bound: it is told, with \
    the parts of directions, rounding and pixels. The scene of each step is kept below --out.")]
pub struct Args {
    /// Parts of names of sweeps: grazing, convex, slope, layers, resolution, directions, scale,
    /// offset, lattice, sliver, tiny; all of them without one
    #[arg(value_name = "PATTERN")]
    patterns: Vec<String>,
    #[command(flatten)]
    on: OnPaths,
    #[command(flatten)]
    files: Files,
}

pub fn run(args: &Args) -> anyhow::Result<Verdict> {
    let start = Instant::now();
    let sweeps = select(ldm::sweeps(), &args.patterns).map_err(anyhow::Error::msg)?;
    let folder = args.files.ready("stress-ldm")?;
    let library = embree::library()?;
    let found = args.on.usable()?;
    let run = Run {
        options: Options {
            broken: found.broken,
            paths: args.on.paths(),
            ..Options::default()
        },
        adapters: found.open,
        scenes: folder.join("scenes-ldm"),
    };
    let (all, mut wrong) = run.sweeps(&sweeps)?;
    wrong.extend(ldm::unlike(&all));
    if args.patterns.is_empty() {
        wrong.extend(ldm::useless(&all));
    }
    let seconds = start.elapsed().as_secs_f64();
    let info = run_info(&run.adapters, &run.options.broken, Some(&library), seconds);
    let machine = Machine::here(&run.adapters).slug;
    let stem = folder.join(format!("stress-ldm-{}-{machine}", info.date));
    let written = ldm::write(&stem, &info, &sweeps, &all, &wrong);
    let steps = all.iter().map(|m| (m.path.as_path(), m.rows.as_slice()));
    args.files.json(args.on.again(), steps, seconds)?;
    args.files.end(written, &folder, &wrong)
}

/// A run under way.
struct Run {
    adapters: Vec<Adapter>,
    options: Options,
    scenes: PathBuf,
}

impl Run {
    /// Every step of every sweep, printed as it is done.
    fn sweeps(&self, sweeps: &[Sweep<LdmShot>]) -> anyhow::Result<(Vec<Measured>, Vec<Wrong>)> {
        let mut out = stdout();
        let legs = legs(&self.adapters, &self.options);
        let (mut all, mut wrong) = (Vec::new(), Vec::new());
        for sweep in sweeps {
            writeln!(out, "\n{}: {}", sweep.name, sweep.axis)?;
            writeln!(out, "{}", ldm::line(&Table::names()))?;
            let mut table = Table::default();
            for step in sweep.steps() {
                let (adapters, options) = (&self.adapters, &self.options);
                let measured = ldm::run(sweep, &step, &self.scenes, adapters, options)?;
                writeln!(out, "{}", ldm::line(&table.cells(&measured)))?;
                wrong.extend(ldm::judge(&measured, &legs));
                all.push(measured);
            }
            for note in table.notes() {
                writeln!(out, "  {note}")?;
            }
        }
        Ok((all, wrong))
    }
}
