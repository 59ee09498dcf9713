//! One pair of a ray and a triangle.

use triptych_spec::raster::Setup;
use triptych_spec::vertex::Primitives;

use super::edge::{flat_edges, is_edge};
use crate::embree::bound::{Promise, Triangle};
use crate::embree::scene::Depth;

/// What the spec and Embree make of a pair.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pair {
    /// Class edge: not judged.
    Edge {
        /// Whether both say the same.
        agree: bool,
    },
    /// Not in class edge, but beyond what Embree's arithmetic can resolve: not judged.
    Unresolved {
        /// Whether both say the same.
        agree: bool,
    },
    /// Covered and reported.
    Depth(DepthPair),
    /// Covered, but not reported.
    Missed,
    /// Reported, but not covered.
    Invented,
    /// Neither covered nor reported.
    Neither,
}

/// The depths of a pair that is covered and reported.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthPair {
    /// The spec's key.
    pub key: u32,
    /// Embree's t as a key.
    pub embree: f64,
    /// Largest distance that the bound allows.
    pub bound: f64,
}

impl DepthPair {
    /// Error over bound; not a number if Embree's t is none.
    pub fn ratio(&self) -> f64 {
        (self.embree - f64::from(self.key)).abs() / self.bound
    }

    /// Whether the depth is outside the bound.
    pub fn is_outside(&self) -> bool {
        let ratio = self.ratio();
        ratio > 1.0 || ratio.is_nan()
    }
}

/// A triangle as pairs need it; `setup` is `None` without area.
pub(super) struct Side<'a> {
    pub spec: &'a Primitives,
    pub prim: u32,
    pub setup: Option<&'a Setup>,
    pub triangle: &'a Triangle,
}

impl Side<'_> {
    /// The pair of this triangle and the ray through a point; `hit` is Embree's t. The
    /// class is decided before what Embree says is looked at.
    pub(super) fn pair(&self, depth: &Depth, point: [i64; 2], hit: Option<f32>) -> Pair {
        let flat = || flat_edges(self.spec, self.prim, point);
        let edges = self.setup.map_or_else(flat, |s| s.edges(point));
        let covered = self.setup.is_some_and(|s| s.covers(edges));
        let agree = covered == hit.is_some();
        if is_edge(edges) {
            return Pair::Edge { agree };
        }
        let promise = self.triangle.promise(point);
        if promise == Promise::Unresolved {
            return Pair::Unresolved { agree };
        }
        // What is expected is the spec's word; the promise only says that Embree
        // is able to give it, and how precise its depth is.
        match (self.setup, promise, hit) {
            (Some(setup), Promise::Hit { bound }, Some(t)) if covered => Pair::Depth(DepthPair {
                key: setup.key(edges),
                embree: depth.key(t),
                // The key is the floor of the exact depth: one key more on that side.
                bound: bound + 1.0,
            }),
            (_, _, None) if covered => Pair::Missed,
            (_, _, Some(_)) => Pair::Invented,
            (_, _, None) => Pair::Neither,
        }
    }
}

/// The pair of any triangle and the ray through a point.
pub fn pair(
    spec: &Primitives,
    depth: &Depth,
    prim: u32,
    point: [i64; 2],
    hit: Option<f32>,
) -> Pair {
    let setup = Setup::new(spec, prim);
    let side = Side {
        spec,
        prim,
        setup: setup.as_ref(),
        triangle: &Triangle::new(spec, depth, prim),
    };
    side.pair(depth, point, hit)
}
