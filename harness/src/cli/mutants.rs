//! `triptych mutants`.

use std::io::Write;
use std::path::PathBuf;
use std::time::Instant;

use anyhow::Context;
use triptych_gpu::raster::Path;

use super::adapters::could_not_run;
use super::paths::OnPaths;
use super::results::Results;
use super::run_info::today;
use super::{Verdict, reports};
use crate::json::{self, MutantRun};
use crate::mutants::{Columns, Lab, Matrix, mutants, select};
use crate::output::{self, complain};

#[derive(clap::Args)]
#[command(after_help = "Examples:\n  \
    triptych mutants                         all of them, on every adapter\n  \
    triptych mutants tie-order --json o.json those with a cause, scene or name like it\n\n\
    A run of all of them, on all paths, is shown by the reports of later replays. Exit code 1: one survives, \
    or is killed in another way than the table says.")]
pub struct Args {
    /// Parts of names, scenes or causes; all mutants without one
    #[arg(value_name = "PATTERN")]
    patterns: Vec<String>,
    #[command(flatten)]
    on: OnPaths,
    /// Write one JSON object per mutant and leg, and a summary
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

pub fn run(args: &Args) -> anyhow::Result<Verdict> {
    let start = Instant::now();
    let paths = args.on.paths();
    let selected = select(mutants(), &args.patterns, &paths).map_err(anyhow::Error::msg)?;
    let all = args.patterns.is_empty() && !args.on.is_limited();
    let whole = all.then(reports::mutants);
    reports::can_write(args.json.iter().chain(&whole))?;
    let mut lab = Lab::new(args.on.usable()?.open);
    let mut legs = Vec::new();
    for name in lab.names() {
        let order = [Path::Compute, Path::Fragment, Path::Native];
        let paths = order.iter().filter(|path| paths.contains(path));
        legs.extend(paths.map(|path| format!("gpu@{name}/{}", path.name())));
    }
    let rows = selected.iter().map(|m| (m.name.as_str(), m.scene.as_str()));
    let columns = Columns::new(&legs, rows);
    let mut out = output::stdout();
    for line in columns.header() {
        writeln!(out, "{line}")?;
    }
    let (mut cells, mut wrong, mut failed) = (Vec::new(), Vec::new(), Vec::new());
    for mutant in &selected {
        let own = match lab.run(mutant) {
            Ok(own) => own,
            Err(error) => {
                failed.push(error);
                continue;
            }
        };
        writeln!(out, "{}", columns.line(&own.iter().collect::<Vec<_>>()))?;
        wrong.extend(mutant.judge(&own).err());
        cells.extend(own);
    }
    let matrix = Matrix::of(&cells, start.elapsed().as_secs_f64(), today());
    writeln!(out, "\n{}", matrix.headline())?;
    let run = MutantRun { matrix, cells };
    let whole = whole.filter(|_| failed.is_empty());
    for file in args.json.iter().chain(&whole) {
        json::write_mutants(file, &run)
            .with_context(|| format!("cannot write {}", file.display()))?;
    }
    for line in &wrong {
        complain(line);
    }
    if !failed.is_empty() {
        return could_not_run(failed);
    }
    Ok(match wrong.is_empty() {
        true => Verdict::Agree,
        false => Verdict::Diverge,
    })
}

/// The last run of mutants, for the report; a file that cannot be read is worth a remark.
pub(super) fn last_mutants(results: &mut Results) -> anyhow::Result<Vec<MutantRun>> {
    let file = reports::mutants();
    if !file.is_file() {
        return Ok(Vec::new());
    }
    match json::read(&[file]) {
        Ok(merged) => Ok(merged.mutants),
        Err(error) => {
            results.reporter.remark(&error.to_string())?;
            Ok(Vec::new())
        }
    }
}
