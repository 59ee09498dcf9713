//! Stage `mirror`: what a glossy surface reflects, in the nearest direction that there is.

use super::neighbours::dot;
use super::occlusion::{seen, weight};
use super::{Hits, Map, PLANE_BITS, Sky};
use crate::grid::lattice::Point;

/// What a point mirrors.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Mirrored {
    /// Number of the map whose direction, or its opposite, is nearest to the mirror direction;
    /// `None` if there is no such direction, and the rest is zeros.
    pub map: Option<u32>,
    /// Whether it is the opposite of the map's direction.
    pub opposite: bool,
    /// The point's own key in that map.
    pub key: i32,
    /// The nearest key in that direction, beyond the point's own band.
    pub hit: Option<u32>,
    /// Radiance of the sky from there; 0 if anything is hit, as maps have no colours.
    pub light: [f32; 3],
}

/// The unit vector along another, at length 2^[`PLANE_BITS`]: made once, and given to every leg.
/// Zero of zero. Components are differences of lattice points, below 2^25.
pub fn view(towards: Point) -> Point {
    let squares = towards.iter().map(|c| i64::from(*c) * i64::from(*c));
    // Exact: below 2^52.
    let length = (squares.sum::<i64>() as f64).sqrt();
    if length == 0.0 {
        return [0; 3];
    }
    let steps = f64::from(1_u32 << PLANE_BITS);
    #[expect(clippy::cast_possible_truncation, reason = "integers of 15 bits")]
    towards.map(|c| libm::floor(f64::from(c) * steps / length + 0.5) as i32)
}

/// How near the direction in which a surface looks through a map is to its mirror direction, in
/// units that are the same for all maps; `None` if the surface looks through it in neither.
///
/// With `n` the normal, `v` the vector to the eye and `d` the map's, the mirror vector is
/// `r = 2 (n . v) n / (n . n) - v`. It is as long as `v`, so that of directions of one length the
/// nearest is that of the largest `r . d`. Times `n . n`, which is positive, that is an integer:
/// `2 (n . v) (n . d) - (n . n) (v . d)`. Each dot product is at most `(2^14 + 1)^2 < 2^28.001`, so
/// the first product is below 2^57.01, and the difference below 2^57.6.
///
/// `d` is rounded, by up to `e = sqrt(3) / 2 / 2^14` of its length: two directions whose cosines
/// with `r` differ by less than `2 e` may be taken for each other.
pub fn nearness(map: &Map, normal: Point, view: Point) -> Option<i64> {
    let weight = weight(map, normal);
    if weight == 0 {
        return None;
    }
    let direction = map.planes[2];
    let of = |a: Point, b: Point| i64::from(dot(a, b));
    let along =
        2 * of(normal, view) * of(normal, direction) - of(normal, normal) * of(view, direction);
    Some(i64::from(weight.signum()) * along)
}

/// Stage `mirror` (paper section 6, beyond Lambertian surfaces): of the directions in which a
/// surface looks through maps, the nearest to its mirror direction; of equals the first; and what is
/// seen there. `maps` are all of a set, in order.
///
/// A map serves the one of its two directions that is on the surface's side, as in all other sums:
/// whatever is nearest below the surface cannot be seen from it. Maps at right angles to the
/// surface, in which it has no weight, have none. So what is found does not depend on maps that
/// nobody needs. No map is found by a point on no surface, and by one in the eye.
pub fn mirror<'a>(
    maps: impl Iterator<Item = (&'a Map, Hits, &'a Sky)>,
    normal: Point,
    view: Point,
) -> Mirrored {
    let mut best = i64::MIN;
    let mut found = Mirrored::default();
    if view == [0; 3] {
        return found;
    }
    for (number, (map, hits, sky)) in (0..).zip(maps) {
        let Some(near) = nearness(map, normal, view).filter(|near| *near > best) else {
            continue;
        };
        best = near;
        let weight = weight(map, normal);
        let (hit, opposite) = (seen(&hits, weight), weight < 0);
        found = Mirrored {
            map: Some(number),
            opposite,
            key: hits.key,
            hit,
            light: match hit {
                None => sky[usize::from(opposite)],
                Some(_) => [0.0; 3],
            },
        };
    }
    found
}
