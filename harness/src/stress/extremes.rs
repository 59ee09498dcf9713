//! What the sweeps of all families have in common.

use std::path::Path;

use super::judge::Wrong;
use super::sweeps::{Step, Sweep};
use super::table::Lines;
use crate::corpus::Entry;
use crate::error::InputError;
use crate::replay::Options;
use crate::replay::gpu::Adapter;
use crate::report::RunInfo;
use crate::row::Row;
use crate::scene::{LoadError, Loaded, load_entry};

/// The extremes of a family: its sweeps, and what is made of their steps.
pub trait Extremes {
    /// What a step's scene is made from.
    type Shot;
    /// What came of a step.
    type Measured;
    /// A sweep as a table.
    type Table: Lines<Measured = Self::Measured>;
    /// What follows `stress` and `scenes` in names of files: nothing, or `-` and the family.
    const ENDING: &'static str;

    /// All sweeps, in order.
    fn sweeps() -> Vec<Sweep<Self::Shot>>;

    /// Legs that must be heard of, beside those of every replay.
    fn more_legs() -> Vec<String> {
        Vec::new()
    }

    /// Writes a step's scene below a folder, and runs it.
    ///
    /// # Errors
    /// A folder that cannot be written; what keeps a scene from being run, and is no result.
    fn run(
        sweep: &Sweep<Self::Shot>,
        step: &Step<Self::Shot>,
        folder: &Path,
        adapters: &[Adapter],
        options: &Options,
    ) -> Result<Self::Measured, InputError>;

    /// What does not hold of a step; so many legs must be heard of.
    fn judge(measured: &Self::Measured, legs: &[String]) -> Vec<Wrong>;

    /// What does not hold of steps together.
    fn unlike(_: &[Self::Measured]) -> Vec<Wrong> {
        Vec::new()
    }

    /// Bounds that no step of all sweeps comes near.
    fn useless(all: &[Self::Measured]) -> Vec<Wrong>;

    /// A step's scene, and its rows.
    fn rows(measured: &Self::Measured) -> (&Path, &[Row]);

    /// The page, and the table with a row for each step, leg and stage.
    fn pages(
        run: &RunInfo,
        sweeps: &[Sweep<Self::Shot>],
        all: &[Self::Measured],
        wrong: &[Wrong],
    ) -> Pages;
}

/// What a run writes.
pub struct Pages {
    /// In Markdown, for people.
    pub page: String,
    /// As CSV, for programs.
    pub table: String,
}

/// The folder of a step's scene.
pub(super) fn folder_of<S>(folder: &Path, sweep: &Sweep<S>, step: &Step<S>) -> std::path::PathBuf {
    folder.join(sweep.name).join(&step.label)
}

/// A step as an entry of a corpus.
pub(super) fn entry_of<E: Extremes>(
    family: &str,
    sweep: &Sweep<E::Shot>,
    step: &Step<E::Shot>,
    path: std::path::PathBuf,
) -> Entry {
    Entry {
        name: format!("stress{}/{}/{}", E::ENDING, sweep.name, step.label),
        family: family.to_owned(),
        path,
    }
}

/// A step's scene as it is read back, or the words that it is refused with.
///
/// # Errors
/// A mesh that is missing, which no step has.
pub(super) fn load(entry: &Entry) -> Result<Result<Loaded, String>, InputError> {
    match load_entry(entry, None) {
        Ok(loaded) => Ok(Ok(loaded)),
        Err(LoadError::Input(error)) => Ok(Err(error.message)),
        Err(missing @ LoadError::Missing { .. }) => {
            Err(InputError::new(&entry.path, missing.to_string()))
        }
    }
}
