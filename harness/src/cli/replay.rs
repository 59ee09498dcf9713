//! `triptych replay`.

mod args;

use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::Context;
use triptych_gpu::kernel::Foreign;

use super::adapters::could_not_run;
use super::bench::abuffer::last_bench;
use super::kernel::{Kernels, all_judged, all_run, kernels};
use super::mutants::last_mutants;
use super::results::Results;
use super::run_info::run_info;
use super::{Verdict, reports};
use crate::cache::Cache;
use crate::corpus::Entry;
use crate::dispatch::share;
use crate::output::stdout;
use crate::replay::gpu::Vertices;
use crate::replay::{Outcome, replay};
use crate::report::{self, ReportInput, RunInfo};
use crate::row::Summary;
use crate::{corpus, embree, snapshot};
pub use args::Args;

pub fn run(args: &Args) -> anyhow::Result<Verdict> {
    let start = Instant::now();
    let foreign = match kernels(&args.kernel)? {
        Kernels::Run(foreign) => foreign,
        Kernels::Print(text) => {
            stdout().write_all(text.as_bytes())?;
            return Ok(Verdict::Agree);
        }
    };
    let entries = corpus::list(&corpus::root())?;
    let selected = args.scenes.select(&entries)?;
    let mut options = args.options()?;
    share::set_threads(args.threads.map(|threads| threads as usize));
    all_run(&foreign, &options)?;
    anyhow::ensure!(
        foreign.is_empty() || options.vertex != Vertices::Hardware,
        "--kernel has no part in --vertex hardware; leave one of them out"
    );
    let found = args.adapters(&options, &foreign)?;
    let adapters = found.open;
    options.broken = found.broken;
    let library = options.embree.then(embree::library).transpose()?;
    options.cache = args.cache()?;
    let mut results = Results::new(selected.len(), args.again(), args.json.as_deref())?;
    let of_cache = options.cache.iter().flat_map(Cache::remarks);
    for remark in of_cache.chain(foreign.iter().map(instead)) {
        results.reporter.remark(&remark)?;
    }
    let mut unreadable = Vec::new();
    let mut idle = args.of_frames_alone();
    for entry in &selected {
        results.reporter.scene_started(&entry.name);
        match replay(entry, &adapters, &options) {
            Ok(outcome) => {
                if let Some(options) = idle.take_if(|_| outcome.runs_kernels_alone()) {
                    let remark = format!(
                        "without effect on scenes with [grid], [rsm], [ldm] or [dispatch]: {options}"
                    );
                    results.reporter.remark(&remark)?;
                }
                if args.snapshot {
                    leave_snapshot(entry, &outcome, &mut results)?;
                }
                results.add(entry.argument(&entries), outcome)?;
            }
            Err(error) => unreadable.push(error),
        }
    }
    if results.scenes.is_empty() && !unreadable.is_empty() {
        drop(results);
        return could_not_run(unreadable);
    }
    let summary = results.summary(start.elapsed().as_secs_f64())?;
    let judged = all_judged(&foreign, results.rows());
    let seconds = summary.seconds;
    let run = run_info(&adapters, &options.broken, library.as_ref(), seconds);
    let page = publish(run, results, &summary)?;
    if args.open {
        open(&page)?;
    }
    if !unreadable.is_empty() {
        return could_not_run(unreadable);
    }
    match verdict(&summary)? {
        Verdict::Agree => judged.map(|()| Verdict::Agree),
        Verdict::Diverge => Ok(Verdict::Diverge),
    }
}

/// Leaves the scene's snapshot pending, unless it is what the accepted one says.
fn leave_snapshot(entry: &Entry, outcome: &Outcome, results: &mut Results) -> anyhow::Result<()> {
    let Some(facts) = &outcome.facts else {
        return Ok(());
    };
    let left = snapshot::leave(&corpus::root(), entry, &outcome.purpose, facts);
    if let Some(path) = left.context("cannot leave a pending snapshot")? {
        let remark = format!("pending snapshot: {}", path.display());
        results.reporter.remark(&remark)?;
    }
    Ok(())
}

/// Writes the report, and ends what the terminal shows.
fn publish(run: RunInfo, mut results: Results, summary: &Summary) -> anyhow::Result<PathBuf> {
    let mutants = last_mutants(&mut results)?;
    let bench = last_bench(&mut results)?;
    let Results {
        mut reporter,
        scenes,
        ..
    } = results;
    let page = reports::page();
    let input = ReportInput {
        run,
        scenes,
        mutants,
        bench,
    };
    report::write(&page, &input).with_context(|| format!("cannot write {}", page.display()))?;
    reporter.finish(summary, Some(&page))?;
    Ok(page)
}

/// Whose kernel runs.
fn instead(kernel: &Foreign) -> String {
    let (stage, file) = (kernel.stage.name, &kernel.file);
    format!("stage {stage} runs {file} on every adapter, not our kernel")
}

/// A run that compared nothing at all has not agreed on anything.
pub(super) fn verdict(summary: &Summary) -> anyhow::Result<Verdict> {
    if summary.diverging > 0 {
        return Ok(Verdict::Diverge);
    }
    anyhow::ensure!(
        summary.compared > 0,
        "nothing was compared; see what was skipped, and why"
    );
    Ok(Verdict::Agree)
}

fn open(page: &Path) -> anyhow::Result<()> {
    let opener = if cfg!(target_os = "macos") {
        "open"
    } else {
        "xdg-open"
    };
    let status = std::process::Command::new(opener).arg(page).status();
    match status {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => anyhow::bail!("{opener} {}: {status}", page.display()),
        Err(error) => anyhow::bail!("{opener} {}: {error}", page.display()),
    }
}
