//! What Embree's `f32` arithmetic can promise about one ray and one triangle.
//!
//! In robust mode Embree 4 tests a triangle with Plücker coordinates
//! (`kernels/geometry/triangle_intersector_pluecker.h`). With the corners
//! `v0, v1, v2` relative to the ray's origin, `e0 = v2 - v0`, `e1 = v0 - v1`,
//! `e2 = v1 - v2`, and D the direction, it computes
//!
//! ```text
//! U = cross(e0, v2 + v0) . D,  V = cross(e1, v0 + v1) . D,  W = cross(e2, v1 + v2) . D
//! hit if min(U, V, W) >= -eps or max(U, V, W) <= eps,  eps = 2^-23 |U + V + W|
//! N = cross(e0, e1) or cross(e1, e2), per component the one with smaller terms
//! t = rcp(2 N . D) 2 (v0 . N),  hit only if 0 <= t and N . D != 0
//! ```
//!
//! Here D = (0, 0, 1), so the dots with D are exact, and U, V, W and N . D depend
//! on x and y alone. Those are integers below 2^22, hence so are, exactly, corners
//! relative to the origin, their differences and sums; only products and their
//! differences round. A bound on rounding as if every operation rounded also holds
//! where the compiler fuses some. No intermediate value overflows or underflows:
//! all are 0 or between 2^-26 and 2^70.
//!
//! Everything here is decided before Embree is asked. Computed in `f64`, with
//! `SECOND_ORDER` for its rounding and for products of two roundings.

use triptych_spec::vertex::Primitives;

use super::rounded::{RECIPROCAL, SECOND_ORDER, U};
use super::scene::Depth;

/// Integers up to here are exact in `f32`.
const EXACT: f64 = 16_777_216.0;

/// A triangle as Embree has it, with what does not depend on the ray.
#[derive(Clone, Copy, Debug)]
pub struct Triangle {
    /// x and y of the corners in sub-pixels; integers.
    corners: [[f64; 2]; 3],
    /// z of the first corner, the reference point of t.
    z: f64,
    /// Largest rounding error of a corner's z.
    z_error: f64,
    normal: [f64; 3],
    normal_error: [f64; 3],
    /// Keys per unit of t.
    scale: f64,
}

/// What must come of a ray and a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Promise {
    /// Embree reports the triangle.
    Hit {
        /// Largest distance of [`Depth::key`] of its t from the exact key.
        bound: f64,
    },
    /// Embree does not report the triangle.
    Miss,
    /// Rounding may decide either way.
    Unresolved,
}

impl Triangle {
    /// Prepares row `prim`.
    pub fn new(primitives: &Primitives, depth: &Depth, prim: u32) -> Self {
        let corners = primitives.prims[prim as usize].map(|c| primitives.snapped[c as usize]);
        let z = corners.map(|c| f64::from(depth.z(c[2])));
        let z_error = (0..3)
            .map(|i| (z[i] - depth.exact_z(corners[i][2])).abs())
            .fold(0.0, f64::max);
        let at = |i: usize| [f64::from(corners[i][0]), f64::from(corners[i][1]), z[i]];
        let edge = |a: [f64; 3], b: [f64; 3]| [0, 1, 2].map(|i| a[i] - b[i]);
        let edges = [edge(at(2), at(0)), edge(at(0), at(1)), edge(at(1), at(2))];
        let (normal, normal_error) = normal(edges);
        Self {
            corners: corners.map(|c| [f64::from(c[0]), f64::from(c[1])]),
            z: z[0],
            z_error,
            normal,
            normal_error,
            scale: depth.scale(),
        }
    }

    /// What Embree must say about the ray through a point in sub-pixels.
    pub fn promise(&self, point: [i64; 2]) -> Promise {
        let corners = self
            .corners
            .map(|c| [c[0] - point[0] as f64, c[1] - point[1] as f64]);
        let (edges, errors) = pluecker(corners);
        // Embree accepts both orientations; so does this.
        let sum: f64 = edges.iter().sum();
        let inside = edges.map(|e| if sum < 0.0 { -e } else { e });
        if (0..3).all(|i| inside[i] > 0.0 && inside[i] >= errors[i]) {
            return self.depth(corners[0]);
        }
        let roundings: f64 = (0..3).map(|i| errors[i] + 2.0 * U * edges[i].abs()).sum();
        let eps = f64::from(f32::EPSILON) * (sum.abs() + roundings) * SECOND_ORDER;
        let surely = |beyond: f64| (0..3).any(|i| beyond * edges[i] - errors[i] > eps);
        // Embree rejects what is surely negative somewhere and positive elsewhere.
        if surely(1.0) && surely(-1.0) {
            Promise::Miss
        } else {
            Promise::Unresolved
        }
    }

