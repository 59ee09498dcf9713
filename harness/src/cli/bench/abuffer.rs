//! `triptych bench abuffer`.

use std::io::Write;
use std::num::NonZeroU32;
use std::path::PathBuf;

use super::super::kernel::{Kernels, kernels};
use super::super::paths::OnPaths;
use super::super::results::Results;
use super::super::run_info::today;
use super::super::scenes::Scenes;
use super::super::{Verdict, reports};
use crate::bench::{Bench, Options, Progress, Row, csv, markdown, run as measure, svg, table};
use crate::corpus::{self, Entry};
use crate::mesh::Intake;
use crate::output::{complain, stdout};
use crate::registry::{FAMILIES, RIVALS};
use crate::text::clean;
use triptych_gpu::kernel::Foreign;
use triptych_spec::raster::Samples;

/// Among the results, what the report reads.
const FILE: &str = "abuffer.json";

/// The family whose stages are measured.
const FAMILY: &str = "abuffer";

/// Bytes that it may have; a row has about a thousand.
const FILE_MAX: u64 = 1 << 26;

#[derive(clap::Args)]
#[command(after_help = "Examples:\n  \
    triptych bench abuffer                    the paper's tables, then three real meshes, every adapter and path\n  \
    triptych bench abuffer --paper --adapter llvmpipe     the paper's tables alone\n  \
    triptych bench abuffer --full --adapter nvidia        2^30 fragments, in bands of rows\n  \
    triptych bench abuffer sponza --rivals --samples 1,4 --budget 2\n  \
    triptych bench abuffer bunny --layers 1,2,4 --runs 31\n  \
    triptych bench abuffer --adapter nvidia --path compute --out results\n\n\
    Every picture is compared with the spec's before and after it is timed. Exit code 1: one \
    is outside the spec's bound. 2: nothing could be measured.")]
#[command(mut_arg("patterns", |patterns| patterns.help("Parts of scene names, scene files, or meshes; the paper's scenes and three real meshes without one")))]
pub struct Args {
    #[command(flatten)]
    scenes: Scenes,
    #[command(flatten)]
    on: OnPaths,
    /// The paper's Table 1 and Figure 4 alone, or beside the scenes that are named
    #[arg(long)]
    paper: bool,
    /// Nothing but fragments: 64 full layers, 64 of which a wall hides 56, and 2^30 fragments on a board
    #[arg(long)]
    full: bool,
    /// Rounds that count, after two, and a second of each adapter, to warm up [default: 21, and 5
    /// of software drivers]
    #[arg(long, value_name = "N")]
    runs: Option<NonZeroU32>,
    /// Numbers of nearest layers beside all [default: 1, 2, 4, …]
    #[arg(long, value_name = "N,…", value_delimiter = ',')]
    layers: Vec<NonZeroU32>,
    /// Samples a pixel, in turn: 1, 2, 4, 8 [default: those of the scene]
    #[arg(long, value_name = "N,…", value_delimiter = ',', value_parser = samples)]
    samples: Vec<u32>,
    /// Other layouts of the lists, peeling, alpha blending and others beside them, whatever they take
    #[arg(long)]
    rivals: bool,
    /// Memory of lists, and of tiles, in GiB, beyond which they are made in bands [default: 1 on a software
    /// driver, 16 on a board]
    #[arg(long, value_name = "GIB", value_parser = gibibytes)]
    budget: Option<u64>,
    /// The user's kernels of a stage in place of ours (repeatable); then all are checked
    #[arg(long, value_name = "STAGE=FILE")]
    kernel: Vec<String>,
    /// Write the results as JSON here, too
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Write the rows as comma-separated values here, too
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Write the front of time against error here, too
    #[arg(long, value_name = "FILE")]
    svg: Option<PathBuf>,
    /// Where all of them and a page to be committed go [default: reports/out/bench]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

pub fn run(args: &Args) -> anyhow::Result<Verdict> {
    let foreign = match kernels(&args.kernel)? {
        Kernels::Run(foreign) => foreign,
        Kernels::Print(text) => {
            stdout().write_all(text.as_bytes())?;
            return Ok(Verdict::Agree);
        }
    };
    all_run(&foreign)?;
    let entries = corpus::list(&corpus::root())?;
    let options = args.options(&entries)?;
    let own = [&args.json, &args.csv, &args.svg].into_iter().flatten();
    reports::can_write(own.chain([&args.folder().join(FILE)]))?;
    let mut adapters = args.on.usable()?.open;
    adapters.iter_mut().for_each(|a| a.use_foreign(&foreign));
    let outcome = measure(&entries, &adapters, &options, &Progress::new());
    let outcome = outcome.map_err(anyhow::Error::msg)?;
    let mut out = stdout();
    for line in table::lines(&outcome.bench) {
        writeln!(out, "{}", line.trim_end())?;
    }
    for remark in &outcome.bench.remarks {
        writeln!(out, "{}", clean(remark))?;
    }
    args.write(&outcome.bench)?;
    outcome.wrong.iter().for_each(complain);
    if !outcome.wrong.is_empty() {
        return Ok(Verdict::Diverge);
    }
    let gpu = |row: &Row| row.leg != "spec";
    anyhow::ensure!(
        outcome.bench.rows.iter().any(gpu),
        "nothing was measured on an adapter; see what was not, and why"
    );
    // The other stages are part of every frame.
    let opaque = foreign.iter().find(|f| f.stage.name == "opaque");
    let drawn = |row: &Row| row.parts.iter().any(|(part, _)| part == "opaque");
    if let Some(Foreign { file, .. }) = opaque.filter(|_| !outcome.bench.rows.iter().any(drawn)) {
        anyhow::bail!("--kernel opaque={file}: no scene that was measured has opaque triangles");
    }
    Ok(Verdict::Agree)
}

/// A number of samples that a pixel may have.
fn samples(text: &str) -> Result<u32, String> {
    let count = text.parse().ok().and_then(Samples::standard);
    let count = count.map(Samples::count);
    count.ok_or_else(|| "a pixel has 1, 2, 4 or 8 samples".to_owned())
}

/// Bytes of so many GiB, of which there may be a part.
fn gibibytes(text: &str) -> Result<u64, String> {
    const MOST: f64 = 1024.0;
    let gib: Option<f64> = text.parse().ok();
    let gib = gib.filter(|gib| *gib > 0.0 && *gib <= MOST);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "positive, and below 2^41"
    )]
    let bytes = gib.map(|gib| (gib * f64::from(1 << 30)) as u64);
    bytes.ok_or_else(|| format!("a number of GiB above 0, up to {MOST}"))
}

