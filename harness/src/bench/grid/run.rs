//! All scenes, resolutions and kinds of rays.

use std::num::NonZeroU32;

use triptych_spec::grid::resolution::Resolution;
use triptych_spec::grid::trace::Query;
use triptych_spec::grid::{Blockers, Grid, Membership};

use super::super::legs::{Legs, Station, stations};
use super::super::{Ceilings, Machine, Progress};
use super::asking::Asking;
use super::cpu::Rivals;
use super::scene::{self, Scene};
use super::{RAYS, RUNS, SCALES};
use crate::corpus::Entry;
use crate::replay::gpu::Adapter;
use crate::replay::grid::blockers;
use crate::replay::rsm::Setup;
use crate::scene::{LoadError, Loaded, load_entry};

/// What is measured, and how.
#[derive(Clone, Debug)]
pub struct Options {
    /// The scenes.
    pub scenes: Vec<Entry>,
    /// Rounds that count, at least one.
    pub runs: u32,
    /// Rays of a kind.
    pub rays: u32,
    /// Today, year-month-day.
    pub date: String,
}

impl Options {
    /// Rays of a kind, unless another number is asked for.
    pub const RAYS: u32 = RAYS;
    /// Rounds that count, likewise.
    pub const RUNS: NonZeroU32 = NonZeroU32::new(RUNS).expect("more than none");
}

/// Measures grids on these adapters and on the CPU.
///
/// # Errors
/// One line for a scene that cannot be read; a mesh that is missing skips its scene.
pub fn run(adapters: &[Adapter], options: &Options, progress: &Progress) -> Result<Legs, String> {
    let mut legs = Legs {
        date: options.date.clone(),
        machine: Machine::here(adapters),
        runs: options.runs,
        rows: Vec::new(),
        remarks: Vec::new(),
    };
    let stations = stations(adapters, &mut legs.remarks);
    let mut ceilings = Vec::new();
    for station in &stations {
        match Ceilings::of(&station.adapter.gpu, &station.kernels, options.runs) {
            Ok((found, _)) => ceilings.push(found),
            Err(error) => legs.remarks.push(format!("no ceiling: {error}")),
        }
    }
    for entry in &options.scenes {
        let loaded = match load_entry(entry, None) {
            Ok(loaded) => loaded,
            Err(missing @ LoadError::Missing { .. }) => {
                legs.remarks
                    .push(format!("not measured: {}: {missing}", entry.name));
                continue;
            }
            Err(error) => return Err(error.to_string()),
        };
        if let Err(why) = measure(
            &loaded,
            options,
            (&stations, &ceilings),
            &mut legs,
            progress,
        ) {
            legs.remarks
                .push(format!("not measured: {}: {why}", entry.name));
        }
    }
    progress.end();
    Ok(legs)
}

/// A scene at all resolutions.
fn measure(
    loaded: &Loaded,
    options: &Options,
    (stations, ceilings): (&[Station<'_>], &[Ceilings]),
    legs: &mut Legs,
    progress: &Progress,
) -> Result<(), String> {
    let name = &loaded.name;
    let blockers = blockers_of(loaded)?;
    if blockers.triangles.is_empty() {
        return Err("nothing blocks a ray".to_owned());
    }
    let own = Grid::build(&blockers, Resolution::FromScene, Membership::Box);
    let own = own.map_err(|e| e.to_string())?;
    let rivals = Rivals::new(&blockers).map_err(|e| e.to_string())?;
    let software =
        |station: &Station<'_>| station.adapter.gpu.info.device_type == wgpu::DeviceType::Cpu;
    let boards = !stations.iter().all(software);
    progress.begin(&format!("{name}: rays and what the spec says of them"), 1);
    let drawn = (options.rays, boards);
    let kinds = Asking::all((&blockers, &own), loaded.file.seed, drawn, &rivals);
    progress.step();
    for asking in &kinds {
        for query in [Query::Any, Query::Closest] {
            let refused = asking.rivals(query).refused.iter();
            for (rival, why) in ["embree", "obvhs"].iter().zip(refused) {
                let (what, kind) = (scene::name(query), asking.kind);
                let words = why
                    .iter()
                    .map(|why| format!("not measured: {rival}: {name}, {what} {kind}: {why}"));
                legs.remarks.extend(words);
            }
        }
    }
    for scale in SCALES {
        match Scene::new(name, (&blockers, &own), scale, &kinds, &rivals) {
            Ok(scene) => scene.measure(stations, ceilings, legs, progress),
            Err(why) => legs
                .remarks
                .push(format!("not measured: {name} at {scale}: {why}")),
        }
    }
    Ok(())
}

/// What blocks rays in a scene: in one of indirect light what it says does, in others all
/// triangles.
fn blockers_of(loaded: &Loaded) -> Result<Blockers, String> {
    match loaded.file.rsm {
        None => Ok(blockers(loaded)?.1),
        Some(_) => Ok(Setup::new(loaded)?.parts(loaded, 0)?.blockers),
    }
}
