//! `triptych bench ldm --stress`.

use super::super::super::Verdict;
use super::super::super::paths::OnPaths;
use super::super::extremes;
use super::super::files::Files;
use crate::stress::ldm::Maps;

#[derive(clap::Args)]
#[command(after_help = "Examples:\n  \
    triptych bench ldm --stress                every sweep, on every adapter\n  \
    triptych bench ldm --stress layers slope   two of them\n  \
    triptych bench ldm --stress --adapter llvmpipe --json stress.jsonl\n\n\
    Exit code 1: a leg disagrees, an error exceeds its bound, a point finds what is not there, \
    misses what must be or meets its own surface, a scene beyond a limit is not refused by name, \
    or a bound is nowhere of use. How far what is open is from rays has no bound: it is told, with \
    the parts of directions, rounding and pixels. The scene of each step is kept below --out.")]
pub struct Args {
    /// Parts of names of sweeps: grazing, convex, slope, layers, resolution, directions, scale,
    /// offset, lattice, sliver, tiny; all of them without one
    #[arg(value_name = "PATTERN")]
    patterns: Vec<String>,
    #[command(flatten)]
    on: OnPaths,
    #[command(flatten)]
    files: Files,
}

pub fn run(args: &Args) -> anyhow::Result<Verdict> {
    extremes::run::<Maps>(&args.patterns, &args.on, &args.files)
}
