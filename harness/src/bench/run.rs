//! All scenes.

use triptych_gpu::abuffer::{KEPT_MAX, with_layers};
use triptych_gpu::kernel::Kernels;
use triptych_gpu::raster::{MEMORY, Path};
use triptych_gpu::timer::Clock;
use triptych_gpu::wgsl::Sources;
use triptych_spec::raster::Samples;

use super::counts::Work;
use super::scene::scene;
use super::station::Station;
use super::{Bench, Ceilings, Machine, Progress, RUNS, SCENES, full, paper};
use crate::corpus::Entry;
use crate::replay::gpu::Adapter;
use crate::scene::{LoadError, Loaded, load_entry};

/// Rounds of a software driver, unless a number is asked for: a frame takes it seconds.
const RUNS_OF_SOFTWARE: u32 = 5;

/// Bytes that a technique's buffers take at most, unless asked for otherwise: of a software driver,
/// which shares the host's memory, and of a board.
const BUDGET: [u64; 2] = [MEMORY, 16 << 30];

/// What is measured, and how.
#[derive(Clone, Debug)]
pub struct Options {
    /// The scenes; `None`: those of [`SCENES`], and the paper's.
    pub scenes: Option<Vec<Entry>>,
    /// The paper's scenes, [`paper::SCENES`], alone.
    pub paper: bool,
    /// Those of nothing but fragments, [`full::SCENES`], alone.
    pub full: bool,
    /// Raster paths.
    pub paths: Vec<Path>,
    /// Rounds that count, at least one; `None`: [`RUNS`], few of a software driver.
    pub runs: Option<u32>,
    /// Numbers of nearest layers beside all, each at least one; `None`: 1, 2, 4, …
    pub layers: Option<Vec<u32>>,
    /// Samples a pixel, each number in turn; empty: those of the scene.
    pub samples: Vec<u32>,
    /// Techniques beside lists on every scene, whatever they take.
    pub rivals: bool,
    /// Bytes that the buffers of a technique may take.
    pub budget: Option<u64>,
    /// Today, year-month-day.
    pub date: String,
}

impl Options {
    pub(super) fn runs(&self, software: bool) -> u32 {
        let default = if software { RUNS_OF_SOFTWARE } else { RUNS };
        self.runs.unwrap_or(default)
    }

    pub(super) fn budget(&self, software: bool) -> u64 {
        let [host, board] = BUDGET;
        let default = if software { host } else { board };
        self.budget.unwrap_or(default)
    }
}

/// What is asked of a scene.
#[derive(Clone, Debug, Default)]
pub(super) struct Asked {
    /// Numbers of nearest layers beside all; `None`: 1, 2, 4, …
    pub(super) layers: Option<Vec<u32>>,
    /// Samples a pixel, each number in turn; empty: those of the scene.
    pub(super) samples: Vec<u32>,
    /// Whether techniques beside lists are measured.
    pub(super) rivals: bool,
    /// Whether it is too much for a software driver.
    pub(super) boards: bool,
    /// Whether what a scene does not need is skipped.
    pub(super) skip: bool,
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
        runs: options.runs(false),
        ceilings: Vec::new(),
        rows: Vec::new(),
        remarks: Vec::new(),
    };
    let mut wrong = Vec::new();
    let stations = bench.stations(adapters, options, progress);
    for (loaded, asked) in bench.scenes_of(corpus, options)? {
        for loaded in with_samples(loaded, &asked.samples) {
            progress.begin(&format!("{}: what must be", loaded.name), 1);
            let ceilings = &bench.ceilings;
            let done = scene(&loaded, &asked, &stations, options, ceilings, progress)
                .map_err(|error| format!("{}: {error}", loaded.name))?;
            bench.rows.extend(done.rows);
            let skipped = done.skipped.iter();
            bench
                .remarks
                .extend(skipped.map(|why| format!("not measured: {why}")));
            wrong.extend(done.wrong);
        }
    }
    bench.remarks.extend(bench.varying());
    progress.end();
    Ok(Outcome { bench, wrong })
}

/// A scene with each of these numbers of samples a pixel, by a name of its own.
fn with_samples(loaded: Loaded, samples: &[u32]) -> Vec<Loaded> {
    if samples.is_empty() {
        return vec![loaded];
    }
    let own = loaded.scene.samples;
    let standard = samples.iter().filter_map(|count| Samples::standard(*count));
    let with = |samples: Samples| {
        let mut loaded = loaded.clone();
        loaded.scene.samples = samples;
        if samples != own {
            loaded.name = format!("{} with {} samples", loaded.name, samples.count());
        }
        loaded
    };
    standard.map(with).collect()
}

impl Bench {
    /// The adapters with their kernels and clocks, once it is known what they can do at most.
    fn stations<'a>(
        &mut self,
        adapters: &'a [Adapter],
        options: &Options,
        progress: &Progress,
    ) -> Vec<Station<'a>> {
        progress.begin("ceilings", u32::try_from(adapters.len()).unwrap_or(0) + 1);
        self.ceilings.push(Ceilings::of_core(options.runs(true)));
        progress.step();
        let mut stations = Vec::new();
        for adapter in adapters {
            let mut station = station(adapter, options);
            let software = adapter.gpu.info.device_type == wgpu::DeviceType::Cpu;
            match Ceilings::of(&adapter.gpu, &station.kernels, options.runs(software)) {
                Ok((ceilings, clock)) => {
                    if let Clock::Host(reason) = &clock {
                        let name = &adapter.gpu.name;
                        let words = format!("{name} is timed by the host's clock: {reason}");
                        self.remarks.push(words);
                    }
                    self.ceilings.push(ceilings);
                    station.clock = clock;
                    stations.push(station);
                }
                Err(error) => self.remarks.push(format!("not measured: {error}")),
            }
            progress.step();
        }
        stations
    }

    /// The scenes that can be read, and what is asked of each.
    fn scenes_of(
        &mut self,
        corpus: &[Entry],
        options: &Options,
    ) -> Result<Vec<(Loaded, Asked)>, String> {
        let mut all = Vec::new();
        let ours = options.scenes.is_none() && !options.paper && !options.full;
        let paper = paper::SCENES.iter().filter(|_| options.paper || ours);
        let full = full::SCENES.iter().filter(|_| options.full);
        for own in paper.chain(full) {
            let loaded = self.loaded(own.name, own.load())?;
            let asked = own.asked(options);
            all.extend(loaded.map(|loaded| (loaded, asked)));
        }
        let entries = match &options.scenes {
            Some(scenes) => scenes.clone(),
            None if ours => named(corpus, &SCENES, &mut self.remarks),
            None => Vec::new(),
        };
        for entry in &entries {
            let loaded = self.loaded(&entry.name, load_entry(entry, None))?;
            let asked = Asked {
                layers: options.layers.clone(),
                samples: options.samples.clone(),
                rivals: options.rivals,
                boards: false,
                skip: true,
            };
            all.extend(loaded.map(|loaded| (loaded, asked)));
        }
        Ok(all)
    }

    /// A scene, unless its mesh is missing.
    fn loaded(
        &mut self,
        name: &str,
        loaded: Result<Loaded, LoadError>,
    ) -> Result<Option<Loaded>, String> {
        match loaded {
            Ok(loaded) => Ok(Some(loaded)),
            Err(missing @ LoadError::Missing { .. }) => {
                let words = format!("not measured: {name}: {missing}");
                self.remarks.push(words);
                Ok(None)
            }
            Err(error) => Err(error.to_string()),
        }
    }
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
