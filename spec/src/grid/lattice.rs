//! The lattice: integer coordinates in which blockers and rays are the same for every leg.
//!
//! As triangles are snapped to sub-pixels before they are covered, blockers and rays are
//! snapped once before any cell or ray sees them. A coordinate is an integer of at most
//! [`REACH`] = 2^23 in size, so the difference of two is at most 2^24, which `f32` holds
//! exactly: kernels subtract, and never round when they do. The exact predicates stay
//! small too: a triple product of such differences is below 6 * 2^72 (`exact`).

use thiserror::Error;

/// Largest coordinate that a ray's ends may have.
pub const REACH: i32 = 1 << 23;

/// Largest coordinate of a blocker. The rest of [`REACH`] is for the outermost cell
/// boundaries, which lie beyond the widened blockers.
pub const EXTENT: i32 = REACH - 64;

/// A point of the lattice, or the difference of two.
pub type Point = [i32; 3];

/// Why there is no lattice.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum LatticeError {
    /// A coordinate that is NaN or infinite.
    #[error("{0} is not finite")]
    NotFinite(f64),
    /// Nothing to lay a lattice around.
    #[error("there are no points")]
    Empty,
}

/// Maps world space to the lattice: moved to a centre, scaled by a power of two.
///
/// Half a step, at most 2^-23 of the longest side of what the lattice was laid around, is
/// what [`Lattice::snap`] moves a coordinate. Powers of two keep scenes of any size alike:
/// a scene times 2^k has the same lattice points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lattice {
    /// The point of the world that becomes 0.
    pub centre: [f64; 3],
    /// A step is `2^exponent` units of the world.
    pub exponent: i32,
}

impl Lattice {
    /// The finest lattice on which every point is within [`EXTENT`].
    ///
    /// # Errors
    /// No points, or one that is not finite.
    pub fn around(points: impl IntoIterator<Item = [f64; 3]>) -> Result<Self, LatticeError> {
        let mut low = [f64::INFINITY; 3];
        let mut high = [f64::NEG_INFINITY; 3];
        for point in points {
            for axis in 0..3 {
                if !point[axis].is_finite() {
                    return Err(LatticeError::NotFinite(point[axis]));
                }
                low[axis] = low[axis].min(point[axis]);
                high[axis] = high[axis].max(point[axis]);
            }
        }
        if low[0] > high[0] {
            return Err(LatticeError::Empty);
        }
        // Halved first, so that no sum overflows.
        let centre = [0, 1, 2].map(|axis| low[axis] / 2.0 + high[axis] / 2.0);
        let half = (0..3)
            .map(|axis| (high[axis] / 2.0 - low[axis] / 2.0).abs())
            .fold(0.0, f64::max);
        Ok(Self {
            centre,
            exponent: exponent(half),
        })
    }

    /// The nearest lattice point; halves go up. `None` beyond [`REACH`], and for what is
    /// not finite.
    pub fn snap(&self, point: [f64; 3]) -> Option<Point> {
        let mut snapped = [0; 3];
        for axis in 0..3 {
            let steps = libm::scalbn(point[axis] - self.centre[axis], -self.exponent);
            let nearest = libm::floor(steps + 0.5);
            // NaN is within nothing.
            let within = nearest.abs() <= f64::from(REACH);
            if !within {
                return None;
            }
            #[expect(clippy::cast_possible_truncation, reason = "within REACH")]
            let integer = nearest as i32;
            snapped[axis] = integer;
        }
        Some(snapped)
    }

    /// Where a lattice point lies in the world.
    pub fn world(&self, point: Point) -> [f64; 3] {
        [0, 1, 2].map(|axis| {
            let offset = libm::scalbn(f64::from(point[axis]), self.exponent);
            self.centre[axis] + offset
        })
    }
}

/// The least exponent for which `half` is at most [`EXTENT`] steps, with one to spare for
/// the rounding of the centre. Points in one place get steps of a unit in the 24th bit of
/// 1, as good as any.
fn exponent(half: f64) -> i32 {
    if half == 0.0 {
        return -23;
    }
    let (_, binary) = libm::frexp(half);
    // half < 2^binary, so the first of the two leaves at most 2^23 steps.
    let fits = |exponent: i32| libm::scalbn(half, -exponent) <= f64::from(EXTENT - 1);
    match fits(binary - 23) {
        true => binary - 23,
        false => binary - 22,
    }
}
