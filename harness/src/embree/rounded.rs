//! Running error bounds of `f32` arithmetic that rounds to nearest, as Embree's does.

/// Relative error of one operation rounded to nearest.
pub const U: f64 = f32::EPSILON as f64 / 2.0;

/// Error of Embree's `rcp(a) * b` relative to the quotient. The approximation that it
/// starts from is off by at most 1.5 * 2^-12; the Newton step `r + r (1 - a r)`
/// squares that to 2.25 U and adds U for `a r` and U for the sum (its other
/// roundings are of second order); the product adds U.
pub const RECIPROCAL: f64 = 5.25 * U;

/// Room for products of two errors, of which one at least is that of an `f32` operation or
/// of the approximate reciprocal: they are at most 2^-11 of what is kept. The rounding of
/// `f64` is far below that.
pub const SECOND_ORDER: f64 = 1.0 + 1.0 / 1024.0;

/// What flushing a subnormal changes at most.
const TINY: f64 = f32::MIN_POSITIVE as f64;

/// A number, up to `f64`, and the largest error of its evaluation in `f32`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rounded {
    /// The number.
    pub value: f64,
    /// Largest distance of what `f32` arithmetic makes of it.
    pub error: f64,
}

impl Rounded {
    /// A number that is handed on as an `f32`.
    pub fn once(value: f64) -> Self {
        #[expect(clippy::cast_possible_truncation, reason = "the rounding in question")]
        let single = f64::from(value as f32);
        Self {
            value,
            error: (single - value).abs(),
        }
    }

    /// The result of an operation whose operands' errors amount to `propagated`.
    fn of(value: f64, propagated: f64) -> Self {
        Self {
            value,
            error: propagated + U * (value.abs() + propagated) + TINY,
        }
    }

    /// Sum.
    pub fn plus(self, other: Self) -> Self {
        Self::of(self.value + other.value, self.error + other.error)
    }

    /// Difference.
    pub fn minus(self, other: Self) -> Self {
        Self::of(self.value - other.value, self.error + other.error)
    }

    /// Product.
    pub fn times(self, other: Self) -> Self {
        let propagated = self.value.abs() * other.error
            + other.value.abs() * self.error
            + self.error * other.error;
        Self::of(self.value * other.value, propagated)
    }

    /// Either of two ways to one number.
    pub fn or(self, other: Self) -> Self {
        Self {
            error: self.error.max(other.error),
            ..self
        }
    }
}

/// Three of them.
pub type Vector = [Rounded; 3];

/// Vector product.
pub fn cross(a: Vector, b: Vector) -> Vector {
    let term = |i: usize, j: usize| a[i].times(b[j]).minus(a[j].times(b[i]));
    [term(1, 2), term(2, 0), term(0, 1)]
}

/// Scalar product; sums may come in any order.
pub fn dot(a: Vector, b: Vector) -> Rounded {
    let terms = [0, 1, 2].map(|i| a[i].times(b[i]));
    let sum = terms[0].plus(terms[1]).plus(terms[2]);
    // Another order rounds another partial sum, which is at most that of the terms' sizes.
    let sizes: f64 = terms.iter().map(|t| t.value.abs() + t.error).sum();
    Rounded {
        error: sum
            .error
            .max(terms.iter().map(|t| t.error).sum::<f64>() + 2.1 * U * sizes),
        ..sum
    }
}
