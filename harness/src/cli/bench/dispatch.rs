//! `triptych bench dispatch`.

use std::io::Write;
use std::num::NonZeroU32;
use std::path::PathBuf;

use super::super::adapters::OnAdapters;
use super::super::run_info::today;
use super::super::scenes::Scenes;
use super::super::{Verdict, reports};
use super::{Start, start};
use crate::bench::dispatch::{
    Found, Options, SCENES, csv, identical, lines, page, plots, run as measure,
};
use crate::bench::{Progress, named};
use crate::corpus;
use crate::output::stdout;
use crate::text::clean;

#[derive(clap::Args)]
#[command(after_help = "Examples:\n  \
    triptych bench dispatch                   the paper's scenes, every queue, 1 to twice the cores\n  \
    triptych bench dispatch bunny --frames 200 --runs 3\n  \
    triptych bench dispatch uneven --threads 2 --threads 8\n  \
    triptych bench dispatch --identical mirrors   whether all pictures are the same, 100 times each\n\n\
    The paper's protocol is 3 runs of 200 frames, which take hours on few cores. Exit code 0 whatever \
    is measured: a benchmark judges no machine; with --identical 1 if a picture is another. 2: nothing could be measured.")]
#[command(mut_arg("patterns", |patterns| patterns.help("Parts of scene names, or scene files with [dispatch]; without one the paper's three, and one whose work is uneven")))]
pub struct Args {
    #[command(flatten)]
    scenes: Scenes,
    #[command(flatten)]
    on: OnAdapters,
    /// Frames of a run
    #[arg(long, value_name = "N", default_value_t = Options::FRAMES)]
    frames: NonZeroU32,
    /// Runs that count
    #[arg(long, value_name = "N", default_value_t = Options::RUNS)]
    runs: NonZeroU32,
    /// Pixels a side of square pictures
    #[arg(long, value_name = "N", default_value_t = Options::SIDE,
        value_parser = clap::value_parser!(u32).range(1..=1024))]
    side: u32,
    /// How many threads; repeatable [default: from 1 to twice the cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1024))]
    threads: Vec<u32>,
    /// Only the paper's three queues, with both endings, and no adapter
    #[arg(long)]
    paper: bool,
    /// Measure nothing: make so many pictures with each queue, 1, 2, 3, 8 and 32 threads and both endings,
    /// and hold each against the spec's, to the bit
    #[arg(long, value_name = "N", num_args = 0..=1, default_missing_value = "100",
        conflicts_with_all = ["frames", "runs", "side", "threads", "paper", "out", "adapter"])]
    identical: Option<NonZeroU32>,
    /// Where Markdown, CSV and SVG go [default: reports/out/bench]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

pub fn run(args: &Args) -> anyhow::Result<Verdict> {
    if let Some(runs) = args.identical {
        return all_alike(args, runs.get());
    }
    let Start {
        corpus,
        scenes,
        adapters,
        folder,
    } = start(&args.scenes, &args.on, args.out.as_ref(), "dispatch")?;
    let mut remarks = Vec::new();
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let mut threads: Vec<usize> = args.threads.iter().map(|n| *n as usize).collect();
    threads.sort_unstable();
    threads.dedup();
    if threads.is_empty() {
        threads = Options::threads(cores);
    }
    let options = Options {
        scenes: scenes.unwrap_or_else(|| named(&corpus, &SCENES, &mut remarks)),
        side: args.side,
        frames: args.frames.get(),
        runs: args.runs.get(),
        threads,
        papers: args.paper,
        date: today(),
    };
    let adapters = match args.paper {
        true => &[],
        false => &adapters[..],
    };
    let measured = measure(adapters, &options, &Progress::new());
    let mut measured = measured.map_err(anyhow::Error::msg)?;
    measured.remarks.extend(remarks);
    let mut out = stdout();
    for line in lines(&measured) {
        writeln!(out, "{}", clean(line.trim_end()))?;
    }
    for remark in &measured.remarks {
        writeln!(out, "{}", clean(remark))?;
    }
    anyhow::ensure!(
        !measured.rows.is_empty(),
        "nothing was measured; see what was not, and why"
    );
    let stem = measured.stem();
    reports::write(&folder.join(format!("{stem}.csv")), csv(&measured))?;
    reports::write(&folder.join(format!("{stem}.md")), page(&measured))?;
    for (name, text) in plots(&measured) {
        reports::write(&folder.join(format!("{stem}-{name}.svg")), text)?;
    }
    writeln!(out, "Results: {}", folder.display())?;
    Ok(Verdict::Agree)
}

/// Whether all pictures of scenes are the spec's; by default of those that are measured.
fn all_alike(args: &Args, runs: u32) -> anyhow::Result<Verdict> {
    let corpus = corpus::list(&corpus::root())?;
    let mut remarks = Vec::new();
    let scenes = match args.scenes.if_any(&corpus)? {
        Some(scenes) => scenes,
        None => named(&corpus, &SCENES, &mut remarks),
    };
    let mut out = stdout();
    let mut all = Found::default();
    for entry in &scenes {
        let found = identical(entry, runs, &Progress::new()).map_err(anyhow::Error::msg)?;
        let (pictures, wrong) = (found.pictures, found.wrong.len());
        let line = format!(
            "{}: {pictures} pictures, {wrong} unlike the spec's",
            entry.name
        );
        writeln!(out, "{}", clean(&line))?;
        all.pictures += pictures;
        all.wrong.extend(found.wrong);
    }
    for line in all.wrong.iter().take(12).chain(&remarks) {
        writeln!(out, "{}", clean(line))?;
    }
    anyhow::ensure!(all.pictures > 0, "no picture was made");
    match all.wrong.is_empty() {
        true => Ok(Verdict::Agree),
        false => Ok(Verdict::Diverge),
    }
}
