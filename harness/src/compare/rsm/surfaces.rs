//! Which triangle is seen, and, of stages `gbuffer` and `rsm`, which point of it.

use triptych_spec::abuffer::NOTHING;
use triptych_spec::rsm::{Gbuffer, Surface};

use super::{listed, number};
use crate::cause::Cause;
use crate::compare::Judgement;
use crate::row::Class;

/// Every pixel of a view sees the same triangle at the same key. Another triangle at the same key
/// is a broken tie, the same one at another key a wrong key.
pub fn visible(unit: &'static str, spec: &Gbuffer, keys: &[u32], triangles: &[u32]) -> Judgement {
    let lengths = keys.len().min(triangles.len());
    let mut judgement = listed(Class::Exact, unit, spec.keys.len(), lengths);
    let seen = keys.iter().zip(triangles);
    let expected = spec.keys.iter().zip(&spec.surfaces);
    for (at, ((key, surface), (seen_key, seen))) in expected.zip(seen).enumerate() {
        let triangle = surface.map_or(NOTHING, |surface| surface.triangle);
        let cause = match (key == seen_key, triangle == *seen) {
            (true, true) => continue,
            (true, false) => Cause::TieOrder,
            (false, true) => Cause::DepthKey,
            (false, false) => Cause::Coverage,
        };
        judgement.differs(cause, None, || {
            format!(
                "number {at} of the {unit} sees triangle {seen} at key {seen_key}, must see \
                 {triangle} at {key}"
            )
        });
    }
    judgement
}

/// Triangle and side are exact; a point is no farther along an axis from the spec's than that
/// lets it stray. Errors are in steps of the lattice.
pub fn surfaces(spec: &Gbuffer, seen: &[Option<Surface>]) -> Judgement {
    let expected = &spec.surfaces;
    let mut judgement = listed(Class::Interval, "pixels", expected.len(), seen.len());
    let (mut error, mut ratio) = (0.0_f64, 0.0_f64);
    for (at, (expected, seen)) in expected.iter().zip(seen).enumerate() {
        let faces = [expected, seen].map(|s| s.map(|s| (s.triangle, s.side)));
        if faces[0] != faces[1] {
            judgement.differs(Cause::Coverage, Some(number(at)), || {
                format!("pixel {at} sees {:?}, must see {:?}", faces[1], faces[0])
            });
            continue;
        }
        let (Some(expected), Some(seen)) = (expected, seen) else {
            continue;
        };
        let apart = [0, 1, 2].map(|axis| expected.point[axis].abs_diff(seen.point[axis]));
        let stray = spec.stray[at];
        if (0..3).any(|axis| apart[axis] > stray[axis]) {
            judgement.differs(Cause::Interval, Some(number(at)), || {
                format!(
                    "pixel {at} sees {:?}, must see {:?} or as far from it as {stray:?}",
                    seen.point, expected.point
                )
            });
            continue;
        }
        for axis in (0..3).filter(|axis| apart[*axis] > 0) {
            let (off, bound) = (f64::from(apart[axis]), f64::from(stray[axis]));
            (error, ratio) = (error.max(off), ratio.max(off / bound));
        }
    }
    judgement.error = Some(error);
    judgement.error_over_bound = Some(ratio);
    judgement
}
