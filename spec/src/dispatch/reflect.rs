//! Stage `reflect`: rays that mirrors send on.

use super::World;
use super::ray::{Carried, Ray, weighted};
use crate::grid::lattice::Point;
use crate::grid::ray::Ray as Way;
use crate::rsm::Surface;

/// Bits of the longest component of a mirror direction, and one more where rounding makes it so.
const DIRECTION_BITS: u32 = 23;

/// The direction into which a plane mirrors another, of 23 bits.
///
/// With `n` the normal and `d` the direction it is `(n . n) d - 2 (n . d) n`: as `n` need not have
/// length 1, nothing is rounded. `n` is the normal at 14 bits ([`crate::rsm::Face::coarse`]), made once, which
/// tilts a mirror by at most `sqrt(3) / 2^15`, 5.3e-5 radians. A component of `n` is at most 2^14, one
/// of `d` at most 2^24, so `n . n` is below 2^28.01, `|n . d|` below 2^38.9, and the vector below
/// 2^54.2. It is shifted right until its longest component has 23 bits, rounding halves up.
pub fn mirrored(normal: Point, direction: Point) -> Point {
    let [n, d] = [normal, direction].map(|v| v.map(i64::from));
    let dot = |a: [i64; 3], b: [i64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let (square, along) = (dot(n, n), dot(n, d));
    let exact = [0, 1, 2].map(|i| square * d[i] - 2 * along * n[i]);
    let longest = exact.iter().fold(0, |m: u64, c| m.max(c.unsigned_abs()));
    let bits = u64::BITS - longest.leading_zeros();
    let shift = bits.saturating_sub(DIRECTION_BITS);
    let half = (1_i64 << shift) >> 1;
    exact.map(|c| i32::try_from((c + half) >> shift).expect("at most 2^23"))
}

/// Stage `reflect` (paper section 5.1: "one specular reflection ray per intersection point (if the
/// material has a specular reflection coefficient larger than 0)"): the mirror ray of a point,
/// if its material mirrors anything of what the pixel gets from there, and no ray has seen as
/// many mirrors as it may.
///
/// A direction that does not leave to the side that is seen is a ray so flat that rounding turned it into the
/// face; it is not shot.
pub fn reflect(world: &World, ray: &Ray, surface: &Surface) -> Option<Ray> {
    let Carried::Weight(weight) = ray.carried else {
        return None;
    };
    let weight = weighted(weight, world.mirrors[surface.triangle as usize]);
    if ray.depth >= world.depth || weight == [0; 3] {
        return None;
    }
    let face = world.model.face(surface.triangle);
    let direction = mirrored(face.coarse, ray.way.direction);
    let leaves = face.along(direction).signum() == i128::from(surface.side);
    leaves.then_some(Ray {
        way: Way {
            origin: surface.point,
            direction,
            segment: false,
        },
        depth: ray.depth + 1,
        carried: Carried::Weight(weight),
        ..*ray
    })
}
