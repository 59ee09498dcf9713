//! `triptych replay`.

use std::io::Write;
use std::path::PathBuf;
use std::time::Instant;

use anyhow::Context;
use clap::ValueEnum;
use triptych_gpu::kernel::Foreign;
use triptych_gpu::raster::Path;

use super::Verdict;
use super::adapters::{adapters, could_not_run};
use super::bench::abuffer::last_bench;
use super::kernel::{Kernels, all_run, kernels};
use super::mutants::last_mutants;
use super::results::Results;
use super::run_info::run_info;
use crate::again::{Again, option};
use crate::cache::Cache;
use crate::corpus::Entry;
use crate::dump::Dump;
use crate::output::{complain, stdout};
use crate::replay::gpu::{Adapter, Adapters, From, Vertices};
use crate::replay::{Extent, Options, Outcome, replay};
use crate::report::{self, ReportInput, RunInfo};
use crate::row::Summary;
use crate::{corpus, embree, snapshot};

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
    /// Whose vertices the GPU's later stages get
    #[arg(long, value_name = "WHOSE", default_value = "spec")]
    vertex: Vertices,
    /// Feed the GPU with the spec's results before this stage, its own from there
    /// [default: cover]
    #[arg(long, value_name = "STAGE")]
    gpu_from: Option<From>,
    /// The user's kernels of a stage in place of ours (repeatable); `STAGE=?` prints the
    /// stage's bindings as WGSL to start from
    #[arg(long, value_name = "STAGE=FILE")]
    kernel: Vec<String>,
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
    /// Leave pending snapshots of scenes whose facts are not what theirs says
    #[arg(long)]
    snapshot: bool,
    /// Open the report
    #[arg(long)]
    open: bool,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Leg {
    Spec,
    Gpu,
    /// In screen space, and in world space of every scene, however large
    Embree,
}

#[derive(Clone, Copy, ValueEnum)]
pub(super) enum PathName {
    /// The hardware's rasteriser
    Fragment,
    /// Integer arithmetic in baseline WGSL
    Compute,
    /// The same with 64-bit integers, where an adapter has them
    Native,
}

impl PathName {
    pub(super) fn path(self) -> Path {
        match self {
            Self::Fragment => Path::Fragment,
            Self::Compute => Path::Compute,
            Self::Native => Path::Native,
        }
    }
}

pub fn run(args: &Args) -> anyhow::Result<Verdict> {
    let start = Instant::now();
    let foreign = match kernels(&args.kernel)? {
        Kernels::Run(foreign) => foreign,
        Kernels::Print(text) => {
            stdout().write_all(text.as_bytes())?;
            return Ok(Verdict::Agree);
        }
    };
    let entries = corpus::list(&corpus::root())?;
    let selected = corpus::select(&entries, &args.patterns, args.exact)?;
    let mut options = args.options()?;
    all_run(&foreign, &options)?;
    anyhow::ensure!(
        foreign.is_empty() || options.vertex != Vertices::Hardware,
        "--kernel has no part in --vertex hardware; leave one of them out"
    );
    let found = args.adapters(&options, &foreign)?;
    if found.open.is_empty() && !found.broken.is_empty() {
        return could_not_run(found.broken);
    }
    found.broken.iter().for_each(complain);
    let adapters = found.open;
    options.broken = found.broken;
    let library = if options.embree {
        Some(embree::library()?)
    } else {
        None
    };
    let out = corpus::root().with_file_name("reports").join("out");
    options.cache = args.cache(&out)?;
    let mut results = Results::new(selected.len(), args.again(), args.json.as_deref())?;
    let of_cache = options.cache.iter().flat_map(Cache::remarks);
    for remark in of_cache.chain(foreign.iter().map(instead)) {
        results.reporter.remark(&remark)?;
    }
    let mut unreadable = Vec::new();
    for entry in &selected {
        results.reporter.scene_started(&entry.name);
        match replay(entry, &adapters, &options) {
            Ok(outcome) => {
                if args.snapshot {
                    leave_snapshot(entry, &outcome, &mut results)?;
                }
                results.add(entry.argument(&entries), outcome)?;
            }
            Err(error) => unreadable.push(error),
        }
    }
    if results.scenes.is_empty() && !unreadable.is_empty() {
        drop(results);
        return could_not_run(unreadable);
    }
    let summary = results.summary(start.elapsed().as_secs_f64())?;
    let seconds = summary.seconds;
    let run = run_info(&adapters, &options.broken, library.as_ref(), seconds);
    let page = publish(&out, run, results, &summary)?;
    if args.open {
        open(&page)?;
    }
    if !unreadable.is_empty() {
        return could_not_run(unreadable);
    }
    verdict(&summary)
}

