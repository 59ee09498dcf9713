//! All scenes.

use triptych_gpu::abuffer::{KEPT_MAX, with_layers};
use triptych_gpu::kernel::Kernels;
use triptych_gpu::raster::Path;
use triptych_gpu::timer::Clock;
use triptych_gpu::wgsl::Sources;

use super::counts::Work;
use super::scene::{Station, scene};
use super::{Bench, Ceilings, Machine, Progress, SCENES};
use crate::corpus::Entry;
use crate::replay::gpu::Adapter;
use crate::scene::{LoadError, load_entry};

/// What is measured, and how.
#[derive(Clone, Debug)]
pub struct Options {
    /// The scenes; `None`: those of [`SCENES`].
    pub scenes: Option<Vec<Entry>>,
    /// Raster paths.
    pub paths: Vec<Path>,
    /// Rounds that count, at least one.
    pub runs: u32,
    /// Numbers of nearest layers beside all, each at least one; `None`: 1, 2, 4, …
    pub layers: Option<Vec<u32>>,
    /// Today, year-month-day.
    pub date: String,
}

/// What came of a run.
pub struct Outcome {
    /// What was measured.
    pub bench: Bench,
    /// What is wrong, and was therefore not timed.
    pub wrong: Vec<String>,
}

/// The ceilings by leg.
pub(super) struct Bound<'c>(pub(super) &'c [Ceilings]);

impl Bound<'_> {
    /// What bounds such work on a leg, and the seconds that it allows at least.
    pub(super) fn of(&self, leg: &str, work: Work) -> (&'static str, f64) {
        self.own(leg).map_or(("bytes", 0.0), |c| c.bound(work))
    }

    /// Whose clock times a leg.
    pub(super) fn clock(&self, leg: &str) -> &str {
        self.own(leg).map_or("host", |c| &c.clock)
    }

    fn own(&self, leg: &str) -> Option<&Ceilings> {
        let name = leg.strip_prefix("gpu@").unwrap_or(leg);
        let name = name.rsplit_once('/').map_or(name, |(name, _)| name);
        self.0.iter().find(|c| c.name == name)
    }
}

/// Measures scenes on one core and on these adapters.
///
/// # Errors
/// One line for a scene that cannot be read; a mesh that is missing skips its scene, as
/// does a scene of [`SCENES`] that the corpus lacks.
pub fn run(
    corpus: &[Entry],
    adapters: &[Adapter],
    options: &Options,
    progress: &Progress,
) -> Result<Outcome, String> {
    let mut bench = Bench {
        family: "abuffer".to_owned(),
        date: options.date.clone(),
        machine: Machine::here(adapters),
        runs: options.runs,
        ceilings: Vec::new(),
        rows: Vec::new(),
        remarks: Vec::new(),
    };
    let mut wrong = Vec::new();
    progress.begin("ceilings", u32::try_from(adapters.len()).unwrap_or(0) + 1);
    bench.ceilings.push(Ceilings::of_core(options.runs));
    progress.step();
    let mut stations = Vec::new();
    for adapter in adapters {
        let mut station = station(adapter, options);
        match Ceilings::of(&adapter.gpu, &station.kernels, options.runs) {
            Ok((ceilings, clock)) => {
                if let Clock::Host(reason) = &clock {
                    let name = &adapter.gpu.name;
                    let words = format!("{name} is timed by the host's clock: {reason}");
                    bench.remarks.push(words);
                }
                bench.ceilings.push(ceilings);
                station.clock = clock;
                stations.push(station);
            }
            Err(error) => bench.remarks.push(format!("not measured: {error}")),
        }
        progress.step();
    }
    let entries = match &options.scenes {
        Some(scenes) => scenes.clone(),
        None => named(corpus, &SCENES, &mut bench.remarks),
    };
    for entry in &entries {
        let loaded = match load_entry(entry, None) {
            Ok(loaded) => loaded,
            Err(missing @ LoadError::Missing { .. }) => {
                let words = format!("not measured: {}: {missing}", entry.name);
                bench.remarks.push(words);
                continue;
            }
            Err(error) => return Err(error.to_string()),
        };
        progress.begin(&format!("{}: the spec", entry.name), options.runs);
        let done = scene(&loaded, &stations, options, &bench.ceilings, progress)
            .map_err(|error| format!("{}: {error}", entry.name))?;
        bench.rows.extend(done.rows);
        let skipped = done.skipped.iter();
        bench
            .remarks
            .extend(skipped.map(|why| format!("not measured: {why}")));
        wrong.extend(done.wrong);
    }
    bench.remarks.extend(bench.varying());
    progress.end();
    Ok(Outcome { bench, wrong })
}

/// The scenes of these names. Of those that a corpus lacks, as a bundle's may, it is said
/// once in the remarks that they were not measured.
pub fn named(corpus: &[Entry], names: &[&str], remarks: &mut Vec<String>) -> Vec<Entry> {
    let mut found = Vec::new();
    for name in names {
        let words = format!("not measured: {name}: not in this corpus");
        match corpus.iter().find(|entry| entry.name == *name) {
            Some(entry) => found.push(entry.clone()),
            None if remarks.contains(&words) => {}
            None => remarks.push(words),
        }
    }
    found
}

/// An adapter's kernels: trusted and unchecked as they ship, checked if any is the
/// user's.
fn station<'a>(adapter: &'a Adapter, options: &Options) -> Station<'a> {
    let wanted = options.layers.iter().flatten().copied();
    let powers = (0..31).map(|i| 1 << i).filter(|n| *n > KEPT_MAX);
    let mut layers: Vec<u32> = (1..=KEPT_MAX).chain(powers).chain(wanted).collect();
    layers.sort_unstable();
    layers.dedup();
    let kernels = |native| match adapter.foreign.is_empty() {
        true => Kernels::trusted(native, |sources| with_layers(sources, &layers)),
        false => {
            let sources = with_layers(Sources::shipped(native), &layers);
            Kernels::with_foreign(sources, &adapter.foreign)
        }
    };
    Station {
        adapter,
        clock: Clock::Device,
        kernels: kernels(false),
        native: adapter.native.as_ref().map(|_| kernels(true)),
    }
}