    /// The bound on t, for a point inside.
    ///
    /// With `S = x0 Nx + y0 Ny`, `t = z0 + S / Nz`. Embree's `Nz` divides what it
    /// multiplied before, so its error acts on `S / Nz` alone. Then come the three
    /// roundings of the dot product's terms and the reciprocal.
    fn depth(&self, [x, y]: [f64; 2]) -> Promise {
        let terms = [x, y, self.z];
        let least = self.normal[2].abs() - self.normal_error[2];
        if least <= 0.0 {
            return Promise::Unresolved; // the denominator's sign is open
        }
        let shift = (x * self.normal[0] + y * self.normal[1]) / self.normal[2];
        let of_normal = x.abs() * self.normal_error[0]
            + y.abs() * self.normal_error[1]
            + shift.abs() * self.normal_error[2];
        let of_dot: f64 = (0..3)
            .map(|i| 3.0 * U * terms[i].abs() * (self.normal[i].abs() + self.normal_error[i]))
            .sum();
        let before = (of_normal + of_dot) / least;
        let t = self.z + shift;
        let error = (before + RECIPROCAL * (t.abs() + before)) * SECOND_ORDER;
        if t <= error {
            return Promise::Unresolved; // Embree may see it behind the ray's start
        }
        Promise::Hit {
            // z is a convex combination of the corners' at a point inside, and so
            // is its rounding error.
            bound: (error + self.z_error) * self.scale,
        }
    }
}

/// U, V, W: exact values, and bounds on Embree's errors.
fn pluecker(corners: [[f64; 2]; 3]) -> ([f64; 3], [f64; 3]) {
    let mut values = [0.0; 3];
    let mut errors = [0.0; 3];
    for (i, (a, b)) in [(2, 0), (0, 1), (1, 2)].into_iter().enumerate() {
        let (a, b): ([f64; 2], [f64; 2]) = (corners[a], corners[b]);
        let (first, second) = ((a[0] - b[0]) * (a[1] + b[1]), (a[1] - b[1]) * (a[0] + b[0]));
        values[i] = first - second;
        errors[i] = integer_difference_error(first, second);
    }
    (values, errors)
}

/// Error of the difference of two products of exact integers.
fn integer_difference_error(first: f64, second: f64) -> f64 {
    let of_products = rounding(first) + rounding(second);
    let difference = (first - second).abs() + of_products;
    (of_products + rounding(difference)) * SECOND_ORDER
}

/// Error of rounding an integer to `f32`.
fn rounding(integer: f64) -> f64 {
    let size = integer.abs();
    if size <= EXACT { 0.0 } else { U * size }
}

/// The normal of a triangle with these edges: exact up to `f64`, and bounds on
/// Embree's errors.
///
/// For each component Embree takes the cross product of that pair of edges whose
/// second product is smaller. With `N = P - Q`, `|P| <= |N| + |Q|`, and `|Q|` the
/// smaller of the two up to second order, the error is at most three roundings
/// (an edge's z, a product, the difference) of `|N| + 2 |Q|`. For z the edges are
/// integers, and both pairs are bounded.
fn normal([a, b, c]: [[f64; 3]; 3]) -> ([f64; 3], [f64; 3]) {
    let products = |p: [f64; 3], q: [f64; 3]| {
        [
            (p[1] * q[2], p[2] * q[1]),
            (p[2] * q[0], p[0] * q[2]),
            (p[0] * q[1], p[1] * q[0]),
        ]
    };
    let (ab, bc) = (products(a, b), products(b, c));
    let normal = ab.map(|(p, q)| p - q);
    let error = [0, 1, 2].map(|i| {
        let second = ab[i].1.abs().min(bc[i].1.abs());
        let general = 3.0 * U * (normal[i].abs() + 2.0 * second) * SECOND_ORDER;
        if i == 2 {
            let [of_ab, of_bc] = [ab[2], bc[2]].map(|(p, q)| integer_difference_error(p, q));
            general.min(of_ab.max(of_bc))
        } else {
            general
        }
    });
    (normal, error)
}
