//! Stability: scenes driven to their extremes, one number at a time, through every leg.
//!
//! A sweep is a list of steps, each a scene of its own: a small mix of triangles with one
//! number that grows from step to step. Every step is replayed as any scene is, so that
//! its rows are those of [`crate::replay`]: the largest error of each stage, that error
//! over its bound, the share in class edge, what went unjudged, and what a leg refused.
//! [`Extremes::judge`] says what must hold of them; module `files` writes them down.

mod extremes;
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

pub use extremes::{Extremes, Pages};
pub use files::{Written, write};
pub use judge::{USEFUL, Wrong};
pub use measure::{Bound, Measured, bounded};
pub use numbers::Numbers;
pub use shot::{Edge, Shot, Vertex};
pub use sweeps::{Step, Sweep, select};
pub use table::{Lines, Table};

use std::path::Path;

use crate::error::InputError;
use crate::replay::gpu::Adapter;
use crate::replay::{Options, replay};
use crate::report::RunInfo;
use crate::row::Row;
use extremes::{entry_of, folder_of, load};
use files::pages;
use judge::{judge, useless};
use sweeps::sweeps;

/// The family that steps are of: the one that runs every stage.
const FAMILY: &str = "abuffer";

/// Triangles through every stage from vertices to the picture.
pub struct Frame;

impl Extremes for Frame {
    type Shot = Shot;
    type Measured = Measured;
    type Table = Table;
    const ENDING: &'static str = "";

    fn sweeps() -> Vec<Sweep<Shot>> {
        sweeps()
    }

    /// Writes a step's scene to `folder/SWEEP/STEP`, and replays it through all legs.
    fn run(
        sweep: &Sweep<Shot>,
        step: &Step<Shot>,
        folder: &Path,
        adapters: &[Adapter],
        options: &Options,
    ) -> Result<Measured, InputError> {
        let path = step.shot.write(&folder_of(folder, sweep, step))?;
        let entry = entry_of::<Frame>(FAMILY, sweep, step, path);
        let loaded = load(&entry)?.map_err(|words| InputError::new(&entry.path, words))?;
        let outcome = replay(&entry, adapters, options)?;
        Ok(Measured::new(
            sweep.name,
            step,
            &entry,
            outcome.rows,
            Numbers::of(&loaded.scene),
        ))
    }

    fn judge(measured: &Measured, legs: &[String]) -> Vec<Wrong> {
        judge(measured, legs)
    }

    fn useless(all: &[Measured]) -> Vec<Wrong> {
        useless(all)
    }

    fn rows(measured: &Measured) -> (&Path, &[Row]) {
        (&measured.path, &measured.rows)
    }

    fn pages(run: &RunInfo, sweeps: &[Sweep], all: &[Measured], wrong: &[Wrong]) -> Pages {
        pages(run, sweeps, all, wrong)
    }
}
