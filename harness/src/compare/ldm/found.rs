//! Stages `neighbours`, `occlusion`, `environment` and `mirror`: what receivers find, and its sums.

use triptych_spec::ldm::{Hits, Mirrored, Open};
use triptych_spec::rsm::Colour;

use super::listed;
use crate::cause::Cause;
use crate::compare::{Judgement, rsm};
use crate::row::Class;

/// Stage `neighbours`: a receiver's own key, and the keys before and behind its own layers, are
/// the spec's. Of each receiver come `maps` answers, the first of which is of map `first`;
/// `pixels` are where receivers are in the picture.
pub fn neighbours(
    pixels: &[u32],
    (first, maps): (usize, usize),
    spec: &[Hits],
    seen: &[Hits],
) -> Judgement {
    let expected = pixels.len() * maps;
    let mut judgement = listed(Class::Exact, "traces", expected, seen.len());
    if spec.len() != expected {
        judgement.differs(Cause::ReferenceMissing, None, || {
            format!("{} traces of the spec, must be {expected}", spec.len())
        });
    }
    for (at, (must, is)) in spec.iter().zip(seen).enumerate() {
        if must != is {
            let (receiver, map) = (at / maps, at % maps);
            let pixel = pixels.get(receiver).copied();
            let cause = match must.key == is.key {
                true => Cause::Coverage,
                false => Cause::DepthKey,
            };
            judgement.differs(cause, pixel, || {
                let map = first + map;
                format!("receiver {receiver} in map {map} finds {is:?}, must find {must:?}")
            });
        }
    }
    judgement
}

/// Stage `occlusion`: what is open as a whole is the spec's; what partly blocks lets pass as much,
/// within its bound. A part without a finite bound is counted, not judged.
pub fn open(pixels: &[u32], spec: &[Open], seen: &[(u32, f32)]) -> Judgement {
    let mut judgement = listed(Class::Interval, "receivers", spec.len(), seen.len());
    let (mut error, mut ratio) = (0.0_f64, 0.0_f64);
    for (at, (must, (whole, part))) in spec.iter().zip(seen).enumerate() {
        let pixel = pixels.get(at).copied();
        if must.whole != *whole {
            judgement.differs(Cause::Coverage, pixel, || {
                format!("{whole} is open over receiver {at}, must be {}", must.whole)
            });
            continue;
        }
        if !must.part.bound.is_finite() {
            judgement.admitted += 1;
            continue;
        }
        let part = f64::from(*part);
        if !must.part.admits(part) {
            judgement.differs(Cause::Interval, pixel, || {
                let (value, bound) = (must.part.value, must.part.bound);
                format!("{part:e} passes to receiver {at}, must be {value:e} within {bound:e}")
            });
            continue;
        }
        let off = (part - must.part.value).abs();
        if off > 0.0 {
            (error, ratio) = (error.max(off), ratio.max(off / must.part.bound));
        }
    }
    judgement.error = Some(error);
    judgement.error_over_bound = Some(ratio);
    if judgement.admitted > 0 {
        judgement.admitted_budget = Some(0.0);
        judgement.note = format!("{} parts may be beyond f32", judgement.admitted);
    }
    judgement
}

/// Stage `environment`: light within its bounds.
pub fn light(pixels: &[u32], spec: &[Colour], seen: &[[f32; 3]]) -> Judgement {
    rsm::colours("receivers", spec, seen, |at| pixels.get(at).copied())
}

/// Stage `mirror`: the map, its side, what is found there and the light of it are the spec's, light
/// to the bit.
pub fn mirrored(pixels: &[u32], spec: &[Mirrored], seen: &[Mirrored]) -> Judgement {
    let mut judgement = listed(Class::Exact, "receivers", spec.len(), seen.len());
    let bits = |one: &Mirrored| one.light.map(f32::to_bits);
    for (at, (must, is)) in spec.iter().zip(seen).enumerate() {
        if must == is && bits(must) == bits(is) {
            continue;
        }
        let same_way = (must.map, must.opposite) == (is.map, is.opposite);
        // A direction and a radiance have no bound but their own value.
        let cause = match (same_way, must.key == is.key, must.hit == is.hit) {
            (true, false, _) => Cause::DepthKey,
            (true, true, false) => Cause::Coverage,
            _ => Cause::Interval,
        };
        judgement.differs(cause, pixels.get(at).copied(), || {
            format!("receiver {at} mirrors {is:?}, must mirror {must:?}")
        });
    }
    judgement
}
