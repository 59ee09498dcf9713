//! Point lights.

use super::DispatchError;
use super::world::{light, within};
use crate::grid::lattice::{Point, REACH};
use crate::rsm::sound;

/// Most light that a lamp may give a surface, so that a picture's sums stay below
/// `64 * 65 * 2^20 * 2^24 < 2^57` units.
pub const LIGHT_MAX: f64 = (1_u32 << 20) as f64;

/// Longest distance of two points of the lattice in each coordinate.
const LENGTH_MAX: u64 = 1 << 24;

/// A point light, which shines in all directions alike.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lamp {
    /// Where it is.
    pub position: Point,
    /// Linear irradiance of a surface at right angles to its light, at the reference distance.
    pub strength: [f32; 3],
    /// The reference distance in lattice steps, 1 to 2^24.
    pub reference: u32,
    /// Shorter distances are taken for this one, in lattice steps, 1 to 2^24, or a lamp would
    /// be infinitely bright.
    pub least: u32,
}

impl Lamp {
    /// Checks a lamp.
    ///
    /// # Errors
    /// A place beyond the lattice, a strength that is negative or not finite, distances beyond
    /// their limits, or more light at the least distance than [`LIGHT_MAX`].
    pub fn new(
        position: Point,
        strength: [f32; 3],
        reference: u32,
        least: u32,
    ) -> Result<Self, DispatchError> {
        if !position.iter().all(|c| (-REACH..=REACH).contains(c)) {
            return Err(DispatchError::TooFar("a lamp"));
        }
        sound(strength).map_err(light)?;
        within("the reference distance", reference.into(), 1, LENGTH_MAX)?;
        within("the least distance", least.into(), 1, LENGTH_MAX)?;
        let lamp = Self {
            position,
            strength,
            reference,
            least,
        };
        let light = lamp.brightest();
        match light <= LIGHT_MAX {
            true => Ok(lamp),
            false => Err(DispatchError::Bright(light)),
        }
    }

    /// Its light at the least distance.
    pub fn brightest(&self) -> f64 {
        let nearer = f64::from(self.reference) / f64::from(self.least);
        largest(self.strength) * nearer * nearer
    }
}

/// The largest of three numbers, none of which is negative.
pub(super) fn largest(colour: [f32; 3]) -> f64 {
    colour.iter().fold(0.0, |m: f64, c| m.max(f64::from(*c)))
}
