//! One pair of a ray and a triangle.

use triptych_spec::vertex::Primitives;

use super::pairs::{Class, Expected, Pairs};
use super::screen::Screen;
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
    /// How far the two are apart, in keys.
    pub fn error(&self) -> f64 {
        (self.embree - f64::from(self.key)).abs()
    }

    /// Error over bound; not a number if Embree's t is none.
    pub fn ratio(&self) -> f64 {
        self.error() / self.bound
    }

    /// Whether the depth is outside the bound.
    pub fn is_outside(&self) -> bool {
        let ratio = self.ratio();
        ratio > 1.0 || ratio.is_nan()
    }
}

impl Expected {
    /// The pair of what must come of it and what Embree says: its t, if it reports the
    /// triangle, which `key` makes a depth key.
    pub(super) fn with(self, hit: Option<f32>, key: impl Fn(f32) -> f64) -> Pair {
        let Self { covered, class } = self;
        let agree = covered == hit.is_some();
        let depth = match class {
            Class::Edge => return Pair::Edge { agree },
            Class::Unresolved => return Pair::Unresolved { agree },
            Class::Judged { depth } => depth,
        };
        // What is expected is the spec's word; the class only says that Embree
        // is able to give it, and how precise its depth is.
        match (depth, hit) {
            (Some((exact, bound)), Some(t)) => Pair::Depth(DepthPair {
                key: exact,
                embree: key(t),
                bound,
            }),
            (_, None) if covered => Pair::Missed,
            (None, Some(_)) => Pair::Invented,
            (_, None) => Pair::Neither,
        }
    }
}

/// The pair of any triangle and the ray through a pixel's sample, in screen space.
pub fn pair(
    spec: &Primitives,
    depth: &Depth,
    prim: u32,
    pixel: [u32; 2],
    hit: Option<f32>,
) -> Pair {
    let screen = Screen {
        spec,
        depth: *depth,
    };
    let expected = screen.expect(&screen.candidate(prim), &(), pixel);
    expected.with(hit, |t| screen.key(t))
}
