//! What Embree's `f32` arithmetic can promise about a camera ray and a triangle.
//!
//! The algorithm is that of [`crate::embree::bound`], with a direction D that is not an
//! axis. Everything starts from exact numbers, up to `f64`: the errors of what Embree is
//! given (vertices, origin, direction, each rounded to `f32` once) are part of the bound,
//! and so is every rounding after them.
//!
//! **Inside or outside** is decided by U, V and W, whose values and errors follow
//! operation by operation ([`Rounded`]).
//!
//! **Distance.** Embree takes `t = (v0 . N) / (N . D)` for its own corner v0 and normal N,
//! both with errors; with the exact t, `d = v0 - t D` lies in the triangle's plane, so
//! `d . N = 0` and, to first order,
//!
//! ```text
//! (N + n) . D (t' - t) = d . n + e0 . (N + n) + r0 - t (eD . (N + n) + rD)
//! ```
//!
//! with n, e0, eD the errors of N, v0 and D, and r0, rD the roundings of the two dot
//! products. So the normal's error counts with the size of the triangle, not with its
//! distance. Then come the reciprocal and the last product.

use super::World;
use crate::embree::rounded::{RECIPROCAL, Rounded, SECOND_ORDER, U, Vector, cross, dot};
use crate::embree::view::Ray;

/// What must come of a ray and a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Promise {
    /// Embree reports the triangle.
    Hit {
        /// Distance along the ray, in world units.
        t: f64,
        /// Largest error of Embree's.
        bound: f64,
    },
    /// Embree does not report the triangle.
    Miss,
    /// Rounding may decide either way.
    Unresolved,
}

/// A ray in Embree's units.
struct Sight {
    origin: Vector,
    direction: Vector,
    range: [f64; 2],
}

/// What Embree must say about a ray and a triangle of these vertices.
pub fn promise(world: &World, vertices: [u32; 3], ray: &Ray) -> Promise {
    let sight = Sight {
        origin: ray.origin.map(|x| Rounded::once(x * world.scale)),
        direction: ray.direction.map(Rounded::once),
        range: ray.range.map(|t| t * world.scale),
    };
    let corner = |v: u32| {
        let at = world.points[v as usize].map(Rounded::once);
        [0, 1, 2].map(|i| at[i].minus(sight.origin[i]))
    };
    let corners = vertices.map(corner);
    let [a, b, c] = corners;
    let edges = [minus(c, a), minus(a, b), minus(b, c)];
    match side(edges, [plus(c, a), plus(a, b), plus(b, c)], sight.direction) {
        Some(true) => distance(corners, edges, &sight, world.scale),
        Some(false) => Promise::Miss,
        None => Promise::Unresolved,
    }
}

/// Whether the ray meets the triangle; `None` if rounding may decide.
fn side(edges: [Vector; 3], sums: [Vector; 3], direction: Vector) -> Option<bool> {
    let sides = [0, 1, 2].map(|i| dot(cross(edges[i], sums[i]), direction));
    let sum = sides[0].plus(sides[1]).plus(sides[2]);
    // Embree accepts both orientations.
    let inside = |sign: f64| sides.iter().all(|s| s.value * sign > s.error);
    if inside(1.0) || inside(-1.0) {
        return Some(true);
    }
    let eps = f64::from(f32::EPSILON) * (sum.value.abs() + sum.error) * SECOND_ORDER;
    let surely = |sign: f64| sides.iter().any(|s| s.value * sign > s.error + eps);
    (surely(1.0) && surely(-1.0)).then_some(false)
}

/// The distance of a triangle that is met, and whether it is in the ray's range.
fn distance(corners: [Vector; 3], edges: [Vector; 3], sight: &Sight, scale: f64) -> Promise {
    let corner = corners[0];
    // Per component Embree takes one of two pairs of edges.
    let (one, other) = (cross(edges[0], edges[1]), cross(edges[1], edges[2]));
    let normal = [0, 1, 2].map(|i| one[i].or(other[i]));
    let direction = sight.direction;
    let sum = |term: &dyn Fn(usize) -> f64| (0..3).map(term).sum::<f64>();
    let slope = sum(&|i| normal[i].value * direction[i].value);
    let t = sum(&|i| normal[i].value * corner[i].value) / slope;
    let size = |v: Rounded| v.value.abs() + v.error;
    let given = |v: Vector| sum(&|i| v[i].error * size(normal[i]));
    // Three roundings reach a term: its product, two sums.
    let rounding = |v: Vector| 3.0 * U * sum(&|i| size(v[i]) * size(normal[i]));
    let aside = |i: usize| (corner[i].value - t * direction[i].value).abs();
    let of_normal = sum(&|i| aside(i) * normal[i].error);
    let steepness = given(direction) + rounding(direction);
    let tilt = sum(&|i| direction[i].value.abs() * normal[i].error);
    let least = slope.abs() - tilt - steepness;
    let open = !(least > 0.0 && t.is_finite());
    if open {
        return Promise::Unresolved; // seen edge on: the denominator's sign is open
    }
    let before = (of_normal + given(corner) + rounding(corner) + t.abs() * steepness) / least;
    let error = (before + RECIPROCAL * (t.abs() + before)) * SECOND_ORDER;
    let [near, far] = sight.range.map(Rounded::once);
    let beyond = |d: f64, limit: Rounded| d > error + limit.error;
    if beyond(near.value - t, near) || beyond(t - far.value, far) {
        Promise::Miss
    } else if beyond(t - near.value, near) && beyond(far.value - t, far) {
        Promise::Hit {
            t: t / scale,
            bound: error / scale,
        }
    } else {
        Promise::Unresolved
    }
}

fn minus(a: Vector, b: Vector) -> Vector {
    [0, 1, 2].map(|i| a[i].minus(b[i]))
}

fn plus(a: Vector, b: Vector) -> Vector {
    [0, 1, 2].map(|i| a[i].plus(b[i]))
}
