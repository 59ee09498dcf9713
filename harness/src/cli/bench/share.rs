//! `triptych bench share`.

use std::io::Write;
use std::num::NonZeroU32;

use super::super::Verdict;
use super::super::run_info::today;
use super::super::scenes::Scenes;
use crate::bench::Progress;
use crate::bench::share::{lines, run as measure};
use crate::corpus;
use crate::output::stdout;
use crate::text::clean;

#[derive(clap::Args)]
#[command(after_help = "Examples:\n  \
    triptych bench share                      the whole corpus, one thread and one on each core\n  \
    triptych bench share abuffer/ --threads 1 --threads 2 --runs 9\n\n\
    Exit code 0 whatever is measured: a benchmark judges no machine. 2: nothing could be measured.")]
pub struct Args {
    #[command(flatten)]
    scenes: Scenes,
    /// Rounds that count
    #[arg(long, value_name = "N", default_value = "3")]
    runs: NonZeroU32,
    /// How many threads beside one; repeatable [default: one on each core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1024))]
    threads: Vec<u32>,
}

pub fn run(args: &Args) -> anyhow::Result<Verdict> {
    let corpus = corpus::list(&corpus::root())?;
    let scenes = args.scenes.select(&corpus)?;
    let mut threads: Vec<usize> = args.threads.iter().map(|n| *n as usize).collect();
    if threads.is_empty() {
        threads.push(std::thread::available_parallelism().map_or(1, usize::from));
    }
    threads.push(1);
    threads.sort_unstable();
    threads.dedup();
    let asked = (&threads[..], args.runs.get());
    let shares = measure(&scenes, asked, today(), &Progress::new());
    let shares = shares.map_err(anyhow::Error::msg)?;
    let mut out = stdout();
    for line in lines(&shares).iter().chain(&shares.remarks) {
        writeln!(out, "{}", clean(line.trim_end()))?;
    }
    anyhow::ensure!(!shares.rows.is_empty(), "nothing was measured");
    Ok(Verdict::Agree)
}
