//! Whether a rounded coordinate can come from a number within a bound.
//!
//! Rounding is monotonic, so an observed integer is conforming if and only if the
//! numbers that round to it come within the bound of the spec's number. Their
//! distance to it is the error that the observation proves. The numbers that give
//! the integer `k`:
//!
//! - x, y: `[k - 1/2, k + 1/2]`. The guard's ends take all that lies beyond, because
//!   clamping follows. Rounding in `f32` is exact.
//! - z, on the spec's scale of `D = 2^31 - 1`: `[k D / 2^31, k + 1)`. Truncation
//!   accounts for `[k, k + 1)`; and where the spec multiplies by D, a kernel
//!   multiplies by `f32(D) = 2^31`, so that its number is larger by the factor
//!   `2^31 / D`. Saturation gives 0 everything below 1, and D everything above.

use triptych_spec::bound::Bounded;
use triptych_spec::scene::Size;
use triptych_spec::vertex::{DEPTH_ONE, GUARD, Position, grid_position, guard_origin};

use super::rule::{Outside, Rule};
use super::{Figures, SLACK};

/// Holds snapped polygons of one target against their bounds.
pub struct Judge {
    bits: u32,
    /// The integers that an axis may have.
    ranges: [[i32; 2]; 3],
}

impl Rule for Judge {
    type Corner = [i32; 3];

    fn corner(&self, position: Position<Bounded>, observed: [i32; 3]) -> Result<Figures, Outside> {
        let mut figures = Figures::default();
        let grid = grid_position(position, self.bits);
        for (axis, (number, observed)) in grid.into_iter().zip(observed).enumerate() {
            let outside = Outside {
                axis,
                expected: number,
                observed: f64::from(observed),
            };
            // An integer that the axis does not have is wrong whatever the bound.
            let [low, high] = self.ranges[axis];
            if !(low..=high).contains(&observed) {
                return Err(outside);
            }
            if axis < 2 && observed != self.rounded(axis, number.value) {
                figures.moved = 1;
            }
            let admits = |k| self.error(axis, number.value, k) <= number.bound * SLACK;
            if admits(low) && admits(high) {
                figures.unbounded = 1;
                continue;
            }
            if !admits(observed) {
                return Err(outside);
            }
            let error = self.error(axis, number.value, observed);
            figures.error_over_bound = figures.error_over_bound.max(error / number.bound);
            if axis == 2 {
                figures.error_keys = figures.error_keys.max(error);
                figures.error = figures.error_keys;
            } else {
                figures.error_subpixels = figures.error_subpixels.max(error);
                figures.bound_subpixels = figures.bound_subpixels.max(number.bound);
            }
        }
        Ok(figures)
    }
}

impl Judge {
    /// For a target with so many sub-pixel bits.
    pub fn new(size: Size, bits: u32) -> Self {
        let guard = |side| {
            let first = guard_origin(side);
            [first << bits, (first + GUARD) << bits]
        };
        Self {
            bits,
            ranges: [guard(size.width), guard(size.height), [0, DEPTH_ONE]],
        }
    }

    /// How far the nearest number that rounds to `observed`, one of the axis's
    /// integers, is from `value`; infinite if `value` is not finite.
    fn error(&self, axis: usize, value: f64, observed: i32) -> f64 {
        let [low, high] = self.ranges[axis];
        let k = f64::from(observed);
        let (least, most) = match axis {
            2 => (k * (f64::from(DEPTH_ONE) / 2_f64.powi(31)), k + 1.0),
            _ => (k - 0.5, k + 0.5),
        };
        let least = if observed > low {
            least
        } else {
            f64::NEG_INFINITY
        };
        let most = if observed < high { most } else { f64::INFINITY };
        match value.is_finite() {
            true => (least - value).max(value - most).max(0.0),
            false => f64::INFINITY,
        }
    }

    /// What the spec's `snap` makes of x or y.
    fn rounded(&self, axis: usize, value: f64) -> i32 {
        let [low, high] = self.ranges[axis];
        #[expect(clippy::cast_possible_truncation, reason = "a whole number in range")]
        let rounded = value
            .round_ties_even()
            .clamp(f64::from(low), f64::from(high)) as i32;
        rounded
    }
}
