//! What `triptych replay` is asked for.

use std::path::PathBuf;

use anyhow::Context;
use clap::ValueEnum;
use triptych_gpu::kernel::Foreign;

use super::super::paths::OnPaths;
use super::super::reports;
use super::super::scenes::Scenes;
use crate::again::{Again, option};
use crate::cache::Cache;
use crate::dump::Dump;
use crate::replay::gpu::{Adapters, From, Vertices};
use crate::replay::{Extent, Options};

#[derive(clap::Args)]
#[command(after_help = "Examples:\n  \
    triptych replay raster/ abuffer/quads\n  \
    triptych replay --adapter llvmpipe --path compute --json out.json\n  \
    triptych replay my.obj --dump dump --no-cache\n  \
    triptych replay --vertex gpu raster/near-plane\n  \
    triptych replay --vertex hardware --path fragment raster/\n  \
    triptych replay --kernel build=mine.wgsl abuffer/\n\n\
    A reader that leaves early, as in `triptych replay | head`, does not end the run: report, \
    JSON lines and exit code are those of the whole run.")]
#[command(mut_arg("patterns", |patterns| patterns.help("Parts of scene names, scene files, or meshes; the whole corpus without one")))]
pub struct Args {
    #[command(flatten)]
    pub(super) scenes: Scenes,
    /// Only these legs beside the spec (repeatable)
    #[arg(long, value_name = "LEG")]
    leg: Vec<Leg>,
    #[command(flatten)]
    on: OnPaths,
    /// Whose vertices the GPU's later stages get; not of scenes with a grid or indirect light
    #[arg(long, value_name = "WHOSE", default_value = "spec")]
    vertex: Vertices,
    /// Feed the GPU with the spec's results before this stage, its own from there; not in
    /// scenes with a grid or indirect light, where every stage is fed so [default: cover]
    #[arg(long, value_name = "STAGE")]
    gpu_from: Option<From>,
    /// The user's kernels of a stage in place of ours (repeatable); `STAGE=?` prints the
    /// stage's bindings as WGSL to start from
    #[arg(long, value_name = "STAGE=FILE")]
    pub(super) kernel: Vec<String>,
    /// Compare what takes the place of linked lists (peeling, blending, tiles, other layouts) on
    /// scenes of any size, not only on small ones
    #[arg(long)]
    rivals: bool,
    /// Run everything, whether a scene needs it or not
    #[arg(long)]
    no_skip: bool,
    /// Run every leg again, whether anything changed or not
    #[arg(long)]
    no_cache: bool,
    /// Threads over which work of spec and Embree is spread, for each leg at work; nothing but time depends on it
    /// [default: one on each core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1024))]
    pub(super) threads: Option<u32>,
    /// In place of the scenes' own seeds
    #[arg(long)]
    seed: Option<u64>,
    /// Write one JSON object per comparison, and a summary
    #[arg(long, value_name = "FILE")]
    pub(super) json: Option<PathBuf>,
    /// Write every leg's results as NumPy arrays and images
    #[arg(long, value_name = "DIR")]
    dump: Option<PathBuf>,
    /// Leave pending snapshots of scenes whose facts are not what theirs says
    #[arg(long)]
    pub(super) snapshot: bool,
    /// Open the report
    #[arg(long)]
    pub(super) open: bool,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Leg {
    Spec,
    Gpu,
    /// In screen space, and in world space of every scene, however large
    Embree,
}

impl Args {
    pub(super) fn adapters(
        &self,
        options: &Options,
        foreign: &[Foreign],
    ) -> anyhow::Result<Adapters> {
        if !options.gpu {
            return Ok(Adapters::default());
        }
        let mut adapters = self.on.usable()?;
        for adapter in &mut adapters.open {
            adapter.use_foreign(foreign);
        }
        Ok(adapters)
    }

    /// The cache, unless all is to run.
    pub(super) fn cache(&self) -> anyhow::Result<Option<Cache>> {
        if self.no_cache || self.snapshot || self.dump.is_some() || !self.kernel.is_empty() {
            return Ok(None);
        }
        let cache = Cache::open(&reports::out().join("cache")).context("cannot open the cache")?;
        Ok(Some(cache))
    }

    /// What a command must repeat to see the same result.
    pub(super) fn again(&self) -> Again {
        let mut legs: Vec<String> = self.leg.iter().map(|leg| chosen("--leg", *leg)).collect();
        legs.extend(self.on.again());
        let mut options = Vec::new();
        options.extend(self.seed.map(|seed| option("--seed", &seed.to_string())));
        if self.vertex != Vertices::default() {
            options.push(chosen("--vertex", self.vertex));
        }
        let from = self.gpu_from.filter(|from| *from != From::default());
        options.extend(from.map(|from| chosen("--gpu-from", from)));
        options.extend(self.kernel.iter().map(|kernel| option("--kernel", kernel)));
        options.extend(self.rivals.then(|| "--rivals".to_owned()));
        options.extend(self.no_skip.then(|| "--no-skip".to_owned()));
        Again { legs, options }
    }

    /// Options that are chosen, and that only scenes which are rasterised know.
    pub(super) fn of_frames_alone(&self) -> Option<String> {
        let from = self.gpu_from.is_some().then_some("--gpu-from");
        let vertex = (self.vertex != Vertices::default()).then_some("--vertex");
        let chosen: Vec<&str> = from.into_iter().chain(vertex).collect();
        (!chosen.is_empty()).then(|| chosen.join(", "))
    }

    pub(super) fn options(&self) -> anyhow::Result<Options> {
        let wanted = |leg| self.leg.is_empty() || self.leg.contains(&leg);
        let from = self
            .vertex
            .from(self.gpu_from)
            .map_err(anyhow::Error::msg)?;
        Ok(Options {
            gpu: wanted(Leg::Gpu),
            broken: Vec::new(),
            embree: wanted(Leg::Embree),
            world: match self.leg.contains(&Leg::Embree) {
                true => Extent::All,
                false => Extent::Small,
            },
            rivals: match self.rivals {
                true => Extent::All,
                false => Extent::Small,
            },
            paths: self.on.paths(),
            from,
            vertex: self.vertex,
            skip: !self.no_skip,
            seed: self.seed,
            dump: self.dump.as_ref().map(Dump::new),
            pictures: true,
            cache: None,
        })
    }
}

/// An option whose values are listed, ready for a shell.
fn chosen(name: &str, value: impl ValueEnum) -> String {
    let value = value.to_possible_value().expect("no value is hidden");
    option(name, value.get_name())
}
