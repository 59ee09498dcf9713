//! `triptych bench --stress`.

use super::super::Verdict;
use super::super::paths::OnPaths;
use super::extremes;
use super::files::Files;
use crate::stress::Frame;

#[derive(clap::Args)]
#[command(after_help = "Examples:\n  \
    triptych bench --stress                     every sweep, on every adapter\n  \
    triptych bench --stress scale layers        two of them\n  \
    triptych bench --stress --adapter llvmpipe --json stress.jsonl\n\n\
    Exit code 1: an error exceeds its bound, an exact stage differs, more goes unjudged than a \
    step allows, or a bound is nowhere of use. The scene of each step is kept below --out.")]
pub struct Args {
    /// Parts of names of sweeps: scale, offset, sliver, depth, edge-on, layers; all of them
    /// without one
    #[arg(value_name = "PATTERN")]
    patterns: Vec<String>,
    #[command(flatten)]
    on: OnPaths,
    #[command(flatten)]
    files: Files,
}

pub fn run(args: &Args) -> anyhow::Result<Verdict> {
    extremes::run::<Frame>(&args.patterns, &args.on, &args.files)
}
