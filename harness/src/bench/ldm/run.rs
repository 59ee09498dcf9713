//! All scenes and settings.

use std::fmt::Display;
use std::path::PathBuf;

use super::super::legs::stations;
use super::super::{Ceilings, Machine, Progress};
use super::case::Case;
use super::{SCENES, Sweep};
use crate::corpus::Entry;
use crate::mesh::Intake;
use crate::replay::gpu::Adapter;
use crate::scene::{LoadError, Loaded, load_entry, load_text};

/// What is measured, and how.
#[derive(Clone, Debug)]
pub struct Options {
    /// The scenes; `None`: those of [`SCENES`].
    pub scenes: Option<Vec<Entry>>,
    /// How often every triangle is cut into four, beside not at all.
    pub cuts: u32,
    /// Whether maps are held against horizons, at their own resolution, in place of sweeps.
    pub rival: bool,
    /// Whether what the plan leaves out is measured, with and without, in place of sweeps.
    pub skips: bool,
    /// Rounds that count, at least one.
    pub runs: u32,
    /// Today, year-month-day.
    pub date: String,
}

/// Measures maps on these adapters.
///
/// # Errors
/// One line for a scene that cannot be read; a mesh that is missing skips its scene.
pub fn run(adapters: &[Adapter], options: &Options, progress: &Progress) -> Result<Sweep, String> {
    let mut sweep = Sweep::empty(&options.date, Machine::here(adapters), options.runs);
    let stations = stations(adapters, &mut sweep.remarks);
    let mut ceilings = Vec::new();
    for station in &stations {
        let gpu = &station.adapter.gpu;
        let measured = Ceilings::of(gpu, &station.kernels, options.runs.min(5));
        let own = measured.map(|(ceilings, _)| ceilings);
        ceilings.push(sweep.or_not(&format!("ceilings of {}", gpu.name), own));
    }
    for loaded in &sweep.load(options)? {
        for cuts in [0, options.cuts]
            .into_iter()
            .take(1 + usize::from(options.cuts > 0))
        {
            let name = match cuts {
                0 => loaded.name.clone(),
                _ => format!("{}, each triangle as {}", loaded.name, 4_u32.pow(cuts)),
            };
            let case = Case::new(&name, loaded, cuts);
            let asked = case.and_then(|mut case| {
                if !options.skips {
                    case.ask()?;
                }
                Ok(case)
            });
            match asked {
                Ok(case) if options.rival => sweep.contend(case, &stations, options.runs, progress),
                Ok(case) if options.skips => {
                    sweep.leave_out(case, &stations, options.runs, progress)
                }
                Ok(case) => sweep.vary(case, (&stations, &ceilings), options.runs, progress),
                Err(why) => sweep.not(&format!("{name}: {why}")),
            }
        }
    }
    progress.end();
    Ok(sweep)
}

impl Sweep {
    /// Nothing is measured yet.
    fn empty(date: &str, machine: Machine, runs: u32) -> Self {
        Self {
            date: date.to_owned(),
            machine,
            runs,
            rows: Vec::new(),
            contests: Vec::new(),
            skips: Vec::new(),
            pictures: Vec::new(),
            remarks: Vec::new(),
        }
    }

    /// The scenes that can be read.
    fn load(&mut self, options: &Options) -> Result<Vec<Loaded>, String> {
        let mut all = Vec::new();
        let read: Vec<(String, Result<Loaded, LoadError>)> = match &options.scenes {
            Some(scenes) => scenes
                .iter()
                .map(|entry| (entry.name.clone(), load_entry(entry, None)))
                .collect(),
            None => SCENES
                .iter()
                .map(|(name, text)| ((*name).to_owned(), own(name, text)))
                .collect(),
        };
        for (name, loaded) in read {
            match loaded {
                Ok(loaded) if loaded.file.ldm.is_none() => {
                    return Err(format!("{name} has no [ldm]; name a scene that has"));
                }
                Ok(loaded) => all.push(loaded),
                Err(missing @ LoadError::Missing { .. }) => {
                    self.not(&format!("{name}: {missing}"));
                }
                Err(error) => return Err(error.to_string()),
            }
        }
        Ok(all)
    }

    /// What could be measured; else a remark says why not.
    fn or_not<T>(&mut self, what: &str, measured: Result<T, impl Display>) -> Option<T> {
        let failed = |error| self.not(&format!("{what}: {error}"));
        measured.map_err(failed).ok()
    }

    pub(super) fn not(&mut self, why: &str) {
        self.remarks.push(format!("not measured: {why}"));
    }
}

/// A scene of ours.
fn own(name: &str, text: &str) -> Result<Loaded, LoadError> {
    let path = PathBuf::from(format!("harness/src/bench/ldm/{name}.toml"));
    let entry = Entry {
        name: name.to_owned(),
        ..Entry::outside(&path)
    };
    load_text(&mut Intake::from_disk(), &entry, None, text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_cannot_be_measured_is_remarked() {
        let mut sweep = Sweep::empty("2000-01-02", Machine::default(), 1);
        assert_eq!(sweep.or_not("a", Ok::<_, String>(7)), Some(7));
        assert_eq!(sweep.remarks, [""; 0]);
        assert_eq!(sweep.or_not::<u32>("ceilings of b", Err("lost")), None);
        assert_eq!(sweep.remarks, ["not measured: ceilings of b: lost"]);
    }

    #[test]
    fn our_scenes_are_of_the_papers_size() {
        for (name, text) in SCENES {
            match own(name, text) {
                Ok(loaded) => {
                    let size = loaded.scene.size;
                    assert_eq!([size.width, size.height], [800, 800], "{name}");
                    let ldm = loaded.file.ldm.expect("maps");
                    assert_eq!(ldm.get_ref().directions.0, 512, "{name}");
                }
                Err(LoadError::Missing { .. }) => {}
                Err(error) => panic!("{name}: {error}"),
            }
        }
    }
}
