//! Stage `environment`: light from all around, as far as nothing blocks it.

use super::occlusion::{seen, weight};
use super::{Hits, Map, WEIGHT_BITS};
use crate::bound::{Bounded, Real, Sum};
use crate::grid::lattice::Point;

/// Radiance from a map's direction, and from the opposite one.
pub type Sky = [[f32; 3]; 2];

/// Stage `environment` (paper section 5.2, Figure 11): irradiance over pi, the sum over all
/// directions that nothing blocks of radiance times cosine, times 2 / N. A sky of 1 gives the
/// part that is open. Terms are added in any order.
pub fn environment<'a>(
    hits: impl Iterator<Item = (&'a Map, Hits, &'a Sky)>,
    normal: Point,
    directions: u32,
) -> [Bounded; 3] {
    let mut light = [Sum::default(); 3];
    for (map, hits, sky) in hits {
        let weight = weight(map, normal);
        if weight == 0 || seen(&hits, weight).is_some() {
            continue;
        }
        let radiance = sky[usize::from(weight < 0)];
        let weight = Bounded::exact(f64::from(weight.unsigned_abs()));
        for (sum, radiance) in light.iter_mut().zip(radiance) {
            sum.add(weight.mul(Bounded::exact(f64::from(radiance))));
        }
    }
    let scale = libm::scalbn(2.0 / f64::from(directions), -WEIGHT_BITS.cast_signed());
    light.map(|sum| sum.finish().mul(Bounded::once(scale)))
}
