//! Stability: scenes driven to their extremes, one number at a time, through every leg.
//!
//! A sweep is a list of steps, each a scene of its own: a small mix of triangles with one
//! number that grows from step to step. Every step is replayed as any scene is, so that
//! its rows are those of [`crate::replay`]: the largest error of each stage, that error
//! over its bound, the share in class edge, what went unjudged, and what a leg refused.
//! [`judge`] says what must hold of them; module `files` writes them down.

mod files;
pub mod grid;
mod judge;
pub mod ldm;
mod measure;
mod notes;
mod numbers;
mod shot;
mod sweeps;
mod table;
#[cfg(test)]
mod tests;
mod triangles;

pub use files::{Written, write};
pub use judge::{USEFUL, Wrong, judge, useless};
pub use measure::{Bound, Measured, bounded};
pub use numbers::Numbers;
pub use shot::{Edge, Shot, Vertex};
pub use sweeps::{Step, Sweep, select, sweeps};
pub use table::{Table, line};

use std::path::Path;

use crate::corpus::Entry;
use crate::error::InputError;
use crate::replay::gpu::Adapter;
use crate::replay::{Options, replay};
use crate::scene::{LoadError, load_entry};

/// The family that steps are of: the one that runs every stage.
const FAMILY: &str = "abuffer";

/// Writes a step's scene to `folder/SWEEP/STEP`, and replays it through all legs.
///
/// # Errors
/// A folder that cannot be written, or what keeps a scene from being replayed.
pub fn run(
    sweep: &Sweep,
    step: &Step,
    folder: &Path,
    adapters: &[Adapter],
    options: &Options,
) -> Result<Measured, InputError> {
    let folder = folder.join(sweep.name).join(&step.label);
    let path = step.shot.write(&folder)?;
    let entry = Entry {
        name: format!("stress/{}/{}", sweep.name, step.label),
        family: FAMILY.to_owned(),
        path,
    };
    let loaded = load_entry(&entry, None).map_err(|error| match error {
        LoadError::Input(error) => error,
        missing @ LoadError::Missing { .. } => InputError::new(&entry.path, missing.to_string()),
    })?;
    let outcome = replay(&entry, adapters, options)?;
    Ok(Measured::new(
        sweep.name,
        step,
        &entry,
        outcome.rows,
        Numbers::of(&loaded.scene),
    ))
}
