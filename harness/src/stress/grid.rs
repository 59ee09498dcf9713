//! Stability of grids and rays: geometry on cells' faces, extreme sizes and offsets, rays
//! that start or pass ever nearer to what they must not confuse.
//!
//! A step is a scene with a `[grid]`, as any scene file is, and rays of its own where a
//! file's kinds do not come near enough. Every leg answers them: the spec by way of its
//! grid, held against every triangle without one; every adapter, stage by stage and end to
//! end; Embree. Beside that: how many cells a walk passes, of the most that it may
//! ([`step_bound`](triptych_spec::grid::walk::step_bound)), and what skipping saves.

mod files;
mod judge;
mod measure;
mod near;
mod shot;
mod sweeps;
mod table;
#[cfg(test)]
mod tests;
mod walks;

pub use measure::{Bound, Measured, Saved};
pub use shot::{GridShot, Own};
pub use table::Table;
pub use walks::Walks;

use std::path::Path;
use std::time::Instant;

use super::extremes::{Extremes, Pages, entry_of, folder_of, load};
use super::judge::Wrong;
use super::sweeps::{Step, Sweep};
use crate::compare::compare;
use crate::compare::grid::{Asked, exhaustive, nearest_of_each};
use crate::error::InputError;
use crate::observe::{Exhaustive, Observed, Spec};
use crate::replay::gpu::Adapter;
use crate::replay::grid::GridRun;
use crate::replay::rows::Rows;
use crate::replay::{Options, replay_grid};
use crate::report::RunInfo;
use crate::row::Row;
use crate::scene::Loaded;
use files::pages;
use judge::{judge, useless};
use sweeps::sweeps;

/// The family that steps are of.
const FAMILY: &str = "grid";

/// What the spec is held against.
pub const EVERY: &str = "every triangle";

/// The spec's side, with the step's own rays.
fn spec_of(loaded: &Loaded, shot: &GridShot) -> Result<GridRun, String> {
    let spec = GridRun::new(loaded)?;
    let own = shot.own.rays(&spec.grid, &spec.blockers);
    Ok(spec.asking(own))
}

/// Every leg's rows, the spec's own first.
fn rows(
    loaded: &Loaded,
    shot: &GridShot,
    adapters: &[Adapter],
    options: &Options,
) -> Result<Vec<Row>, String> {
    let spec = spec_of(loaded, shot)?;
    let mut rows = Rows::new(&loaded.name, &loaded.family);
    hold(&spec, &mut rows);
    let mut rows = rows.rows;
    rows.extend(replay_grid(loaded, spec, adapters, options)?);
    Ok(rows)
}

/// The spec's answers against those of every triangle.
fn hold(run: &GridRun, rows: &mut Rows) {
    let start = Instant::now();
    let nearest = nearest_of_each(&run.blockers, &run.rays);
    let every = Observed::<Exhaustive, _>::new(EVERY, nearest).taking(start.elapsed());
    let spec = Observed::<Spec, _>::new("spec", run).taking(run.times.trace);
    let judgement = compare(&spec, &every, |run, nearest| {
        let asked = Asked {
            blockers: &run.blockers,
            rays: &run.rays,
            answers: &run.answers,
        };
        exhaustive(asked, nearest)
    });
    rows.add("trace", &spec, &every, judgement);
}

/// Grids, and rays through them.
pub struct Rays;

impl Extremes for Rays {
    type Shot = GridShot;
    type Measured = Measured;
    type Table = Table;
    const ENDING: &'static str = "-grid";

    fn sweeps() -> Vec<Sweep<GridShot>> {
        sweeps()
    }

    fn more_legs() -> Vec<String> {
        vec![EVERY.to_owned()]
    }

    /// Writes a step's scene to `folder/SWEEP/STEP`, and asks its rays of all legs. What a step
    /// is refused for is part of the result; [`Extremes::judge`] says whether it must be.
    fn run(
        sweep: &Sweep<GridShot>,
        step: &Step<GridShot>,
        folder: &Path,
        adapters: &[Adapter],
        options: &Options,
    ) -> Result<Measured, InputError> {
        let path = step.shot.write(&folder_of(folder, sweep, step))?;
        let entry = entry_of::<Rays>(FAMILY, sweep, step, path);
        let mut measured = Measured::new(sweep.name, step, &entry);
        let loaded = match load(&entry)? {
            Ok(loaded) => loaded,
            Err(words) => {
                measured.refused = Some(words);
                return Ok(measured);
            }
        };
        let of_step = |words: String| InputError::new(&entry.path, words);
        match spec_of(&loaded, &step.shot) {
            Ok(spec) => measured.of(&spec),
            Err(refusal) => {
                measured.refused = Some(refusal);
                return Ok(measured);
            }
        }
        measured.rows = rows(&loaded, &step.shot, adapters, options).map_err(of_step)?;
        if loaded.scene.triangles.is_empty() {
            measured.skipped = std::mem::take(&mut measured.rows);
            let all = Options {
                skip: false,
                ..options.clone()
            };
            measured.rows = rows(&loaded, &step.shot, adapters, &all).map_err(of_step)?;
        }
        Ok(measured)
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

    fn pages(
        run: &RunInfo,
        sweeps: &[Sweep<GridShot>],
        all: &[Measured],
        wrong: &[Wrong],
    ) -> Pages {
        pages(run, sweeps, all, wrong)
    }
}
