//! `triptych report`.

use std::io::Write;
use std::path::PathBuf;

use anyhow::Context;

use super::replay::verdict;
use super::run_info::run_info;
use super::{Verdict, reports};
use crate::report::{self, ReportInput};
use crate::{json, output};

#[derive(clap::Args)]
#[command(after_help = "Example:\n  triptych report shard1.json shard2.json --output report.html")]
pub struct Args {
    /// JSON lines written by `replay --json` and `mutants --json`
    #[arg(value_name = "FILE", required = true)]
    files: Vec<PathBuf>,
    /// Where the report goes [default: reports/out/index.html]
    #[arg(long, value_name = "FILE")]
    output: Option<PathBuf>,
}

pub fn run(args: &Args) -> anyhow::Result<Verdict> {
    let merged = json::read(&args.files)?;
    let page = args.output.clone().unwrap_or_else(reports::page);
    let run = run_info(&[], &[], None, merged.summary.seconds);
    report::write(&page, &ReportInput::from_rows(run, &merged))
        .with_context(|| format!("cannot write {}", page.display()))?;
    writeln!(output::stdout(), "Report: {}", page.display())?;
    let mut runs = merged.mutants.iter();
    let dead = runs.all(|run| run.matrix.killed == run.matrix.mutants);
    // Runs of mutants may come without a replay.
    let only_mutants = merged.rows.is_empty() && !merged.mutants.is_empty();
    match only_mutants || matches!(verdict(&merged.summary)?, Verdict::Agree) {
        true if dead => Ok(Verdict::Agree),
        _ => Ok(Verdict::Diverge),
    }
}
