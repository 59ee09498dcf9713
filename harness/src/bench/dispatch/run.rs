//! All scenes, methods and numbers of threads.

use std::time::Duration;

use triptych_spec::scene::Size;

use super::scene::{Scene, Taken};
use super::{Measured, Method, Options, Row, Spent, board};
use crate::bench::legs::{Station, stations};
use crate::bench::{Machine, Progress, Spread};
use crate::dispatch::crew::Crew;
use crate::replay::dispatch::DispatchRun;
use crate::replay::gpu::Adapter;
use crate::scene::{LoadError, Loaded, load_entry};

/// Measures scenes on threads and adapters.
///
/// # Errors
/// One line for a scene that cannot be read; a mesh that is missing skips its scene.
pub fn run(
    adapters: &[Adapter],
    options: &Options,
    progress: &Progress,
) -> Result<Measured, String> {
    let mut measured = Measured {
        date: options.date.clone(),
        machine: Machine::here(adapters),
        frames: options.frames,
        runs: options.runs,
        boards: adapters
            .iter()
            .map(|a| format!("gpu@{}", a.gpu.name))
            .collect(),
        rows: Vec::new(),
        remarks: Vec::new(),
    };
    let stations = stations(adapters, &mut measured.remarks);
    for entry in &options.scenes {
        let loaded = match load_entry(entry, None) {
            Ok(loaded) => loaded,
            Err(missing @ LoadError::Missing { .. }) => {
                let why = format!("not measured: {}: {missing}", entry.name);
                measured.remarks.push(why);
                continue;
            }
            Err(error) => return Err(error.to_string()),
        };
        if let Err(why) = scene(loaded, options, &stations, &mut measured, progress) {
            let why = format!("not measured: {}: {why}", entry.name);
            measured.remarks.push(why);
        }
    }
    progress.end();
    Ok(measured)
}

/// A method with so many threads, and what was measured of it.
struct Trial {
    method: Method,
    threads: usize,
    /// Frames per second of each round.
    fps: Vec<f64>,
    spent: Option<Spent>,
    refused: Option<String>,
}

fn scene(
    mut loaded: Loaded,
    options: &Options,
    stations: &[Station<'_>],
    measured: &mut Measured,
    progress: &Progress,
) -> Result<(), String> {
    let size = &mut loaded.scene.size;
    if size.width == size.height {
        *size = Size {
            width: options.side,
            height: options.side,
        };
    }
    let name = loaded.name.clone();
    progress.begin(&format!("{name}: what the spec says"), 1);
    let run = DispatchRun::new(&loaded).map_err(|e| e.to_string())?;
    let scene = Scene::new(&name, run)?;
    let mut trials = trials(options);
    let steps = (options.runs + 2) * u32::try_from(trials.len()).expect("few");
    progress.begin(
        &format!("{name}: every queue with every number of threads"),
        steps,
    );
    // A frame each, so that nothing that counts is the first of its kind.
    rounds(&scene, &mut trials, (0, 1), progress);
    trials.iter_mut().for_each(|trial| trial.fps.clear());
    for round in 0..options.runs {
        rounds(&scene, &mut trials, (round, options.frames), progress);
    }
    for trial in &mut trials {
        trial.watch(&scene, options.frames);
        progress.step();
    }
    let alone = trials[0].fps.clone();
    for trial in trials {
        match &trial.refused {
            None => measured.rows.push(trial.row(&scene, &alone)),
            Some(why) => measured.remarks.push(format!(
                "not measured: {name}, {} with {} threads: {why}",
                trial.method.name(),
                trial.threads
            )),
        }
    }
    for station in stations {
        on_board(&scene, station, options, &alone, measured, progress);
    }
    Ok(())
}

/// An adapter's wavefront.
fn on_board(
    scene: &Scene,
    station: &Station<'_>,
    options: &Options,
    alone: &[f64],
    measured: &mut Measured,
    progress: &Progress,
) {
    let name = format!("gpu@{}", station.adapter.gpu.name);
    progress.begin(&format!("{}: {name}", scene.name), 1);
    let number = measured.boards.iter().position(|board| *board == name);
    let method = Method::Board(number.expect("every adapter has a number"));
    match board::measure(station, scene.run(), [options.runs, options.frames]) {
        Ok(fps) => {
            let trial = Trial {
                method,
                threads: 0,
                fps,
                spent: None,
                refused: None,
            };
            measured.rows.push(trial.row(scene, alone));
        }
        Err(why) => {
            let why = format!("not measured: {}, {name}: {why}", scene.name);
            measured.remarks.push(why);
        }
    }
    progress.step();
}

/// All of them, the sequential version first.
fn trials(options: &Options) -> Vec<Trial> {
    let trial = |method, threads| Trial {
        method,
        threads,
        fps: Vec::new(),
        spent: None,
        refused: None,
    };
    let mut trials = vec![trial(Method::Sequential, 1)];
    let methods = match options.papers {
        true => &Method::PAPERS_COUNTED[..],
        false => &Method::ON_THREADS[..],
    };
    for method in methods {
        let threads = options.threads.iter();
        trials.extend(threads.map(|threads| trial(*method, *threads)));
    }
    trials
}

/// Each once, every other round backwards.
fn rounds(scene: &Scene, trials: &mut [Trial], (round, frames): (u32, u32), progress: &Progress) {
    let mut order: Vec<usize> = (0..trials.len()).collect();
    if round % 2 == 1 {
        order.reverse();
    }
    for at in order {
        trials[at].measure(scene, frames);
        progress.step();
    }
}

impl Trial {
    fn crew(&self, watched: bool) -> Crew {
        Crew {
            threads: self.threads,
            ending: self.method.ending(),
            watched,
        }
    }

    fn measure(&mut self, scene: &Scene, frames: u32) {
        if self.refused.is_some() {
            return;
        }
        match scene.render(self.method, self.crew(false), frames) {
            Ok(taken) => self.fps.push(f64::from(frames) / taken.time.as_secs_f64()),
            Err(why) => self.refused = Some(why),
        }
    }

    /// What threads do with their time, of queues that can tell.
    fn watch(&mut self, scene: &Scene, frames: u32) {
        let tells = !matches!(
            self.method,
            Method::Sequential | Method::Rayon | Method::Embree
        );
        if !tells || self.refused.is_some() {
            return;
        }
        match scene.render(self.method, self.crew(true), frames) {
            Ok(Taken { spent, .. }) => {
                let sum = |of: fn(&crate::dispatch::crew::Spent) -> Duration| {
                    let all: Duration = spent.iter().map(of).sum();
                    1e3 * all.as_secs_f64() / f64::from(frames)
                };
                self.spent = Some(Spent {
                    idle: sum(|s| s.idle) / self.threads as f64,
                    access: sum(|s| s.access),
                });
            }
            Err(why) => self.refused = Some(why),
        }
    }

    fn row(self, scene: &Scene, alone: &[f64]) -> Row {
        let Size { width, height } = scene.size();
        let speed_up = self.fps.iter().zip(alone).map(|(own, alone)| own / alone);
        Row {
            scene: scene.name.clone(),
            size: [width, height],
            triangles: scene.triangles,
            rays: scene.rays,
            method: self.method,
            threads: self.threads,
            speed_up: Spread::of(speed_up),
            fps: Spread::of(self.fps),
            spent: self.spent,
        }
    }
}
