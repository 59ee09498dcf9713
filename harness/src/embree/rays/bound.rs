//! What Embree's `f32` arithmetic can promise about a ray and a triangle on the lattice.
//!
//! The algorithm is that of [`crate::embree::bound`]; with the corners `v0, v1, v2`
//! relative to the ray's origin, and the direction D,
//!
//! ```text
//! U = cross(e0, v2 + v0) . D,  e0 = v2 - v0;  V and W alike with v0, v1 and v1, v2
//! hit only if min(U, V, W) >= -eps or max(U, V, W) <= eps,  eps = 2^-23 |U + V + W|
//! N = cross(e0, e1) or cross(e1, e2), per component the one with the smaller second term
//! t = rcp(2 N . D) 2 (v0 . N),  hit only if N . D != 0 and 0 <= t <= end of the ray
//! ```
//!
//! **What is exact.** A corner relative to the origin, an edge and D are differences of
//! lattice points, integers of at most 2^24: no rounding. A sum such as `v2 + v0` is an
//! integer of at most 2^25, rounded by 1 if it is odd and beyond 2^24. So
//! `cross(e0, v2 + v0) = 2 cross(v2, v0)`, and U is twice the triple product by which the
//! spec decides ([`sides`]): exact values come from there, in `i128`.
//!
//! **Edge functions.** Write u = 2^-24, s for the sum, r for its rounding. A component
//! `c = e_j s_k - e_k s_j` has two products and a difference, so it is off by at most
//!
//! ```text
//! |e_j| r_k + |e_k| r_j + u (|e_j s_k| + |e_k s_j|) + u |c|
//! ```
//!
//! In the dot product a product and at most two sums reach each term, in any order of
//! summing: `3 u |D_i c_i|` more. Embree's tolerance eps works for a hit only; its own
//! rounding is that of two sums, `2 u (|U| + |V| + |W|)` and the errors of U, V and W.
//!
//! **Time.** With e0, e1, e2 exact, a component `n = p - q` of N is off by at most
//! `u (|p| + |q|) + u |n| <= 2 u (|n| + |q|)`, and q is the smaller of two, up to second
//! order. The exact t puts `d = v0 - t D` in the triangle's plane, where `d . N = 0`, so
//!
//! ```text
//! (N + n) . D (t' - t) = d . n + r0 - t rD
//! ```
//!
//! with n the error of N, and r0, rD the roundings of the two dot products, at most
//! `3 u` of the sum of their terms' sizes. The reciprocal and the last product come on top
//! ([`RECIPROCAL`]). Where n and rD may change the sign of `N . D`, t is open.
//!
//! **What this relies on.** Every operation rounds to nearest in `f32`: the leg's Embree is
//! held to SSE2 (`embree::collect`), where there is no fused operation, and Rust leaves the
//! processor's rounding mode alone. Terms of second order are below [`SECOND_ORDER`], as is
//! the rounding of the `f64` in which bounds are worked out. Values are integers, up to
//! rounding, until the reciprocal: 0 or from 1 to 2^79, whose reciprocals and products with
//! them are far from the ends of the range.
//!
//! **The tree.** A pair inside is never culled. Corners of boxes are lattice points, so
//! their differences to the origin are exact; times of a box's planes are off by at most
//! three roundings, for which robust mode makes up with factors of 1 -+ 6 u. On an axis
//! along which the ray does not move, Embree takes 10^18 times the way to a plane for its
//! time. A point within the triangle, off its edges, is between the planes there, hence by
//! a step at least, as the ray's coordinate is an integer like theirs; and no ray takes
//! longer than 2^24 to where blockers are. (A point on an edge may lie in such a plane, and
//! Embree then culls it: those pairs are in class edge.) A box is passed over for a hit that
//! Embree has already only if its near time, hence every exact t in it, is later than
//! Embree's t of that hit.

use triptych_spec::grid::exact::{Time, minus, triple};
use triptych_spec::grid::hit::sides;
use triptych_spec::grid::lattice::Point;
use triptych_spec::grid::ray::Ray;

use crate::embree::rounded::{RECIPROCAL, SECOND_ORDER, U};

/// When a ray crosses a triangle's plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Met {
    /// The exact time, up to `f64`.
    pub t: f64,
    /// Largest distance of Embree's.
    pub bound: f64,
}

impl Met {
    /// Before this, Embree does not see it.
    pub fn earliest(&self) -> f64 {
        self.t - self.bound
    }

    /// After this, Embree does not see it.
    pub fn latest(&self) -> f64 {
        self.t + self.bound
    }
}

/// A ray and a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pair {
    /// The ray meets the triangle, and Embree finds it to.
    Inside(Met),
    /// It does not, and neither does it for Embree.
    Outside,
    /// Rounding may decide either way; without a time if that is open as well.
    Edge(Option<Met>),
}

