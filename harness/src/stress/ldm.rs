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
pub use files::write;
pub use found::Found;
pub use judge::{judge, unlike, useless};
pub use measure::{Bound, Measured};
pub use parts::{Error, Parts};
pub use shot::{Form, LdmShot};
pub use sweeps::sweeps;
pub use table::{Table, line};

use std::path::Path;

use super::sweeps::{Step, Sweep};
use crate::corpus::Entry;
use crate::error::InputError;
use crate::replay::gpu::Adapter;
use crate::replay::ldm::LdmRun;
use crate::replay::{Options, replay};
use crate::scene::{LoadError, load_entry};
use exact::Exact;

/// The family that steps are of.
const FAMILY: &str = "ldm";

/// Writes a step's scene to `folder/SWEEP/STEP`, and replays it through all legs. What a step is
/// refused for is part of the result; [`judge`] says whether it must be.
///
/// # Errors
/// A folder that cannot be written, a scene that cannot be read back, what Embree reports.
pub fn run(
    sweep: &Sweep<LdmShot>,
    step: &Step<LdmShot>,
    folder: &Path,
    adapters: &[Adapter],
    options: &Options,
) -> Result<Measured, InputError> {
    let folder = folder.join(sweep.name).join(&step.label);
    let path = step.shot.write(&folder)?;
    let entry = Entry {
        name: format!("stress-ldm/{}/{}", sweep.name, step.label),
        family: FAMILY.to_owned(),
        path,
    };
    let mut measured = Measured::new(sweep.name, step, &entry);
    let loaded = match load_entry(&entry, None) {
        Ok(loaded) => loaded,
        Err(LoadError::Input(error)) => {
            measured.refused = Some(error.message);
            return Ok(measured);
        }
        Err(missing @ LoadError::Missing { .. }) => {
            return Err(InputError::new(&entry.path, missing.to_string()));
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
