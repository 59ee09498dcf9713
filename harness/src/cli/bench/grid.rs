//! `triptych bench grid`.

mod stress;

use std::num::NonZeroU32;
use std::path::PathBuf;

use super::super::adapters::OnAdapters;
use super::super::run_info::today;
use super::super::scenes::Scenes;
use super::super::{Verdict, reports};
use super::legs::show;
use crate::bench::grid::{HOW, Options, SCENES, run as measure, stem};
use crate::bench::legs::page_of;
use crate::bench::{Progress, named};
use crate::corpus;

#[derive(clap::Args)]
#[command(after_help = "Examples:\n  \
    triptych bench grid                       four real meshes, every adapter\n  \
    triptych bench grid dragon --adapter nvidia --rays 4194304\n  \
    triptych bench grid --stress              what holds at the extremes\n\n\
    Exit code 0 whatever is measured: a benchmark judges no machine. 2: nothing could be measured.")]
#[command(mut_arg("patterns", |patterns| patterns.help("Parts of scene names, scene files, or meshes; without one four real meshes")))]
#[command(args_conflicts_with_subcommands = true)]
pub struct Args {
    #[command(subcommand)]
    extremes: Option<Extremes>,
    #[command(flatten)]
    scenes: Scenes,
    #[command(flatten)]
    on: OnAdapters,
    /// Rounds that count, after two to warm up
    #[arg(long, value_name = "N", default_value_t = Options::RUNS)]
    runs: NonZeroU32,
    /// Rays of a kind on boards; CPUs trace at most 32,768 of them, the spec and software
    /// drivers 4,096
    #[arg(long, value_name = "N", default_value_t = Options::RAYS,
        value_parser = clap::value_parser!(u32).range(1..=4_194_304))]
    rays: u32,
    /// Where Markdown and CSV go [default: reports/out/bench]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// What is not measured, but held against bounds.
#[derive(clap::Subcommand)]
enum Extremes {
    /// What holds at the extremes, and by how much
    #[command(long_flag = "stress")]
    Stress(stress::Args),
}

pub fn run(args: &Args) -> anyhow::Result<Verdict> {
    if let Some(Extremes::Stress(args)) = &args.extremes {
        return stress::run(args);
    }
    let corpus = corpus::list(&corpus::root())?;
    let mut remarks = Vec::new();
    let scenes = match args.scenes.if_any(&corpus)? {
        Some(scenes) => scenes,
        None => named(&corpus, &SCENES, &mut remarks),
    };
    let folder = args.out.clone().unwrap_or_else(reports::bench);
    // The names of the files end with the machine's.
    reports::can_write([&folder.join("grid")])?;
    let adapters = args.on.usable()?.open;
    let options = Options {
        scenes,
        runs: args.runs.get(),
        rays: args.rays,
        date: today(),
    };
    let measured = measure(&adapters, &options, &Progress::new());
    let mut legs = measured.map_err(anyhow::Error::msg)?;
    legs.remarks.extend(remarks);
    let page = page_of(&legs, "Grids and rays", HOW);
    show(&legs, &page, &folder, &stem(&legs))?;
    Ok(Verdict::Agree)
}
