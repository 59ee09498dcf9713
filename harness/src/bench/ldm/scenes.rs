//! All settings of a scene, on all adapters.

use triptych_spec::ldm::Maps;

use super::super::legs::Station;
use super::super::{Ceilings, Progress};
use super::case::Case;
use super::rival::{self, Contest};
use super::{Sweep, gpu, judge, skips};

/// Numbers of directions, at a scene's own resolution.
pub const DIRECTIONS: [u32; 6] = [16, 64, 128, 256, 512, 1024];

/// Resolutions, with a scene's own number of directions.
pub const RESOLUTIONS: [u32; 5] = [25, 50, 100, 200, 400];

/// Beside a scene's own, the resolution at which lists are also built as the paper has them.
const CHAINED: u32 = 50;

/// Pairs of a triangle and a map, and of a receiver and a map, up to which a software driver is
/// measured: some seconds.
const OF_SOFTWARE: [u64; 2] = [1 << 23, 1 << 26];

impl Sweep {
    /// Maps over directions and resolutions.
    pub(super) fn vary(
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
    pub(super) fn leave_out(
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
    pub(super) fn contend(
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
