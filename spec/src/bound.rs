//! Running error bounds for `f32` arithmetic under WGSL's accuracy rules.
//!
//! A [`Bounded`] carries what the specification computes and how far an `f32`
//! evaluation of the same expression may stray. The rules (WGSL, "Floating Point
//! Accuracy"): sums and products are correctly rounded in an unspecified
//! direction, hence within one unit [`U`]; division within 2.5; any subnormal may
//! be flushed, hence [`TINY`] once per operation; sums may be reassociated and
//! fused, which [`Real::sum_of_products`] allows for. An operation whose operands leave
//! the range that WGSL defines has an infinite bound: nothing is promised there.

/// Relative error of one correctly rounded operation, direction unspecified.
pub const U: f64 = f32::EPSILON as f64;

/// What flushing a subnormal changes at most.
pub const TINY: f64 = f32::MIN_POSITIVE as f64;

/// WGSL promises division only for divisors between these magnitudes.
const DIVISOR: [f64; 2] = [TINY, 1.0 / TINY];

/// `gamma_k = kU / (1 - kU)`: the error of `k` roundings, relative to the sum of
/// the absolute terms (Higham, Accuracy and Stability of Numerical Algorithms,
/// lemma 3.1).
pub fn gamma(k: u32) -> f64 {
    let ku = f64::from(k) * U;
    ku / (1.0 - ku)
}

/// The arithmetic that the vertex stage needs, over plain or bounded numbers.
pub trait Real: Copy {
    /// An exactly representable constant.
    fn exact(value: f64) -> Self;
    /// The number itself, without its bound.
    fn value(self) -> f64;
    /// Sum.
    fn add(self, other: Self) -> Self;
    /// Difference.
    fn sub(self, other: Self) -> Self;
    /// Product.
    fn mul(self, other: Self) -> Self;
    /// Quotient.
    fn div(self, other: Self) -> Self;
    /// Sum of products of given numbers: the coefficients are rounded to `f32`
    /// once, the terms added in any order, fused or not.
    fn sum_of_products(coefficients: [f64; 4], terms: [f64; 4]) -> Self;
    /// `self / (self - other)` for numbers that an evaluation sees with different
    /// signs, so that it gets a number in `[0, 1]`, but for rounding. Where WGSL leaves
    /// the quotient undefined, a kernel takes any number of that range.
    fn fraction(self, other: Self) -> Self;
    /// This number, where an evaluation may just as well take `other`, another way
    /// to the same result.
    fn or(self, other: Self) -> Self;
    /// The larger of this number and an exactly representable constant.
    fn at_least(self, least: f64) -> Self;
    /// Whether two numbers compare in every evaluation as they do here.
    fn certainly_differs(self, other: Self) -> bool;
}

impl Real for f64 {
    fn exact(value: f64) -> Self {
        value
    }
    fn value(self) -> f64 {
        self
    }
    fn add(self, other: Self) -> Self {
        self + other
    }
    fn sub(self, other: Self) -> Self {
        self - other
    }
    fn mul(self, other: Self) -> Self {
        self * other
    }
    fn div(self, other: Self) -> Self {
        self / other
    }
    fn sum_of_products(c: [f64; 4], t: [f64; 4]) -> Self {
        c[0] * t[0] + c[1] * t[1] + c[2] * t[2] + c[3] * t[3]
    }
    fn fraction(self, other: Self) -> Self {
        self / (self - other)
    }
    fn or(self, _: Self) -> Self {
        self
    }
    fn at_least(self, least: f64) -> Self {
        self.max(least)
    }
    fn certainly_differs(self, other: Self) -> bool {
        self != other
    }
}

fn flushed_product(c: f64, t: f64) -> f64 {
    let term = if t.abs() < TINY { (c * t).abs() } else { 0.0 };
    TINY * (t.abs() + 2.0) + term
}

/// A number and the largest error of its `f32` evaluation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounded {
    /// What the specification computes.
    pub value: f64,
    /// Largest distance of a conforming `f32` result; may be infinite.
    pub bound: f64,
}

impl Bounded {
    /// Whether `observed` is a conforming result. NaN never is.
    pub fn admits(self, observed: f64) -> bool {
        (observed - self.value).abs() <= self.bound
    }

    /// A number that is rounded to `f32` once.
    pub fn once(value: f64) -> Self {
        Self {
            value,
            bound: U * value.abs() + TINY,
        }
    }

    /// Whether every conforming result compares with zero as this number does.
    pub fn sign_is_certain(self) -> bool {
        self.bound == 0.0 || self.value.abs() > self.bound
    }

    /// `1 / sqrt(self)` by WGSL's `inverseSqrt`, which is off by 2 units; what it makes of
    /// numbers that are not above [`TINY`] is not defined.
    pub fn inverse_sqrt(self) -> Self {
        let least = self.value - self.bound;
        let value = 1.0 / self.value.sqrt();
        if !(least >= TINY && self.value + self.bound <= f64::from(f32::MAX)) {
            return Self {
                value,
                bound: f64::INFINITY,
            };
        }
        // Convex and falling: farthest off where the operand is least.
        Self::rounded(value, 1.0 / least.sqrt() - value, 2.0)
    }

