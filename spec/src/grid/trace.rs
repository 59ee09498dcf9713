//! Stage `trace`: what a ray meets.

use super::exact::Time;
use super::hit::crossing;
use super::ray::Ray;
use super::walk::Walk;
use super::{Blockers, Grid};

/// What a ray meets first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Closest {
    /// Row in [`Blockers::triangles`]; the smallest of those met at the same time.
    pub prim: u32,
    /// When.
    pub time: Time,
}

/// What is asked of a ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Query {
    /// Whether anything is met.
    Any,
    /// What is met first.
    Closest,
}

/// Stage `trace`: the answer to each ray. With [`Query::Any`] it is the nearest triangle as
/// well, though any that the ray meets would do.
pub fn trace(grid: &Grid, blockers: &Blockers, rays: &[Ray]) -> Vec<Option<Closest>> {
    let answer = |ray: &Ray| closest(grid, blockers, *ray);
    rays.iter().map(answer).collect()
}

/// Whether anything blocks the ray (any hit). The first blocker that is found ends the
/// search (Yang et al. 2010, section 4.2: "the ray is preempted").
pub fn blocked(grid: &Grid, blockers: &Blockers, ray: Ray) -> bool {
    Walk::new(grid, ray).any(|passed| {
        let mut list = grid.list(passed.cell).iter();
        list.any(|prim| crossing(&ray, blockers.corners(*prim)).is_some())
    })
}

/// The nearest triangle that the ray meets.
///
/// A cell lists triangles that are met in later cells, so the search ends only with the
/// cell that is left after the nearest hit so far.
pub fn closest(grid: &Grid, blockers: &Blockers, ray: Ray) -> Option<Closest> {
    let mut nearest: Option<Closest> = None;
    for passed in Walk::new(grid, ray) {
        for &prim in grid.list(passed.cell) {
            let Some(time) = crossing(&ray, blockers.corners(prim)) else {
                continue;
            };
            if nearest.is_none_or(|n| (time, prim) < (n.time, n.prim)) {
                nearest = Some(Closest { prim, time });
            }
        }
        if nearest.is_some_and(|n| n.time < passed.exit) {
            break;
        }
    }
    nearest
}
