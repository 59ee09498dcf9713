//! Corners against their bounds, whatever a stage makes of them.

use triptych_spec::bound::Bounded;
use triptych_spec::vertex::Position;

use super::{Figures, Kind};

/// How a stage's corners are held against their bounds.
pub trait Rule {
    /// A corner as the device gives it.
    type Corner: Copy;

    /// How far a corner is off.
    ///
    /// # Errors
    /// The first coordinate that is outside.
    fn corner(
        &self,
        expected: Position<Bounded>,
        observed: Self::Corner,
    ) -> Result<Figures, Outside>;

    /// Whether an observed polygon conforms to an outcome.
    ///
    /// # Errors
    /// The first difference.
    fn polygon(
        &self,
        expected: &[Position<Bounded>],
        observed: &[Self::Corner],
    ) -> Result<Figures, Kind> {
        if expected.len() != observed.len() {
            return Err(Kind::Count {
                expected: expected.len(),
                observed: observed.len(),
            });
        }
        let mut figures = Figures::default();
        for (corner, (position, observed)) in expected.iter().zip(observed).enumerate() {
            let judged = self.corner(*position, *observed);
            figures.merge(&judged.map_err(|outside| Kind::Corner {
                corner,
                axis: outside.axis,
                value: outside.expected.value,
                bound: outside.expected.bound,
                observed: outside.observed,
            })?);
        }
        Ok(figures)
    }

    /// The number of corners outside, of polygons with equally many.
    fn outside(&self, expected: &[Position<Bounded>], observed: &[Self::Corner]) -> usize {
        let pairs = expected.iter().zip(observed);
        pairs
            .filter(|(e, o)| self.corner(**e, **o).is_err())
            .count()
    }
}

/// A coordinate outside its bound.
pub struct Outside {
    /// 0 to 3 for x, y, z, w.
    pub axis: usize,
    /// What it should be.
    pub expected: Bounded,
    /// What it is.
    pub observed: f64,
}
