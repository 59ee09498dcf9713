//! `triptych replay`.

use std::path::PathBuf;
use std::time::Instant;

use anyhow::Context;
use clap::ValueEnum;
use triptych_gpu::raster::Path;
use triptych_gpu::wgsl::Sources;

use super::Verdict;
use crate::dump::Dump;
use crate::replay::gpu::{Adapter, From};
use crate::replay::{Options, Outcome, replay};
use crate::row::Summary;
use crate::terminal::{Reporter, SceneResult};
use crate::{corpus, json};

#[derive(clap::Args)]
#[command(after_help = "Examples:\n  \
    triptych replay raster/ abuffer/quads\n  \
    triptych replay --adapter llvmpipe --path compute --json out.json\n  \
    triptych replay my.obj --dump dump --no-cache")]
pub struct Args {
    /// Parts of scene names, scene files, or meshes; the whole corpus without one
    #[arg(value_name = "PATTERN")]
    patterns: Vec<String>,
    /// Patterns are whole names
    #[arg(long)]
    exact: bool,
    /// Only these legs beside the spec (repeatable)
    #[arg(long, value_name = "LEG")]
    leg: Vec<Leg>,
    /// Only adapters whose name contains this (repeatable); "gl" adds OpenGL's
    #[arg(long, value_name = "SUBSTRING")]
    adapter: Vec<String>,
    /// Only this raster path
    #[arg(long)]
    path: Option<PathName>,
    /// Feed the GPU with the spec's results before this stage, its own from there
    #[arg(long, value_name = "STAGE", default_value = "cover")]
    gpu_from: Stage,
    /// Run everything, whether a scene needs it or not
    #[arg(long)]
    no_skip: bool,
    /// Run every leg again, whether anything changed or not
    #[arg(long)]
    no_cache: bool,
    /// In place of the scenes' own seeds
    #[arg(long)]
    seed: Option<u64>,
    /// Write one JSON object per comparison, and a summary
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Write every leg's results as NumPy arrays and images
    #[arg(long, value_name = "DIR")]
    dump: Option<PathBuf>,
    /// Open the report
    #[arg(long)]
    open: bool,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Leg {
    Spec,
    Gpu,
    Embree,
}

#[derive(Clone, Copy, ValueEnum)]
enum PathName {
    Fragment,
    Compute,
}

#[derive(Clone, Copy, ValueEnum)]
enum Stage {
    /// The GPU's own vertices, end to end
    Transform,
    /// The spec's triangles
    Cover,
    /// The spec's unsorted lists
    Sort,
    /// The spec's sorted lists
    Resolve,
}

pub fn run(args: &Args) -> anyhow::Result<Verdict> {
    let start = Instant::now();
    let entries = corpus::list(&corpus::root())?;
    let selected = corpus::select(&entries, &args.patterns, args.exact)?;
    let options = args.options();
    let adapters = if options.gpu {
        Adapter::open_all(&args.adapter, &Sources::shipped(false))?
    } else {
        Vec::new()
    };
    if options.gpu && adapters.is_empty() && !args.adapter.is_empty() {
        anyhow::bail!(
            "no adapter is called {}; see `triptych doctor`",
            args.adapter.join(" or ")
        );
    }
    let mut writer = match &args.json {
        Some(path) => Some(json::Writer::create(path).context("cannot write --json")?),
        None => None,
    };
    let mut reporter = Reporter::new(selected.len());
    let mut rows = Vec::new();
    for entry in &selected {
        reporter.scene_started(&entry.name);
        let outcome = replay(entry, &adapters, &options)?;
        if let Some(writer) = &mut writer {
            writer.rows(&outcome.rows)?;
        }
        reporter.scene_done(&result(&outcome))?;
        rows.extend(outcome.rows);
    }
    let summary = Summary::of(&rows, start.elapsed().as_secs_f64());
    if let Some(writer) = writer {
        writer.finish(summary.seconds)?;
    }
    reporter.finish(&summary, None)?;
    Ok(if summary.diverging == 0 {
        Verdict::Agree
    } else {
        Verdict::Diverge
    })
}

impl Args {
    fn options(&self) -> Options {
        let wanted = |leg| self.leg.is_empty() || self.leg.contains(&leg);
        Options {
            gpu: wanted(Leg::Gpu),
            embree: wanted(Leg::Embree),
            paths: match self.path {
                None => vec![Path::Fragment, Path::Compute],
                Some(PathName::Fragment) => vec![Path::Fragment],
                Some(PathName::Compute) => vec![Path::Compute],
            },
            from: match self.gpu_from {
                Stage::Transform => From::Transform,
                Stage::Cover => From::Cover,
                Stage::Sort => From::Sort,
                Stage::Resolve => From::Resolve,
            },
            skip: !self.no_skip,
            seed: self.seed,
            dump: self.dump.as_ref().map(Dump::new),
            pictures: true,
        }
    }
}

fn result(outcome: &Outcome) -> SceneResult {
    SceneResult {
        name: outcome.name.clone(),
        purpose: outcome.purpose.clone(),
        rows: outcome.rows.clone(),
    }
}
