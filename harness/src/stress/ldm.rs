//! Stability of layered depth maps: grazing directions, steep surfaces, sheets that lie closer than
//! a pixel's slope, extreme sizes and offsets.
//!
//! A step is a scene with an `[ldm]`, as any scene file is, and replayed as one is: spec, every
//! adapter from the spec's lists and from its own, Embree. Beside that stands the scene as its files
//! have it, in `f64` and not rounded to the lattice (`exact.rs`): it says what points must find
//! (`found.rs`), and which part of the error of what is open comes from the number of directions,
//! from rounding, and from pixels (`parts.rs`). And each face is looked at by itself, where nothing
//! is in its way (`alone.rs`).

mod alone;
mod exact;
mod files;
mod found;
mod judge;
mod measure;
mod parts;
mod scenes;
mod shot;
mod sizes;
mod sweeps;
mod table;
#[cfg(test)]
mod tests;
mod texel;

pub use alone::Alone;
pub use found::Found;
pub use measure::{Bound, Measured};
pub use parts::{Error, Parts};
pub use shot::{Form, LdmShot};
pub use table::Table;

use std::path::Path;

use super::extremes::{Extremes, Pages, entry_of, folder_of, load};
use super::judge::Wrong;
use super::sweeps::{Step, Sweep};
use crate::error::InputError;
use crate::replay::gpu::Adapter;
use crate::replay::ldm::LdmRun;
use crate::replay::{Options, replay};
use crate::report::RunInfo;
use crate::row::Row;
use exact::Exact;
use files::pages;
use judge::{judge, unlike, useless};
use sweeps::sweeps;

/// The family that steps are of.
const FAMILY: &str = "ldm";

/// Layered depth maps, and who asks them.
pub struct Maps;

impl Extremes for Maps {
    type Shot = LdmShot;
    type Measured = Measured;
    type Table = Table;
    const ENDING: &'static str = "-ldm";

    fn sweeps() -> Vec<Sweep<LdmShot>> {
        sweeps()
    }

    /// Writes a step's scene to `folder/SWEEP/STEP`, and replays it through all legs. What a step is
    /// refused for is part of the result; [`Extremes::judge`] says whether it must be.
    fn run(
        sweep: &Sweep<LdmShot>,
        step: &Step<LdmShot>,
        folder: &Path,
        adapters: &[Adapter],
        options: &Options,
    ) -> Result<Measured, InputError> {
        let path = step.shot.write(&folder_of(folder, sweep, step))?;
        let entry = entry_of::<Maps>(FAMILY, sweep, step, path);
        let mut measured = Measured::new(sweep.name, step, &entry);
        let loaded = match load(&entry)? {
            Ok(loaded) => loaded,
            Err(words) => {
                measured.refused = Some(words);
                return Ok(measured);
            }
        };
        let of_step = |words: String| InputError::new(&entry.path, words);
        let spec = match LdmRun::new(&loaded, options.skip) {
            Ok(spec) => spec,
            Err(refusal) => {
                measured.refused = Some(refusal.to_string());
                return Ok(measured);
            }
        };
        measured.of(&spec);
        let exact = Exact::new(&loaded, &spec.setup.lattice);
        measured.parts = Parts::of(&spec, &exact, loaded.file.seed).map_err(of_step)?;
        measured.found = Found::of(&spec, &exact);
        measured.alone = Alone::of(&spec).map_err(of_step)?;
        measured.rows = replay(&entry, adapters, options)?.rows;
        Ok(measured)
    }

    fn judge(measured: &Measured, legs: &[String]) -> Vec<Wrong> {
        judge(measured, legs)
    }

    fn unlike(all: &[Measured]) -> Vec<Wrong> {
        unlike(all)
    }

    fn useless(all: &[Measured]) -> Vec<Wrong> {
        useless(all)
    }

    fn rows(measured: &Measured) -> (&Path, &[Row]) {
        (&measured.path, &measured.rows)
    }

    fn pages(run: &RunInfo, sweeps: &[Sweep<LdmShot>], all: &[Measured], wrong: &[Wrong]) -> Pages {
        pages(run, sweeps, all, wrong)
    }
}
