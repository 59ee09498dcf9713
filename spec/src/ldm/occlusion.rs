//! Stage `occlusion`: how much of the hemisphere over a point is open.

use super::map::KEYS_PER_STEP;
use super::neighbours::dot;
use super::{Hits, Map};
use crate::bound::{Bounded, Real, Sum};
use crate::grid::lattice::Point;

/// Longest distance of a falloff: in keys it has 32 bits. It is 32 times as long as a side of the
/// lattice, across which a hit would let `1 / 32` pass.
pub const FAR_MAX: u32 = u32::MAX / KEYS_PER_STEP.unsigned_abs();

/// Bits of the weight of a direction straight ahead.
pub const WEIGHT_BITS: u32 = 19;

/// Whether something near counts for more than something far (paper sections 3.3 and 5.1).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Falloff {
    /// Ambient occlusion: whatever is hit blocks, however far.
    None,
    /// Ambient obscurance: a hit at a distance lets `(distance / most)^power` pass, and all of
    /// it from `most` on, in steps of the lattice; power 0 is occlusion up to `most`.
    Distance {
        /// From which on nothing blocks, 1 to [`FAR_MAX`].
        most: u32,
        /// 0 to 8.
        power: u32,
    },
}

/// What of a point's directions is open.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Open {
    /// The sum of the weights of directions that nothing blocks.
    pub whole: u32,
    /// The sum of the weights that what blocks lets pass.
    pub part: Bounded,
}

/// The weight of a map for a surface with this coarse normal: the cosine between them with
/// [`WEIGHT_BITS`] bits, rounded down, negative if the surface faces away from the map's viewer.
/// At most 2^19 + 55 in size, as both vectors may be `sqrt(3) / 2` longer than 2^14; so
/// [`super::DIRECTIONS_MAX`] of them fit in 32 bits, whatever frames they are of.
pub fn weight(map: &Map, normal: Point) -> i32 {
    let cosine = dot(map.planes[2], normal);
    cosine.signum() * (cosine.abs() >> (2 * super::PLANE_BITS - WEIGHT_BITS))
}

/// Stage `occlusion` (paper equations 2 and 3): over all maps, whichever of both directions is
/// on the surface's side, weighted by its cosine; parts are added in any order.
pub fn occlusion<'a>(
    hits: impl Iterator<Item = (&'a Map, Hits)>,
    normal: Point,
    falloff: Falloff,
) -> Open {
    let (mut whole, mut part) = (0, Sum::default());
    for (map, hits) in hits {
        let weight = weight(map, normal);
        match (seen(&hits, weight), falloff) {
            (None, _) => whole += weight.unsigned_abs(),
            (Some(_), Falloff::None) => {}
            (Some(key), Falloff::Distance { most, power }) => {
                let keys = i64::from(key) - i64::from(hits.key);
                let most = u64::from(most) * u64::from(KEYS_PER_STEP.unsigned_abs());
                if keys.unsigned_abs() >= most {
                    whole += weight.unsigned_abs();
                } else if power > 0 {
                    let passed = passed(keys.unsigned_abs(), most, power);
                    let weight = Bounded::exact(f64::from(weight.unsigned_abs()));
                    part.add(weight.mul(passed));
                }
            }
        }
    }
    Open {
        whole,
        part: part.finish(),
    }
}

/// What is hit on the surface's side.
pub(super) fn seen(hits: &Hits, weight: i32) -> Option<u32> {
    match weight >= 0 {
        true => hits.before,
        false => hits.behind,
    }
}

/// `(keys / most)^power` as a kernel has it: a quotient, and products one after another.
fn passed(keys: u64, most: u64, power: u32) -> Bounded {
    let [keys, most] = [keys, most].map(|n| Bounded::once(n as f64));
    let part = keys.div(most);
    (1..power).fold(part, |all, _| all.mul(part))
}

/// The part that is open, 1 for all of it: equation 2 with `directions` maps.
pub fn openness(open: &Open, directions: u32) -> Bounded {
    let whole = Bounded::once(f64::from(open.whole));
    let scale = libm::scalbn(2.0 / f64::from(directions), -WEIGHT_BITS.cast_signed());
    whole.add(open.part).mul(Bounded::once(scale))
}
