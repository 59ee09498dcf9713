//! Colours, and which pixels have any.

use triptych_spec::rsm::Colour;

use super::{listed, number};
use crate::cause::Cause;
use crate::compare::Judgement;
use crate::row::Class;

/// Stage `direct`: the light reaches the same pixels.
pub fn lit(spec: &[bool], seen: &[bool]) -> Judgement {
    let mut judgement = listed(Class::Exact, "pixels", spec.len(), seen.len());
    for (at, (spec, seen)) in spec.iter().zip(seen).enumerate() {
        if spec != seen {
            judgement.differs(Cause::Coverage, Some(number(at)), || {
                format!("pixel {at} is lit: {seen}, must be: {spec}")
            });
        }
    }
    let reached = spec.iter().filter(|lit| **lit).count();
    judgement.note = format!("which are lit: {reached}");
    judgement
}

/// Colours within their bounds. `place` is where an item stands in a picture, if it does. What
/// `f32` may not hold has no bound: it is counted, not judged, and a row has none of it to pass.
pub fn colours(
    unit: &'static str,
    spec: &[Colour],
    seen: &[[f32; 3]],
    place: impl Fn(usize) -> Option<u32>,
) -> Judgement {
    let mut judgement = listed(Class::Interval, unit, spec.len(), seen.len());
    let (mut error, mut ratio) = (0.0_f64, 0.0_f64);
    for (at, (spec, seen)) in spec.iter().zip(seen).enumerate() {
        if spec.iter().any(|channel| !channel.bound.is_finite()) {
            judgement.admitted += 1;
            continue;
        }
        let wrong = (0..3).find(|i| !spec[*i].admits(f64::from(seen[*i])));
        if let Some(channel) = wrong {
            judgement.differs(Cause::Interval, place(at), || {
                let (must, is) = (spec[channel], seen[channel]);
                format!(
                    "number {at} of the {unit} is {is:e} in channel {channel}, must be {:e} \
                     within {:e}",
                    must.value, must.bound
                )
            });
            continue;
        }
        for (must, is) in spec.iter().zip(seen) {
            let off = (f64::from(*is) - must.value).abs();
            if off > 0.0 {
                (error, ratio) = (error.max(off), ratio.max(off / must.bound));
            }
        }
    }
    judgement.error = Some(error);
    judgement.error_over_bound = Some(ratio);
    if judgement.admitted > 0 {
        judgement.admitted_budget = Some(0.0);
        judgement.note = format!("{} {unit} may be beyond f32", judgement.admitted);
    }
    judgement
}
