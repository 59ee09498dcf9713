//! The spec's side: blockers, their grid, rays and answers.

use std::time::Duration;

use triptych_spec::grid::lattice::{Lattice, LatticeError};
use triptych_spec::grid::ray::Ray;
use triptych_spec::grid::trace::{Closest, trace};
use triptych_spec::grid::{Blockers, Grid, GridError, Membership};

use crate::compare::grid::Runs;
use crate::dispatch::share;
use crate::rays::{Kind, draw};
use crate::replay::pieces::{self, Built};
use crate::replay::spec::timed;
use crate::replay::work::{self, Meter, WORK_MAX};
use crate::scene::{Loaded, Mistake};

/// Rays of a piece of work: few, as one that passes long lists takes milliseconds.
const RAYS: usize = 32;

/// How much of the lattice is left around the blockers, for rays that start there: an eighth
/// of their box on each side.
const AROUND: f64 = 1.25;

/// Everything that the spec says about a scene's grid.
pub struct GridRun {
    /// World space and the lattice.
    pub lattice: Lattice,
    /// The scene's triangles; rows are those of the scene.
    pub blockers: Blockers,
    /// Which cells list a triangle.
    pub membership: Membership,
    /// After `count`.
    pub counts: Vec<u32>,
    /// After `scan` and `fill`.
    pub grid: Grid,
    /// The same with every cell that a box touches, where `grid` lists fewer.
    pub boxes: Option<Grid>,
    /// The rays, kind after kind.
    pub rays: Vec<Ray>,
    /// Where each kind ends.
    pub ends: [usize; Kind::ALL.len()],
    /// What each ray meets first.
    pub answers: Vec<Option<Closest>>,
    /// Time of each stage.
    pub times: Times,
}

/// Time of each stage.
#[derive(Clone, Copy, Debug, Default)]
pub struct Times {
    /// Stage count.
    pub count: Duration,
    /// Stage scan.
    pub scan: Duration,
    /// Stage fill.
    pub fill: Duration,
    /// Stage trace.
    pub trace: Duration,
}

impl GridRun {
    /// Runs all stages.
    ///
    /// # Errors
    /// One line for a scene beyond the limits of grids.
    pub fn new(loaded: &Loaded) -> Result<Self, Mistake> {
        let section = loaded.file.grid.unwrap_or_default();
        let (lattice, blockers) = blockers(loaded)?;
        let membership = section.membership();
        let limit = |e: GridError| Mistake::of("grid.resolution", e.to_string());
        let built = |membership| pieces::build(&blockers, section.resolution(), membership);
        let Built {
            counts,
            grid,
            times: [count, scan, fill],
        } = built(membership).map_err(limit)?;
        let boxes = match membership {
            Membership::Box => None,
            Membership::Overlap => Some(built(Membership::Box).map_err(limit)?.grid),
        };
        let (rays, ends) = draw(&blockers, &grid, loaded.file.seed, &section.rays);
        within(&grid, &rays)?;
        let (answers, trace) = timed(|| traced(&grid, &blockers, &rays));
        Ok(Self {
            lattice,
            blockers,
            membership,
            counts,
            grid,
            boxes,
            rays,
            ends,
            answers,
            times: Times {
                count,
                scan,
                fill,
                trace,
            },
        })
    }

    /// Adds rays that a scene file cannot draw, after those of all kinds.
    #[must_use]
    pub fn asking(mut self, own: Vec<Ray>) -> Self {
        let (answers, time) = timed(|| traced(&self.grid, &self.blockers, &own));
        self.times.trace += time;
        self.rays.extend(own);
        self.answers.extend(answers);
        self
    }

    /// The lists.
    pub fn runs(&self) -> Runs<'_> {
        runs(&self.grid)
    }

    /// The lists by boxes.
    pub fn box_runs(&self) -> Runs<'_> {
        runs(self.boxes.as_ref().unwrap_or(&self.grid))
    }

    /// Entries of all lists.
    pub fn entries(&self) -> u32 {
        u32::try_from(self.grid.prims.len()).expect("at most ENTRIES_MAX")
    }
}

fn runs(grid: &Grid) -> Runs<'_> {
    Runs {
        offsets: &grid.offsets,
        prims: &grid.prims,
    }
}

/// Stage trace, rays in runs.
fn traced(grid: &Grid, blockers: &Blockers, rays: &[Ray]) -> Vec<Option<Closest>> {
    share::runs(rays.len(), RAYS, |run| trace(grid, blockers, &rays[run]))
}

/// Refuses rays that would take too long.
fn within(grid: &Grid, rays: &[Ray]) -> Result<(), Mistake> {
    let asked = rays.len() as u64;
    // Where no rays could, those of this scene need not be counted.
    if asked.saturating_mul(work::most(grid).total()) <= WORK_MAX {
        return Ok(());
    }
    let meter = Meter::new(WORK_MAX);
    let takes = |ray: &Ray| meter.takes(work::of(grid, *ray).total());
    match share::all(rays.len(), RAYS, |at| takes(&rays[at])) {
        true => Ok(()),
        false => Err(Mistake::of(
            "grid.rays",
            format!(
                "{asked} rays pass more than {WORK_MAX} cells and triangles in their lists, the \
                 limit; ask for fewer rays, or for cells that list fewer triangles"
            ),
        )),
    }
}

/// A scene's triangles on the finest lattice that holds them and rays around them.
///
/// # Errors
/// A coordinate that is not finite, in one line.
pub fn blockers(loaded: &Loaded) -> Result<(Lattice, Blockers), String> {
    let points = loaded.world.points(&loaded.scene);
    let triangles: Vec<[u32; 3]> = loaded.scene.triangles.iter().map(|t| t.vertices).collect();
    let used = || triangles.iter().flatten().map(|v| points[*v as usize]);
    let tight = match Lattice::around(used()) {
        Ok(lattice) => lattice,
        Err(LatticeError::Empty) => {
            let nowhere = Lattice {
                centre: [0.0; 3],
                exponent: 0,
            };
            return Ok((nowhere, Blockers::default()));
        }
        Err(error) => return Err(error.to_string()),
    };
    let wider = |p: [f64; 3]| {
        let offset = |axis: usize| (p[axis] - tight.centre[axis]) * AROUND;
        [0, 1, 2].map(|axis| tight.centre[axis] + offset(axis))
    };
    let lattice = Lattice::around(used().map(wider)).map_err(|e| e.to_string())?;
    // A vertex that no triangle uses may lie anywhere.
    let snap = |p: &[f64; 3]| lattice.snap(*p).unwrap_or_default();
    let blockers = Blockers {
        vertices: points.iter().map(snap).collect(),
        triangles,
    };
    Ok((lattice, blockers))
}
