//! Stage `place`: texels and keys.

use triptych_spec::bound::{Bounded, Real};
use triptych_spec::rsm::{PLACE_MAX, Place, Surface, View, project};
use triptych_spec::vertex::{DEPTH_ONE, viewport};

use super::{listed, number};
use crate::cause::Cause;
use crate::compare::Judgement;
use crate::row::Class;

/// A decision: a texel is the spec's, or the floor of a number within the bound of [`project`],
/// which is counted as admitted. A key is within the bound, too; its errors are in keys. Where
/// even the sign of `w` is within its bound, a point may lie anywhere, or nowhere: that is
/// counted as admitted, too.
pub fn places(
    light: &View,
    surfaces: &[Option<Surface>],
    spec: &[Option<Place>],
    seen: &[Option<Place>],
) -> Judgement {
    let mut judgement = listed(Class::Decision, "pixels", spec.len(), seen.len());
    let (mut error, mut ratio) = (0.0_f64, 0.0_f64);
    for (at, ((spec, seen), surface)) in spec.iter().zip(seen).zip(surfaces).enumerate() {
        if spec == seen {
            continue;
        }
        let may = surface.and_then(|surface| may(light, surface.point, seen.as_ref()));
        let Some(bound) = may else {
            judgement.differs(Cause::Coverage, Some(number(at)), || {
                format!("pixel {at} lies at {seen:?} of the map, must at {spec:?}")
            });
            continue;
        };
        if bound.is_infinite() {
            judgement.admitted += 1;
            continue;
        }
        judgement.admitted += u64::from(spec.map(|p| p.texel) != seen.map(|p| p.texel));
        if let (Some(spec), Some(seen)) = (spec, seen) {
            let off = f64::from(spec.key.abs_diff(seen.key));
            (error, ratio) = (error.max(off), ratio.max(off / bound));
        }
    }
    judgement.error = Some(error);
    judgement.error_over_bound = Some(ratio);
    judgement.note = "errors in keys".to_owned();
    judgement
}

/// How far a point's key may be off; `None` if a kernel may not place it so.
fn may(light: &View, point: [i32; 3], seen: Option<&Place>) -> Option<f64> {
    // Whether a point is before a perspective hangs on its w.
    let row = viewport(light.size).times(&light.matrix).rows[3];
    let [x, y, z] = point.map(f64::from);
    let w = Bounded::sum_of_products(row, [x, y, z, 1.0]);
    if !w.sign_is_certain() {
        return Some(f64::INFINITY);
    }
    let numbers = project::<Bounded>(light, point)?;
    let seen = seen?;
    let edge = [-PLACE_MAX, PLACE_MAX];
    let ranges = [edge, edge, [0, DEPTH_ONE]].map(|range| range.map(f64::from));
    let [column, row] = seen.texel.map(f64::from);
    let integers = [column, row, f64::from(seen.key)];
    let within = |i: usize| {
        let floor = |c: f64| libm::floor(c).clamp(ranges[i][0], ranges[i][1]);
        let Bounded { value, bound } = numbers[i];
        (floor(value - bound)..=floor(value + bound)).contains(&integers[i])
    };
    // Numbers that far apart may have floors one farther apart.
    (0..3).all(within).then_some(numbers[2].bound + 1.0)
}
