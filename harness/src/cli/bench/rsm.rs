//! `triptych bench rsm`.

use std::io::{Write, stdout};
use std::num::NonZeroU32;
use std::path::PathBuf;

use super::super::adapters::OnAdapters;
use super::super::run_info::today;
use super::super::scenes::Scenes;
use super::super::{Verdict, reports};
use super::{Start, start};
use crate::bench::Progress;
use crate::bench::rsm::{Options, csv, lines, page, run as measure, svg};
use crate::text::clean;

#[derive(clap::Args)]
#[command(after_help = "Examples:\n  \
    triptych bench rsm                        a frame of 1024 x 768, and two scenes of the corpus\n  \
    triptych bench rsm corner --adapter llvmpipe --runs 5\n\n\
    Exit code 0 whatever is measured: a benchmark judges no machine. 2: nothing could be measured.")]
#[command(mut_arg("patterns", |patterns| patterns.help("Parts of scene names, or scene files with an [rsm]; without one a frame of the paper's size and two scenes")))]
pub struct Args {
    #[command(flatten)]
    scenes: Scenes,
    #[command(flatten)]
    on: OnAdapters,
    /// Rounds that count, after two to warm up
    #[arg(long, value_name = "N", default_value = "15")]
    runs: NonZeroU32,
    /// Where Markdown, CSV and the front go [default: reports/out/bench]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

pub fn run(args: &Args) -> anyhow::Result<Verdict> {
    let Start {
        corpus,
        scenes,
        adapters,
        folder,
    } = start(&args.scenes, &args.on, args.out.as_ref(), "rsm")?;
    let options = Options {
        scenes,
        runs: args.runs.get(),
        date: today(),
    };
    let frames = measure(&corpus, &adapters, &options, &Progress::new());
    let frames = frames.map_err(anyhow::Error::msg)?;
    let mut out = stdout();
    for line in lines(&frames) {
        writeln!(out, "{}", line.trim_end())?;
    }
    for remark in &frames.remarks {
        writeln!(out, "{}", clean(remark))?;
    }
    anyhow::ensure!(
        !frames.rows.is_empty(),
        "nothing was measured; see what was not, and why"
    );
    let files = [
        ("csv", csv(&frames)),
        ("svg", svg(&frames)),
        ("md", page(&frames)),
    ];
    for (end, text) in files {
        reports::write(&folder.join(format!("{}.{end}", frames.stem())), &text)?;
    }
    writeln!(out, "Results: {}", folder.display())?;
    Ok(Verdict::Agree)
}
