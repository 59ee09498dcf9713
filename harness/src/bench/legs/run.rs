//! All scenes.

use std::path::PathBuf;

use triptych_gpu::ceiling::Ceiling;
use triptych_gpu::kernel::Kernels;
use triptych_gpu::timer::Clock;

use super::super::run::named;
use super::super::{Machine, Progress};
use super::stages::Station;
use super::{HITS, LAYERS, Legs, STAGES, embree, stages};
use crate::corpus::Entry;
use crate::mesh::Intake;
use crate::replay::gpu::Adapter;
use crate::scene::{LoadError, Loaded, load_entry, load_text};

/// What is measured, and how.
#[derive(Clone, Debug)]
pub struct Options {
    /// The scenes, for everything; `None`: those of [`STAGES`], [`LAYERS`] and [`HITS`].
    pub scenes: Option<Vec<Entry>>,
    /// Rounds that count, at least one.
    pub runs: u32,
    /// Today, year-month-day.
    pub date: String,
}

/// Measures legs against each other on these adapters.
///
/// # Errors
/// One line for a scene that cannot be read; a mesh that is missing skips its scene, as
/// does one of our own choice that the corpus lacks.
pub fn run(
    corpus: &[Entry],
    adapters: &[Adapter],
    options: &Options,
    progress: &Progress,
) -> Result<Legs, String> {
    let mut legs = Legs {
        date: options.date.clone(),
        machine: Machine::here(adapters),
        runs: options.runs,
        rows: Vec::new(),
        remarks: Vec::new(),
    };
    let before = load();
    let stations = stations(adapters, &mut legs.remarks);
    let mut default = |names: &[&str]| named(corpus, names, &mut legs.remarks);
    let (of_stages, of_hits) = match &options.scenes {
        Some(scenes) => (scenes.clone(), scenes.clone()),
        None => (default(&STAGES), default(&HITS)),
    };
    for entry in &of_stages {
        if let Some(loaded) = legs.load(entry)? {
            legs.stages(&loaded, &stations, progress);
        }
    }
    if options.scenes.is_none() {
        legs.stages(&layers()?, &stations, progress);
    }
    for entry in &of_hits {
        if let Some(loaded) = legs.load(entry)? {
            match embree::measure(&loaded, options.runs, progress) {
                Ok(rows) => legs.rows.extend(rows),
                Err(why) => legs.not(&format!("{}: {why}", loaded.name)),
            }
        }
    }
    progress.end();
    if let (Some(before), Some(after)) = (before, load()) {
        let words = "processes that ran or wanted to, on average over a minute";
        let cores = legs.machine.cores;
        legs.remarks.push(format!(
            "{words}: {before} before, {after} after, on {cores} cores"
        ));
    }
    Ok(legs)
}

impl Legs {
    fn not(&mut self, why: &str) {
        self.remarks.push(format!("not measured: {why}"));
    }

    fn load(&mut self, entry: &Entry) -> Result<Option<Loaded>, String> {
        match load_entry(entry, None) {
            Ok(loaded) => Ok(Some(loaded)),
            Err(missing @ LoadError::Missing { .. }) => {
                self.not(&format!("{}: {missing}", entry.name));
                Ok(None)
            }
            Err(error) => Err(error.to_string()),
        }
    }

    fn stages(&mut self, loaded: &Loaded, stations: &[Station<'_>], progress: &Progress) {
        let (rows, refused) = stages::measure(loaded, stations, self.runs, progress);
        self.rows.extend(rows);
        refused.iter().for_each(|why| self.not(why));
    }
}

/// The scene of many layers.
fn layers() -> Result<Loaded, String> {
    let path = PathBuf::from("harness/src/bench/legs/layers.toml");
    let entry = Entry {
        name: "layers-64".to_owned(),
        ..Entry::outside(&path)
    };
    let loaded = load_text(&mut Intake::from_disk(), &entry, None, LAYERS);
    loaded.map_err(|error| error.to_string())
}

/// The adapters with their kernels and clocks.
pub(in crate::bench) fn stations<'a>(
    adapters: &'a [Adapter],
    remarks: &mut Vec<String>,
) -> Vec<Station<'a>> {
    let mut stations = Vec::new();
    for adapter in adapters {
        let kernels = Kernels::trusted(false, |sources| sources);
        let name = &adapter.gpu.name;
        let clock = Ceiling::new(&adapter.gpu, &kernels).map(|ceiling| ceiling.clock().clone());
        match clock {
            Ok(clock) => {
                if let Clock::Host(reason) = &clock {
                    remarks.push(format!("{name} is timed by the host's clock: {reason}"));
                }
                stations.push(Station {
                    adapter,
                    kernels,
                    clock,
                });
            }
            Err(error) => remarks.push(format!("not measured: {error}")),
        }
    }
    stations
}

/// What Linux says of the last minute.
fn load() -> Option<String> {
    let text = std::fs::read_to_string("/proc/loadavg").ok()?;
    text.split_whitespace().next().map(str::to_owned)
}

#[cfg(test)]
mod tests {
    use triptych_spec::raster::count;
    use triptych_spec::vertex::primitives;

    use super::layers;

    #[test]
    fn the_layers_fill_the_target() {
        let loaded = layers().unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(count(&primitives(&loaded.scene, 8)), 64 * 512 * 512);
        assert_eq!(count(&primitives(&loaded.scene, 4)), 64 * 512 * 512);
    }
}
