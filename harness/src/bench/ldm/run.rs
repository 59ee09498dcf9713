//! All scenes and settings.

use std::path::PathBuf;

use triptych_spec::ldm::Maps;

use super::super::legs::{Station, stations};
use super::super::{Ceilings, Machine, Progress};
use super::case::Case;
use super::rival::{self, Contest};
use super::{Row, SCENES, Sweep, gpu, judge};
use crate::corpus::Entry;
use crate::mesh::Intake;
use crate::replay::gpu::Adapter;
use crate::scene::{LoadError, Loaded, load_entry, load_text};

/// Numbers of directions, at a scene's own resolution.
pub const DIRECTIONS: [u32; 6] = [16, 64, 128, 256, 512, 1024];

/// Resolutions, with a scene's own number of directions.
pub const RESOLUTIONS: [u32; 5] = [25, 50, 100, 200, 400];

/// Beside a scene's own, the resolution at which lists are also built as the paper has them.
const CHAINED: u32 = 50;

/// Pairs of a triangle and a map, and of a receiver and a map, up to which a software driver is
/// measured: some seconds.
const OF_SOFTWARE: [u64; 2] = [1 << 23, 1 << 26];

/// What is measured, and how.
#[derive(Clone, Debug)]
pub struct Options {
    /// The scenes; `None`: those of [`SCENES`].
    pub scenes: Option<Vec<Entry>>,
    /// How often every triangle is cut into four, beside not at all.
    pub cuts: u32,
    /// Whether maps are held against horizons, at their own resolution, in place of sweeps.
    pub rival: bool,
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
    let mut sweep = Sweep {
        date: options.date.clone(),
        machine: Machine::here(adapters),
        runs: options.runs,
        rows: Vec::new(),
        contests: Vec::new(),
        remarks: Vec::new(),
    };
    let stations = stations(adapters, &mut sweep.remarks);
    let ceilings: Vec<Option<Ceilings>> = stations
        .iter()
        .map(|s| Ceilings::of(&s.adapter.gpu, &s.kernels, options.runs.min(5)).ok())
        .map(|measured| measured.map(|(ceilings, _)| ceilings))
        .collect();
    for loaded in &sweep.load(options)? {
        for cuts in [0, options.cuts]
            .into_iter()
            .take(1 + usize::from(options.cuts > 0))
        {
            let name = match cuts {
                0 => loaded.name.clone(),
                _ => format!("{}, each triangle as {}", loaded.name, 4_u32.pow(cuts)),
            };
            let mut case = match Case::new(&name, loaded, cuts) {
                Ok(case) => case,
                Err(why) => {
                    sweep.not(&format!("{name}: {why}"));
                    continue;
                }
            };
            if options.rival {
                sweep.contend(&mut case, &stations, options.runs, progress);
                continue;
            }
            let settings = settings(&case);
            let steps = settings.len() * stations.len();
            progress.begin(&name, u32::try_from(steps).unwrap_or(u32::MAX));
            let own = settings[0];
            for (directions, resolution) in settings {
                let turn = match case.turn(directions, resolution) {
                    Ok(turn) => turn,
                    Err(why) => {
                        sweep.not(&format!("{name}: {why}"));
                        continue;
                    }
                };
                for (station, ceilings) in stations.iter().zip(&ceilings) {
                    if !is_fit(station, &case, directions) {
                        progress.step();
                        continue;
                    }
                    let of = (station, ceilings.as_ref());
                    let as_chains =
                        directions == own.0 && (resolution == own.1 || resolution == CHAINED);
                    let setting = (&turn.maps, directions, as_chains);
                    let (rows, why) = measured(of, &case, setting, options.runs);
                    sweep.rows.extend(rows);
                    if let Some(why) = why {
                        let adapter = &station.adapter.gpu.name;
                        sweep.not(&format!(
                            "{name}: {directions} directions, {resolution} pixels: gpu@{adapter}: {why}"
                        ));
                    }
                    progress.step();
                }
            }
        }
    }
    progress.end();
    Ok(sweep)
}

/// The rows of a setting, and why there are not all of them.
fn measured(
    of: (&Station<'_>, Option<&Ceilings>),
    case: &Case<'_>,
    (maps, directions, as_chains): (&Maps, u32, bool),
    runs: u32,
) -> (Vec<Row>, Option<String>) {
    let rows = judge::made(of.0, case, maps, as_chains).and_then(|made| {
        let rows = gpu::measure(of, case, (maps, directions), &made, runs)?;
        Ok((rows, made.without_chains()))
    });
    rows.unwrap_or_else(|why| (Vec::new(), Some(why)))
}

/// The scene's own directions and resolution, then one of them changed.
fn settings(case: &Case<'_>) -> Vec<(u32, u32)> {
    let own = (case.setup.directions, case.setup.resolution);
    let mut all = vec![own];
    let directions = DIRECTIONS.map(|directions| (directions, own.1));
    let resolutions = RESOLUTIONS.map(|resolution| (own.0, resolution));
    for setting in directions.into_iter().chain(resolutions) {
        if !all.contains(&setting) {
            all.push(setting);
        }
    }
    all
}

/// Whether an adapter is no software driver, or there is little to do.
fn is_fit(station: &Station<'_>, case: &Case<'_>, directions: u32) -> bool {
    let maps = u64::from(directions);
    let triangles = case.setup.blockers.triangles.len() as u64;
    let receivers = case.receivers.len() as u64;
    let is_little = triangles * maps <= OF_SOFTWARE[0] && receivers * maps <= OF_SOFTWARE[1];
    station.adapter.gpu.info.device_type != wgpu::DeviceType::Cpu || is_little
}

impl Sweep {
    /// Maps and horizons, over distances.
    fn contend(
        &mut self,
        case: &mut Case<'_>,
        stations: &[Station<'_>],
        runs: u32,
        progress: &Progress,
    ) {
        let resolution = case.setup.resolution;
        let fars: Vec<_> = rival::fars(case).collect();
        progress.begin(&case.name, u32::try_from(fars.len()).expect("few"));
        for (far, falloff) in fars {
            if let Err(why) = case.fade(falloff) {
                self.not(&format!("{}: {why}", case.name));
                continue;
            }
            for directions in rival::DIRECTIONS {
                let turn = match case.turn(directions, resolution) {
                    Ok(turn) => turn,
                    Err(why) => {
                        self.not(&format!("{}: {why}", case.name));
                        continue;
                    }
                };
                for station in stations.iter().filter(|s| is_fit(s, case, directions)) {
                    let of = (station, None);
                    let (rows, why) = measured(of, case, (&turn.maps, directions, false), runs);
                    let asked = rows.into_iter().filter_map(|row| row.asked);
                    self.contests.extend(asked.map(|asked| Contest {
                        scene: case.name.clone(),
                        leg: format!("gpu@{}", station.adapter.gpu.name),
                        far,
                        technique: "maps",
                        setting: format!("{directions} at {resolution}"),
                        time: asked.frame,
                        random: asked.random,
                        noise: asked.noise,
                    }));
                    if let Some(why) = why {
                        self.not(&format!("{}: maps: {why}", case.name));
                    }
                }
            }
            for station in stations {
                match rival::horizons(station, case, far, runs) {
                    Ok(rows) => self.contests.extend(rows),
                    Err(why) => self.not(&format!("{}: horizons: {why}", case.name)),
                }
            }
            progress.step();
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

    fn not(&mut self, why: &str) {
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
