//! `triptych bench ldm`.

mod stress;

use std::io::{Write, stdout};
use std::num::NonZeroU32;
use std::path::PathBuf;

use super::super::adapters::OnAdapters;
use super::super::run_info::today;
use super::super::scenes::Scenes;
use super::super::{Verdict, reports};
use super::{Start, start};
use crate::bench::Progress;
use crate::bench::ldm::{Options, csv, lines, page, rival, run as measure, skips, svg};
use crate::text::clean;

#[derive(clap::Args)]
#[command(after_help = "Examples:\n  \
    triptych bench ldm                        a Sponza and a ball of fur, as the paper has them\n  \
    triptych bench ldm --cuts 1               and every triangle cut into four\n  \
    triptych bench ldm ldm/bunny --adapter llvmpipe --runs 3\n  \
    triptych bench ldm --rival                maps against horizons of the view, at equal time\n  \
    triptych bench ldm --skips                what is left out, in time\n  \
    triptych bench ldm --stress               what holds at the extremes\n\n\
    Exit code 0 whatever is measured: a benchmark judges no machine. 2: nothing could be measured.")]
#[command(mut_arg("patterns", |patterns| patterns.help("Parts of scene names, or scene files with an [ldm]; without one a Sponza and a ball of fur")))]
#[command(args_conflicts_with_subcommands = true)]
pub struct Args {
    #[command(subcommand)]
    extremes: Option<Extremes>,
    #[command(flatten)]
    scenes: Scenes,
    #[command(flatten)]
    on: OnAdapters,
    /// Rounds that count, after two to warm up
    #[arg(long, value_name = "N", default_value = "15")]
    runs: NonZeroU32,
    /// Measure each scene again with every triangle cut into four, so often
    #[arg(long, value_name = "N", default_value = "0", value_parser = clap::value_parser!(u32).range(0..=3))]
    cuts: u32,
    /// Hold maps against horizon-based ambient occlusion in screen space, over distances
    #[arg(long, conflicts_with = "cuts")]
    rival: bool,
    /// Measure what the plan leaves out, with and without: directions, what is cropped, lists of one
    #[arg(long, conflicts_with_all = ["cuts", "rival"])]
    skips: bool,
    /// Where Markdown, CSV and the front go [default: reports/out/bench]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// What is not measured, but held against bounds.
#[derive(clap::Subcommand)]
enum Extremes {
    /// What holds at the extremes, and where errors come from
    #[command(long_flag = "stress")]
    Stress(stress::Args),
}

pub fn run(args: &Args) -> anyhow::Result<Verdict> {
    if let Some(Extremes::Stress(args)) = &args.extremes {
        return stress::run(args);
    }
    let Start {
        scenes,
        adapters,
        folder,
        ..
    } = start(&args.scenes, &args.on, args.out.as_ref(), "ldm")?;
    let options = Options {
        scenes,
        cuts: args.cuts,
        rival: args.rival,
        skips: args.skips,
        runs: args.runs.get(),
        date: today(),
    };
    let sweep = measure(&adapters, &options, &Progress::new());
    let sweep = sweep.map_err(anyhow::Error::msg)?;
    let mut out = stdout();
    let shown = match () {
        () if args.rival => rival::lines(&sweep),
        () if args.skips => skips::lines(&sweep),
        () => lines(&sweep),
    };
    for line in shown {
        writeln!(out, "{}", line.trim_end())?;
    }
    for remark in &sweep.remarks {
        writeln!(out, "{}", clean(remark))?;
    }
    anyhow::ensure!(
        !(sweep.rows.is_empty() && sweep.contests.is_empty() && sweep.skips.is_empty()),
        "nothing was measured; see what was not, and why"
    );
    let files = match () {
        () if args.rival => vec![("csv", rival::csv(&sweep)), ("md", rival::page(&sweep))],
        () if args.skips => vec![("csv", skips::csv(&sweep)), ("md", skips::page(&sweep))],
        () => vec![
            ("csv", csv(&sweep)),
            ("svg", svg(&sweep)),
            ("md", page(&sweep)),
        ],
    };
    for (end, text) in files {
        reports::write(&folder.join(format!("{}.{end}", sweep.stem())), &text)?;
    }
    for (scene, png) in &sweep.pictures {
        reports::write(&folder.join(sweep.picture(scene)), png)?;
    }
    writeln!(out, "Results: {}", folder.display())?;
    Ok(Verdict::Agree)
}
