//! Several measurements of one thing.

use serde::{Deserialize, Serialize};

/// Median, smallest and largest.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Spread {
    /// The middle one; of an even number the mean of the two.
    pub median: f64,
    /// The smallest.
    pub min: f64,
    /// The largest.
    pub max: f64,
}

impl Spread {
    /// Of at least one measurement; of none, all are zero.
    pub fn of(measured: impl IntoIterator<Item = f64>) -> Self {
        let mut all: Vec<f64> = measured.into_iter().collect();
        all.sort_by(f64::total_cmp);
        let (Some(min), Some(max)) = (all.first(), all.last()) else {
            return Self {
                median: 0.0,
                min: 0.0,
                max: 0.0,
            };
        };
        let middle = all.len() / 2;
        let lower = all[middle - usize::from(all.len().is_multiple_of(2))];
        Self {
            median: f64::midpoint(lower, all[middle]),
            min: *min,
            max: *max,
        }
    }

    /// Whether the largest is more than twice the smallest: something else than what was
    /// measured decides then, such as a clock that rises.
    pub fn varies(self) -> bool {
        self.max > 2.0 * self.min
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_is_in_the_middle() {
        let of = |all: &[f64]| Spread::of(all.iter().copied());
        let spread = |median, min, max| Spread { median, min, max };
        assert_eq!(of(&[9.0, 1.0, 2.0]), spread(2.0, 1.0, 9.0), "odd");
        assert_eq!(of(&[4.0, 1.0, 9.0, 2.0]), spread(3.0, 1.0, 9.0), "even");
        assert_eq!(of(&[7.0]), spread(7.0, 7.0, 7.0), "one");
    }
}
