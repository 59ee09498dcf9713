//! All scenes, resolutions and kinds of rays.

use super::super::legs::{Legs, stations};
use super::super::{Ceilings, Machine, Progress};
use super::scene::Scene;
use super::{RAYS, SCALES};
use crate::corpus::Entry;
use crate::replay::gpu::Adapter;
use crate::replay::grid::blockers;
use crate::scene::{LoadError, load_entry};

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
        let (_, blockers) = blockers(&loaded)?;
        if blockers.triangles.is_empty() {
            legs.remarks.push(format!(
                "not measured: {}: nothing blocks a ray",
                entry.name
            ));
            continue;
        }
        for scale in SCALES {
            match Scene::new(&entry.name, &blockers, scale, loaded.file.seed, options) {
                Ok(scene) => scene.measure(&stations, &ceilings, &mut legs, progress),
                Err(why) => {
                    let name = &entry.name;
                    legs.remarks
                        .push(format!("not measured: {name} at {scale}: {why}"));
                }
            }
        }
    }
    progress.end();
    Ok(legs)
}
