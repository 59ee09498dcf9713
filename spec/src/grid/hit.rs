//! Where a ray meets a triangle, exactly.

use super::exact::{Time, minus, triple};
use super::lattice::Point;
use super::ray::Ray;
use crate::bound::{Bounded, U};

/// What the error of a triple product in `f32` is at most, over the sizes of its factors:
/// the sum norm of the first times the largest components of the others. A cross product
/// and a dot product of exact numbers meet five roundings of terms that are twice that size
/// together. Twin: `VOLUME_ERROR` in `gpu/src/volume.wgsl`, where 12 `U` is derived.
pub const VOLUME_ERROR: f64 = 12.0 * U;

/// By how much a triple product must exceed its error for a kernel to divide by it, or it
/// is worked out in integers. Twin: `FOR_TIME` in `gpu/src/meet.wgsl`.
pub const FOR_TIME: f64 = 1024.0;

/// When a ray meets a triangle, edges and corners included.
///
/// Seen along the ray, the triangle's edges have the ray on one side if all three triple
/// products have one sign; 0 belongs to both, so neighbours leave no gap between them.
/// A triangle seen edge-on, or without area, is met by nothing. The products sum up to
/// `direction . normal`, by which the distance to the plane is divided.
pub fn crossing(ray: &Ray, [a, b, c]: [Point; 3]) -> Option<Time> {
    let sides = sides(ray, [a, b, c]);
    let facing = sides.iter().sum::<i128>();
    let inside = sides.iter().all(|s| *s >= 0) || sides.iter().all(|s| *s <= 0);
    if facing == 0 || !inside {
        return None;
    }
    let height = triple(minus(a, ray.origin), minus(b, a), minus(c, a));
    let time = Time::new(height, facing);
    ray.holds(time).then_some(time)
}

/// The same with how far a kernel's time may stray.
///
/// A kernel divides two triple products. Each is an `f32` evaluation whose error is below
/// 1 / [`FOR_TIME`] of it, or an integer that was rounded four times at most; division adds
/// 2.5 units. No number on the way is subnormal: products of integers are at least 1, their
/// quotients at least 2^-75.
pub fn timed(ray: &Ray, corners: [Point; 3]) -> Option<Bounded> {
    let time = crossing(ray, corners)?;
    let [a, b, c] = corners;
    let (start, edges) = (minus(a, ray.origin), [minus(b, a), minus(c, a)]);
    let height = relative_error(start, edges);
    let slope = relative_error(ray.direction, edges);
    let value = time.value();
    let quotient = (1.0 + height) / (1.0 - slope) * (1.0 + 2.5 * U) - 1.0;
    Some(Bounded {
        value,
        bound: value * quotient,
    })
}

/// Of a kernel's triple product, over its value.
fn relative_error(x: Point, [y, z]: [Point; 2]) -> f64 {
    let integers = 4.0 * U;
    let sizes = [y, z].map(largest);
    let sum: f64 = x.iter().map(|c| f64::from(c.abs())).sum();
    let error = VOLUME_ERROR * sum * sizes[0] * sizes[1];
    let value = triple(x, y, z).unsigned_abs() as f64;
    // A kernel decides with rounded numbers: a little below the threshold both are possible.
    match value > 0.99 * FOR_TIME * error {
        true => (error / value).max(integers),
        false => integers,
    }
}

fn largest(v: Point) -> f64 {
    v.iter().map(|c| f64::from(c.abs())).fold(0.0, f64::max)
}

/// On which side of each edge the ray passes; entry `i` belongs to the edge opposite
/// corner `i`.
pub fn sides(ray: &Ray, corners: [Point; 3]) -> [i128; 3] {
    [0, 1, 2].map(|i| {
        let (from, to) = (corners[(i + 1) % 3], corners[(i + 2) % 3]);
        triple(minus(to, from), ray.direction, minus(from, ray.origin))
    })
}