/// Whether a frame runs all of these kernels: it starts from snapped triangles, and makes
/// no stream of what they cover.
fn all_run(foreign: &[Foreign]) -> anyhow::Result<()> {
    let drawn = |name: &str| name == FAMILY || name == "tiles";
    let families = FAMILIES.iter().filter(|family| drawn(family.name));
    let stages = families.flat_map(|family| family.stages);
    let names = stages.map(|stage| stage.name);
    let names: Vec<&str> = names.filter(|name| !RIVALS.contains(name)).collect();
    match foreign.iter().find(|f| !names.contains(&f.stage.name)) {
        None => Ok(()),
        Some(Foreign { stage, file, .. }) => anyhow::bail!(
            "--kernel {}={file}: no frame of bench runs this stage, only {}",
            stage.name,
            names.join(", ")
        ),
    }
}

impl Args {
    fn options(&self, corpus: &[Entry]) -> anyhow::Result<Options> {
        Ok(Options {
            scenes: self.scenes.if_any(corpus)?,
            paths: self.on.paths(),
            paper: self.paper,
            full: self.full,
            runs: self.runs.map(NonZeroU32::get),
            samples: self.samples.clone(),
            rivals: self.rivals,
            budget: self.budget,
            layers: match self.layers.is_empty() {
                true => None,
                false => Some(self.layers.iter().map(|n| n.get()).collect()),
            },
            date: today(),
        })
    }

    fn folder(&self) -> PathBuf {
        self.out.clone().unwrap_or_else(reports::bench)
    }

    /// Writes what was measured, in all forms. Results that are wrong are not among them.
    fn write(&self, bench: &Bench) -> anyhow::Result<()> {
        let folder = self.folder();
        let json = serde_json::to_string_pretty(bench)? + "\n";
        let (csv, svg) = (csv::csv(bench), svg::file(bench));
        let stem = bench.stem();
        let files = [
            (folder.join(FILE), &json),
            (folder.join("abuffer.csv"), &csv),
            (folder.join("abuffer.svg"), &svg),
            (folder.join(format!("{stem}.csv")), &csv),
            (folder.join(format!("{stem}.svg")), &svg),
            (folder.join(format!("{stem}.md")), &markdown::page(bench)),
        ];
        let extra = [(&self.json, &json), (&self.csv, &csv), (&self.svg, &svg)];
        let extra = extra
            .into_iter()
            .filter_map(|(to, text)| Some((to.clone()?, text)));
        for (file, text) in files.into_iter().chain(extra) {
            reports::write(&file, text)?;
        }
        writeln!(stdout(), "Results: {}", folder.display())?;
        Ok(())
    }
}

/// The last measurement, for the report; a file that cannot be read is worth a remark.
pub(in crate::cli) fn last_bench(results: &mut Results) -> anyhow::Result<Option<Bench>> {
    let file = reports::bench().join(FILE);
    if !file.is_file() {
        return Ok(None);
    }
    let text = Intake::from_disk().read(&file, FILE_MAX);
    let text = text.map_err(|error| error.to_string());
    let bench = text.and_then(|text| {
        let parsed = serde_json::from_slice(&text);
        parsed.map_err(|error| format!("{}: {error}", file.display()))
    });
    match bench {
        Ok(bench) => Ok(Some(bench)),
        Err(error) => {
            results.reporter.remark(&error)?;
            Ok(None)
        }
    }
}
