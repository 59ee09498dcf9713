//! Stage `locate`: the point of a triangle that a ray meets.

use super::World;
use crate::grid::exact::{minus, triple};
use crate::grid::lattice::Point;
use crate::grid::ray::Ray as Way;
use crate::rsm::{OFFSET_MIN, Surface, moved_off};

/// By how many steps a point is moved off its face. Two always lead to the side that is seen
/// ([`OFFSET_MIN`]), so a ray that leaves to that side never meets the face that it leaves.
pub const OFFSET: u32 = OFFSET_MIN;

/// Stage `locate`: the point of a triangle that a ray meets, given that it meets it.
///
/// With `num / den` the time of the meeting, a coordinate is `origin + direction num / den`,
/// rounded to the nearest integer, halves up: exactly, as a quotient of integers below 2^102. As the
/// exact point lies within the triangle, whose corners are integers, so does the rounded one
/// within its box. It is then moved off the face to the side that is seen.
pub fn locate(world: &World, way: Way, triangle: u32) -> Surface {
    let [a, b, c] = world.model.corners(triangle);
    let edges = [minus(b, a), minus(c, a)];
    // normal . direction, and normal . (a - origin): their quotient is the time.
    let facing = triple(way.direction, edges[0], edges[1]);
    let height = triple(minus(a, way.origin), edges[0], edges[1]);
    debug_assert!(facing != 0, "a triangle that is seen edge-on is not met");
    let sign = facing.signum();
    let (num, den) = (height * sign, facing * sign);
    let point: Point = [0, 1, 2].map(|axis| {
        let along = i128::from(way.direction[axis]) * num;
        let steps = (2 * along + den).div_euclid(2 * den);
        way.origin[axis] + i32::try_from(steps).expect("from one point of the lattice to another")
    });
    let side = if sign < 0 { 1 } else { -1 };
    Surface {
        triangle,
        side,
        point: moved_off(&world.model, triangle, side, point, OFFSET),
    }
}
