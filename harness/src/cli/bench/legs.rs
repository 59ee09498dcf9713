//! `triptych bench legs`.

use std::io::Write;
use std::num::NonZeroU32;
use std::path::{Path, PathBuf};

use super::super::adapters::OnAdapters;
use super::super::run_info::today;
use super::super::scenes::Scenes;
use super::super::{Verdict, reports};
use super::{Start, start};
use crate::bench::Progress;
use crate::bench::legs::{Legs, Options, csv, lines, page, run as measure};
use crate::output::stdout;
use crate::text::clean;

#[derive(clap::Args)]
#[command(after_help = "Examples:\n  \
    triptych bench legs                       the scenes of the demands, every adapter\n  \
    triptych bench legs --adapter llvmpipe --runs 31\n  \
    triptych bench legs bunny --out results   everything on one scene\n\n\
    Demands: the spec on one core takes no longer for a fragment than llvmpipe's hardware path, \
    and the Embree leg no more than 1.5 times as long as bare calls. Exit code 0 whether or not \
    they are met: a benchmark judges no machine. 2: nothing could be measured.")]
#[command(mut_arg("patterns", |patterns| patterns.help("Parts of scene names, scene files, or meshes; without one three real meshes and 64 layers over a whole target")))]
pub struct Args {
    #[command(flatten)]
    scenes: Scenes,
    #[command(flatten)]
    on: OnAdapters,
    /// Rounds that count, after two to warm up
    #[arg(long, value_name = "N", default_value = "15")]
    runs: NonZeroU32,
    /// Where Markdown and CSV go [default: reports/out/bench]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

pub fn run(args: &Args) -> anyhow::Result<Verdict> {
    let Start {
        corpus,
        scenes,
        adapters,
        folder,
    } = start(&args.scenes, &args.on, args.out.as_ref(), "legs")?;
    let options = Options {
        scenes,
        runs: args.runs.get(),
        date: today(),
    };
    let legs = measure(&corpus, &adapters, &options, &Progress::new());
    let legs = legs.map_err(anyhow::Error::msg)?;
    show(&legs, &page(&legs), &folder, &legs.stem())?;
    Ok(Verdict::Agree)
}

/// Prints what was measured, and leaves it as a page and as values.
pub(super) fn show(legs: &Legs, page: &str, folder: &Path, stem: &str) -> anyhow::Result<()> {
    let mut out = stdout();
    for line in lines(legs) {
        writeln!(out, "{}", line.trim_end())?;
    }
    for remark in &legs.remarks {
        writeln!(out, "{}", clean(remark))?;
    }
    anyhow::ensure!(
        !legs.rows.is_empty(),
        "nothing was measured; see what was not, and why"
    );
    for (end, text) in [("csv", &*csv(legs)), ("md", page)] {
        reports::write(&folder.join(format!("{stem}.{end}")), text)?;
    }
    writeln!(out, "Results: {}", folder.display())?;
    Ok(())
}