    /// Finishes one operation: the propagated error of the operands, and `roundings`
    /// units for the operation itself.
    fn rounded(value: f64, propagated: f64, roundings: f64) -> Self {
        let reach = value.abs() + propagated;
        let bound = propagated + roundings * U * reach + TINY;
        let defined = reach + bound <= f64::from(f32::MAX);
        Self {
            value,
            bound: if defined { bound } else { f64::INFINITY },
        }
    }
}

impl Real for Bounded {
    fn exact(value: f64) -> Self {
        Self { value, bound: 0.0 }
    }
    fn value(self) -> f64 {
        self.value
    }
    fn add(self, other: Self) -> Self {
        Self::rounded(self.value + other.value, self.bound + other.bound, 1.0)
    }
    fn sub(self, other: Self) -> Self {
        Self::rounded(self.value - other.value, self.bound + other.bound, 1.0)
    }
    fn mul(self, other: Self) -> Self {
        let propagated = self.value.abs() * other.bound
            + other.value.abs() * self.bound
            + self.bound * other.bound;
        Self::rounded(self.value * other.value, propagated, 1.0)
    }
    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        let least = other.value.abs() - other.bound;
        let most = other.value.abs() + other.bound;
        if !(least >= DIVISOR[0] && most <= DIVISOR[1]) {
            return Self {
                value,
                bound: f64::INFINITY,
            };
        }
        let propagated = (self.bound + value.abs() * other.bound) / least;
        Self::rounded(value, propagated, 2.5)
    }
    fn sum_of_products(c: [f64; 4], t: [f64; 4]) -> Self {
        let value = f64::sum_of_products(c, t);
        let absolute: f64 = c.iter().zip(t).map(|(c, t)| (c * t).abs()).sum();
        // Rounding of the coefficient, the product, three additions.
        // Flushed: the coefficient, the product, the sum; a term that is subnormal.
        let flushed: f64 = c.iter().zip(t).map(|(c, t)| flushed_product(*c, t)).sum();
        let largest = c.iter().chain(&t).fold(absolute, |m, x| m.max(x.abs()));
        let bound = gamma(5) * absolute + flushed;
        let defined = largest + bound <= f64::from(f32::MAX);
        Self {
            value,
            bound: if defined { bound } else { f64::INFINITY },
        }
    }
    fn fraction(self, other: Self) -> Self {
        let quotient = self.div(self.sub(other));
        // Signs that only an f32 evaluation sees differ lead outside [0, 1].
        let value = if quotient.value.is_nan() {
            0.0
        } else {
            quotient.value.clamp(0.0, 1.0)
        };
        let strayed = quotient.bound + (quotient.value - value).abs();
        Self {
            value,
            // The range itself is a bound, with the roundings of a difference and a
            // quotient; `min` ignores a NaN.
            bound: (value.max(1.0 - value) + 4.0 * U).min(strayed),
        }
    }
    fn or(self, other: Self) -> Self {
        let apart = (self.value - other.value).abs();
        Self {
            value: self.value,
            bound: self.bound.max(other.bound + apart),
        }
    }
    fn at_least(self, least: f64) -> Self {
        // Two numbers do not get farther apart.
        Self {
            value: self.value.max(least),
            bound: self.bound,
        }
    }
    fn certainly_differs(self, other: Self) -> bool {
        (self.value - other.value).abs() > self.bound + other.bound
    }
}

/// Adds up numbers in any order.
#[derive(Clone, Copy, Debug, Default)]
pub struct Sum {
    value: f64,
    /// Of the terms, each as large as an evaluation may have it.
    size: f64,
    bound: f64,
    terms: u32,
}

impl Sum {
    /// Adds a term.
    pub fn add(&mut self, term: Bounded) {
        self.value += term.value;
        self.size += term.value.abs() + term.bound;
        self.bound += term.bound;
        self.terms += 1;
    }

    /// How many there are.
    pub fn terms(&self) -> u32 {
        self.terms
    }

    /// The sum of `n` terms in any order is `n - 1` additions: a term meets at most as many
    /// roundings (Higham, section 4.2), and each sum may be flushed. The first is added to
    /// 0, exactly. Fusing a product into an addition only spares a rounding.
    pub fn finish(&self) -> Bounded {
        let additions = self.terms.saturating_sub(1);
        // Sums of nothing but zeros are exact.
        let flushed = if self.size == 0.0 { 0.0 } else { TINY };
        let rounding = gamma(additions) * self.size + f64::from(additions) * flushed;
        let bound = self.bound + rounding;
        let defined = self.size + bound <= f64::from(f32::MAX);
        Bounded {
            value: self.value,
            bound: if defined { bound } else { f64::INFINITY },
        }
    }
}