/// Leaves the scene's snapshot pending, unless it is what the accepted one says.
fn leave_snapshot(entry: &Entry, outcome: &Outcome, results: &mut Results) -> anyhow::Result<()> {
    let Some(facts) = &outcome.facts else {
        return Ok(());
    };
    let left = snapshot::leave(&corpus::root(), entry, &outcome.purpose, facts);
    if let Some(path) = left.context("cannot leave a pending snapshot")? {
        let remark = format!("pending snapshot: {}", path.display());
        results.reporter.remark(&remark)?;
    }
    Ok(())
}

/// Writes the report, and ends what the terminal shows.
fn publish(
    out: &std::path::Path,
    run: RunInfo,
    mut results: Results,
    summary: &Summary,
) -> anyhow::Result<PathBuf> {
    let mutants = last_mutants(out, &mut results)?;
    let bench = last_bench(out, &mut results)?;
    let Results {
        mut reporter,
        scenes,
        ..
    } = results;
    let page = out.join("index.html");
    let input = ReportInput {
        run,
        scenes,
        mutants,
        bench,
    };
    report::write(&page, &input).with_context(|| format!("cannot write {}", page.display()))?;
    reporter.finish(summary, Some(&page))?;
    Ok(page)
}

/// Whose kernel runs.
fn instead(kernel: &Foreign) -> String {
    let (stage, file) = (kernel.stage.name, &kernel.file);
    format!("stage {stage} runs {file} on every adapter, not our kernel")
}

/// A run that compared nothing at all has not agreed on anything.
fn verdict(summary: &Summary) -> anyhow::Result<Verdict> {
    if summary.diverging > 0 {
        return Ok(Verdict::Diverge);
    }
    anyhow::ensure!(
        summary.compared > 0,
        "nothing was compared; see what was skipped, and why"
    );
    Ok(Verdict::Agree)
}

fn open(page: &std::path::Path) -> anyhow::Result<()> {
    let opener = if cfg!(target_os = "macos") {
        "open"
    } else {
        "xdg-open"
    };
    let status = std::process::Command::new(opener).arg(page).status();
    match status {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => anyhow::bail!("{opener} {}: {status}", page.display()),
        Err(error) => anyhow::bail!("{opener} {}: {error}", page.display()),
    }
}

impl Args {
    fn adapters(&self, options: &Options, foreign: &[Foreign]) -> anyhow::Result<Adapters> {
        if !options.gpu {
            return Ok(Adapters::default());
        }
        let mut adapters = adapters(&self.adapter)?;
        let runs = |a: &Adapter, path: &Path| *path != Path::Native || a.native.is_some();
        let runs_any = |a: &Adapter| options.paths.iter().any(|path| runs(a, path));
        anyhow::ensure!(
            adapters.open.is_empty() || adapters.open.iter().any(runs_any),
            "no adapter that was asked for has the 64-bit integers that --path native needs"
        );
        for adapter in &mut adapters.open {
            adapter.use_foreign(foreign);
        }
        Ok(adapters)
    }

    /// The cache, unless all is to run.
    fn cache(&self, out: &std::path::Path) -> anyhow::Result<Option<Cache>> {
        if self.no_cache || self.dump.is_some() || !self.kernel.is_empty() {
            return Ok(None);
        }
        let cache = Cache::open(&out.join("cache")).context("cannot open the cache")?;
        Ok(Some(cache))
    }

    /// What a command must repeat to see the same result.
    fn again(&self) -> Again {
        let mut legs: Vec<String> = self.leg.iter().map(|leg| chosen("--leg", *leg)).collect();
        legs.extend(self.adapter.iter().map(|name| option("--adapter", name)));
        legs.extend(self.path.map(|path| chosen("--path", path)));
        let mut options = Vec::new();
        options.extend(self.seed.map(|seed| option("--seed", &seed.to_string())));
        if self.vertex != Vertices::default() {
            options.push(chosen("--vertex", self.vertex));
        }
        let from = self.gpu_from.filter(|from| *from != From::default());
        options.extend(from.map(|from| chosen("--gpu-from", from)));
        options.extend(self.kernel.iter().map(|kernel| option("--kernel", kernel)));
        options.extend(self.no_skip.then(|| "--no-skip".to_owned()));
        Again { legs, options }
    }

    fn options(&self) -> anyhow::Result<Options> {
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
            paths: match self.path {
                None => Options::default().paths,
                Some(path) => vec![path.path()],
            },
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
