//! All scenes and settings.

use std::path::PathBuf;

use triptych_spec::ldm::Maps;

use super::super::legs::{Station, stations};
use super::super::{Ceilings, Machine, Progress};
use super::case::Case;
use super::rival::{self, Contest};
use super::{SCENES, Sweep, gpu, judge, skips};
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
    let mut sweep = Sweep {
        date: options.date.clone(),
        machine: Machine::here(adapters),
        runs: options.runs,
        rows: Vec::new(),
        contests: Vec::new(),
        skips: Vec::new(),
        pictures: Vec::new(),
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

/// A setting on an adapter.
fn measured(
    of: (&Station<'_>, Option<&Ceilings>),
    case: &Case<'_>,
    (maps, directions): (&Maps, u32),
    with: With,
    runs: u32,
) -> Result<gpu::Measured, String> {
    let made = judge::made(of.0, case, maps, with.chains)?;
    gpu::measure(of, case, (maps, directions), (&made, with.picture), runs)
}

/// What is looked at beside frames.
#[derive(Clone, Copy)]
struct With {
    chains: bool,
    picture: bool,
}

/// Why a setting is not measured.
fn at(name: &str, station: &Station<'_>, (directions, pixels): (u32, u32), why: &str) -> String {
    let adapter = &station.adapter.gpu.name;
    format!("{name}: {directions} directions, {pixels} pixels: gpu@{adapter}: {why}")
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
    /// Maps over directions and resolutions.
    fn vary(
        &mut self,
        mut case: Case<'_>,
        (stations, ceilings): (&[Station<'_>], &[Option<Ceilings>]),
        runs: u32,
        progress: &Progress,
    ) {
        let name = case.name.clone();
        let settings = settings(&case);
        let steps = settings.len() * stations.len();
        progress.begin(&name, u32::try_from(steps).unwrap_or(u32::MAX));
        let own = settings[0];
        for (directions, resolution) in settings {
            let turn = match case.turn(directions, resolution) {
                Ok(turn) => turn,
                Err(why) => {
                    self.not(&format!("{name}: {why}"));
                    continue;
                }
            };
            let is_chained = directions == own.0 && [own.1, CHAINED].contains(&resolution);
            let with = With {
                chains: is_chained,
                picture: true,
            };
            for (station, ceilings) in stations.iter().zip(ceilings) {
                if !is_fit(station, &case, directions) {
                    progress.step();
                    continue;
                }
                let of = (station, ceilings.as_ref());
                match measured(of, &case, (&turn.maps, directions), with, runs) {
                    Ok(measured) => {
                        self.rows.extend(measured.rows);
                        let is_first = !self.pictures.iter().any(|(of, _)| *of == name);
                        let picture = measured.picture.filter(|_| is_first);
                        self.pictures.extend(picture.map(|png| (name.clone(), png)));
                        if let Some(why) = measured.missing {
                            self.not(&at(&name, station, (directions, resolution), &why));
                        }
                    }
                    Err(why) => self.not(&at(&name, station, (directions, resolution), &why)),
                }
                progress.step();
            }
        }
    }

    /// What the plan leaves out, with and without.
    fn leave_out(
        &mut self,
        case: Case<'_>,
        stations: &[Station<'_>],
        runs: u32,
        progress: &Progress,
    ) {
        progress.begin(
            &case.name,
            u32::try_from(stations.len()).unwrap_or(u32::MAX),
        );
        for station in stations {
            if is_fit(station, &case, case.setup.directions) {
                let skips = skips::measure(station, &case, runs);
                match skips {
                    Ok(skips) => self.skips.push(skips),
                    Err(why) => {
                        let adapter = &station.adapter.gpu.name;
                        self.not(&format!("{}: gpu@{adapter}: {why}", case.name));
                    }
                }
            }
            progress.step();
        }
    }

    /// Maps and horizons, over distances.
    fn contend(
        &mut self,
        mut case: Case<'_>,
        stations: &[Station<'_>],
        runs: u32,
        progress: &Progress,
    ) {
        let case = &mut case;
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
                    let with = With {
                        chains: false,
                        picture: false,
                    };
                    match measured(of, case, (&turn.maps, directions), with, runs) {
                        Ok(measured) => {
                            let asked = measured.rows.into_iter().filter_map(|row| row.asked);
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
                        }
                        Err(why) => self.not(&format!("{}: maps: {why}", case.name)),
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
