//! `triptych bench grid --stress`.

use super::super::super::Verdict;
use super::super::super::paths::OnPaths;
use super::super::extremes;
use super::super::files::Files;
use crate::stress::grid::Rays;

#[derive(clap::Args)]
#[command(after_help = "Examples:\n  \
    triptych bench grid --stress                every sweep, on every adapter\n  \
    triptych bench grid --stress near aligned   two of them\n  \
    triptych bench grid --stress --adapter llvmpipe --json stress.jsonl\n\n\
    Exit code 1: a leg disagrees on a ray or a list, an error exceeds its bound, a ray walks \
    further than it may, a scene beyond a limit is not refused by name, or a bound is nowhere of \
    use. The scene of each step is kept below --out; rays of `near` and `length` are drawn for \
    the step, beside those of its scene.")]
pub struct Args {
    /// Parts of names of sweeps: aligned, cells, scale, offset, near, length, sliver, tiny,
    /// sparse; all of them without one
    #[arg(value_name = "PATTERN")]
    patterns: Vec<String>,
    #[command(flatten)]
    on: OnPaths,
    #[command(flatten)]
    files: Files,
}

pub fn run(args: &Args) -> anyhow::Result<Verdict> {
    extremes::run::<Rays>(&args.patterns, &args.on, &args.files)
}