/// In which class a pair is: a matter of the two alone, whatever Embree says.
pub fn pair(ray: &Ray, corners: [Point; 3]) -> Pair {
    let volumes = sides(ray, corners);
    let edges = volumes.map(|volume| 2.0 * volume as f64);
    let errors = edge_errors(ray, corners);
    let inside = |sign: f64| (0..3).all(|i| sign * edges[i] > errors[i]);
    let certain = inside(1.0) || inside(-1.0);
    if !certain && rejected(edges, errors) {
        return Pair::Outside;
    }
    let plane = Plane::new(corners);
    if plane.normal == [0.0; 3] {
        return Pair::Outside; // without area: N is 0 for Embree, too, term by term
    }
    let Some(met) = plane.met(ray, corners, volumes.iter().sum()) else {
        return Pair::Edge(None);
    };
    let (early, late) = (met.earliest(), met.latest());
    if late < 0.0 || ray.segment && early > 1.0 {
        Pair::Outside
    } else if certain && early > 0.0 && !(ray.segment && late > 1.0) {
        Pair::Inside(met)
    } else {
        Pair::Edge(Some(met))
    }
}

/// Whether Embree finds one edge function beyond its tolerance on each side.
fn rejected(edges: [f64; 3], errors: [f64; 3]) -> bool {
    let sum: f64 = edges.iter().sum();
    let roundings: f64 = (0..3).map(|i| errors[i] + 2.0 * U * edges[i].abs()).sum();
    let eps = f64::from(f32::EPSILON) * (sum.abs() + roundings) * SECOND_ORDER;
    let beyond = |sign: f64| (0..3).any(|i| sign * edges[i] > errors[i] + eps);
    beyond(1.0) && beyond(-1.0)
}

/// Bounds on Embree's errors of the edge functions; entry `i` belongs to the edge opposite
/// corner `i`.
pub(super) fn edge_errors(ray: &Ray, corners: [Point; 3]) -> [f64; 3] {
    let [a, b, c] = corners.map(|corner| minus(corner, ray.origin));
    let direction = ray.direction.map(size);
    [[b, c], [c, a], [a, b]].map(|[from, to]| {
        let edge = [0, 1, 2].map(|i| i64::from(to[i]) - i64::from(from[i]));
        let sum = [0, 1, 2].map(|i| i64::from(to[i]) + i64::from(from[i]));
        let off = sum.map(rounding);
        let component = |j: usize, k: usize| {
            let (first, second) = (edge[j] * sum[k], edge[k] * sum[j]);
            let cross = (first - second).abs() as f64;
            let products = first.abs() as f64 + second.abs() as f64;
            let of_sums = edge[j].abs() as f64 * off[k] + edge[k].abs() as f64 * off[j];
            of_sums + U * (products + 4.0 * cross)
        };
        let terms = [component(1, 2), component(2, 0), component(0, 1)];
        (0..3).map(|i| direction[i] * terms[i]).sum::<f64>() * SECOND_ORDER
    })
}

/// How far an integer is from the `f32` nearest to it.
fn rounding(integer: i64) -> f64 {
    let single = integer as f32;
    (f64::from(single) - integer as f64).abs()
}

fn size(component: i32) -> f64 {
    f64::from(component.unsigned_abs())
}

/// The normal of a triangle.
struct Plane {
    /// Exact: components are below 2^50.
    normal: [f64; 3],
    /// Largest errors of Embree's.
    errors: [f64; 3],
}

impl Plane {
    fn new([a, b, c]: [Point; 3]) -> Self {
        let [e0, e1, e2] = [minus(c, a), minus(a, b), minus(b, c)].map(|e| e.map(i64::from));
        let component = |j: usize, k: usize| {
            let normal = (e0[j] * e1[k] - e0[k] * e1[j]) as f64;
            let (one, other) = (e0[k] * e1[j], e1[k] * e2[j]);
            let second = one.abs().min(other.abs()) as f64;
            (normal, 2.0 * U * (normal.abs() + second) * SECOND_ORDER)
        };
        let components = [component(1, 2), component(2, 0), component(0, 1)];
        Self {
            normal: components.map(|(normal, _)| normal),
            errors: components.map(|(_, error)| error),
        }
    }

    /// When the ray crosses the plane; `facing` is `N . D`, exactly.
    fn met(&self, ray: &Ray, [a, b, c]: [Point; 3], facing: i128) -> Option<Met> {
        let corner = minus(a, ray.origin);
        let sum = |term: &dyn Fn(usize) -> f64| (0..3).map(term).sum::<f64>();
        let reach = |i: usize| self.normal[i].abs() + self.errors[i];
        let tilt = sum(&|i| size(ray.direction[i]) * self.errors[i]);
        let steepness = 3.0 * U * sum(&|i| size(ray.direction[i]) * reach(i));
        let least = (facing as f64).abs() - (tilt + steepness) * SECOND_ORDER;
        if least <= 0.0 {
            return None;
        }
        let t = Time::new(triple(corner, minus(b, a), minus(c, a)), facing).value();
        // t is off by 2^-51 of itself.
        let aside = |i: usize| {
            let (from, way) = (f64::from(corner[i]), t * f64::from(ray.direction[i]));
            (from - way).abs() + way.abs() * 2.0 * f64::EPSILON
        };
        let of_normal = sum(&|i| aside(i) * self.errors[i]);
        let of_dot = 3.0 * U * sum(&|i| size(corner[i]) * reach(i));
        let before = (of_normal + of_dot + t.abs() * steepness) / least;
        Some(Met {
            t,
            bound: (before + RECIPROCAL * (t.abs() + before)) * SECOND_ORDER,
        })
    }
}
