//! Where a ray meets a triangle, exactly.

use super::exact::{Time, minus, triple};
use super::lattice::Point;
use super::ray::Ray;

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

/// On which side of each edge the ray passes; entry `i` belongs to the edge opposite
/// corner `i`.
pub fn sides(ray: &Ray, corners: [Point; 3]) -> [i128; 3] {
    [0, 1, 2].map(|i| {
        let (from, to) = (corners[(i + 1) % 3], corners[(i + 2) % 3]);
        triple(minus(to, from), ray.direction, minus(from, ray.origin))
    })
}
