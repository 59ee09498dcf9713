//! Rays of the ray tracer: where they go, and for whom.

use crate::grid::ray::Ray as Way;

/// Bits of a weight behind the point.
pub const WEIGHT_BITS: u32 = 15;

/// The weight of a primary ray: 1.
pub const WEIGHT_ONE: u32 = 1 << WEIGHT_BITS;

/// What part of the light along a ray its pixel gets, for each colour, in units of 2^-15; at
/// most [`WEIGHT_ONE`]. The product of the mirrors on the way (paper section 3: "a weight factor
/// that is equal to the product of the cosines and BRDFs"; a perfect mirror has no cosine).
pub type Weight = [u32; 3];

/// The weight of a ray that a mirror sends on, each colour rounded to the nearest unit, halves
/// up. Products are at most 2^30.
pub fn weighted(weight: Weight, mirror: Weight) -> Weight {
    let half = WEIGHT_ONE / 2;
    [0, 1, 2].map(|i| (weight[i] * mirror[i] + half) >> WEIGHT_BITS)
}

/// What a ray is for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Carried {
    /// It asks for the nearest surface, whose light its pixel gets with a weight.
    Weight(Weight),
    /// It ends at a lamp, whose light its pixel gets if nothing is in between.
    Light([f32; 3]),
}

/// A ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where it goes: a segment if it carries light.
    pub way: Way,
    /// Number of the pixel to which it contributes, row by row.
    pub pixel: u32,
    /// Mirrors on the way to where it starts.
    pub depth: u32,
    /// What it is for.
    pub carried: Carried,
}
