//! Exact arithmetic on lattice differences.
//!
//! Components are at most 2^24 in size ([`super::lattice`]), so those of a cross product
//! are at most 2^49 and a triple product is below 6 * 2^72 < 2^75: `i64` and `i128` hold
//! them.

use std::cmp::Ordering;

use super::lattice::Point;

/// `to - from`.
pub fn minus(to: Point, from: Point) -> Point {
    [to[0] - from[0], to[1] - from[1], to[2] - from[2]]
}

/// `x . (y x z)`: the signed volume of the box that three differences span.
pub fn triple(x: Point, y: Point, z: Point) -> i128 {
    let [x, y, z] = [x, y, z].map(|v| v.map(i64::from));
    let cross = |j: usize, k: usize| y[j] * z[k] - y[k] * z[j];
    let term = |i: usize, component: i64| i128::from(x[i]) * i128::from(component);
    term(0, cross(1, 2)) + term(1, cross(2, 0)) + term(2, cross(0, 1))
}

/// When a ray is somewhere: `num / den` of its direction, exactly.
#[derive(Clone, Copy, Debug)]
pub struct Time {
    num: i128,
    den: i128,
}

impl Time {
    /// When the ray starts.
    pub const START: Self = Self { num: 0, den: 1 };
    /// When a segment ends.
    pub const END: Self = Self { num: 1, den: 1 };

    /// `num / den`, where `den` is not 0.
    pub fn new(num: i128, den: i128) -> Self {
        let sign = den.signum();
        Self {
            num: num * sign,
            den: den * sign,
        }
    }

    /// The quotient, within 2^-51 of itself.
    pub fn value(self) -> f64 {
        self.num as f64 / self.den as f64
    }
}

impl Ord for Time {
    fn cmp(&self, other: &Self) -> Ordering {
        let signs = self.num.signum().cmp(&other.num.signum());
        let left = wide(self.num.unsigned_abs(), other.den.unsigned_abs());
        let right = wide(other.num.unsigned_abs(), self.den.unsigned_abs());
        let sizes = match self.num < 0 {
            true => right.cmp(&left),
            false => left.cmp(&right),
        };
        signs.then(sizes)
    }
}

impl PartialOrd for Time {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Time {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Time {}

/// The product of two numbers below 2^127, high part first.
fn wide(a: u128, b: u128) -> (u128, u128) {
    if let Some(product) = a.checked_mul(b) {
        return (0, product);
    }
    const LOW: u128 = u64::MAX as u128;
    let (a1, a0, b1, b0) = (a >> 64, a & LOW, b >> 64, b & LOW);
    let middle = a1 * b0 + ((a0 * b0) >> 64);
    let other = a0 * b1 + (middle & LOW);
    let low = (other << 64) | ((a0 * b0) & LOW);
    (a1 * b1 + (middle >> 64) + (other >> 64), low)
}
