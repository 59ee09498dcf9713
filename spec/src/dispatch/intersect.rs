//! Stage `intersect`: what rays meet.

use super::ray::{Carried, Ray};
use crate::grid::ray::Ray as Way;
use crate::grid::trace::{blocked, closest};
use crate::grid::{Blockers, Grid};

/// Finds what rays meet, exactly: whichever way it looks for it, the answer is the same.
pub trait Tracer {
    /// Row of the nearest triangle; of several met at the same time the smallest.
    fn closest(&self, way: Way) -> Option<u32>;
    /// Whether anything is met.
    fn blocked(&self, way: Way) -> bool;
}

/// The spec's own tracer: a grid.
#[derive(Clone, Copy, Debug)]
pub struct Searched<'a> {
    /// Lists of triangles.
    pub grid: &'a Grid,
    /// The triangles.
    pub blockers: &'a Blockers,
}

impl Tracer for Searched<'_> {
    fn closest(&self, way: Way) -> Option<u32> {
        closest(self.grid, self.blockers, way).map(|met| met.prim)
    }
    fn blocked(&self, way: Way) -> bool {
        blocked(self.grid, self.blockers, way)
    }
}

/// What a ray met.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Met {
    /// Nothing. A ray that carries light has reached its lamp.
    Nothing,
    /// Something, which is all that is asked of a ray that carries light.
    Something,
    /// This triangle first.
    Triangle(u32),
}

/// Stage `intersect` (paper listing 2, `TraverseBVH` and `Intersect`): what a ray meets. Ends of a
/// segment belong to it, so a lamp within a triangle lights nothing.
pub fn intersect(tracer: &impl Tracer, ray: &Ray) -> Met {
    match ray.carried {
        Carried::Weight(_) => tracer.closest(ray.way).map_or(Met::Nothing, Met::Triangle),
        Carried::Light(_) if tracer.blocked(ray.way) => Met::Something,
        Carried::Light(_) => Met::Nothing,
    }
}
