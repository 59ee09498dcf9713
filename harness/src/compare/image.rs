//! Stage `resolve`: pictures, inside the spec's own bound.

use triptych_spec::bound::Bounded;

use crate::cause::Cause;
use crate::compare::Judgement;
use crate::compare::fragments::at;
use crate::row::Class;

/// Compares every channel of every pixel with the interval that the spec admits
/// for it. The lists behind the pixels are equal, so what differs is rounding.
pub fn compare(spec: &[[Bounded; 3]], other: &[[f32; 3]], width: u32) -> Judgement {
    let mut judgement = Judgement::new(Class::Interval, "channels");
    if spec.len() != other.len() {
        judgement.differs(Cause::ReferenceMissing, None, || {
            format!("{} pixels, must be {}", other.len(), spec.len())
        });
        return judgement;
    }
    let (mut largest, mut worst) = (0.0_f64, 0.0_f64);
    for (pixel, (must, seen)) in (0_u32..).zip(spec.iter().zip(other)) {
        judgement.compared += 3;
        let channel = |c: usize| (must[c], f64::from(seen[c]));
        for (must, seen) in (0..3).map(channel) {
            let error = (seen - must.value).abs();
            if must.bound > 0.0 && error > 0.0 {
                largest = largest.max(error);
                worst = worst.max(error / must.bound);
            }
            if !must.admits(seen) {
                judgement.differs(Cause::BlendRounding, Some(pixel), || {
                    let Bounded { value, bound } = must;
                    format!(
                        "{} is {seen}, must be {value} within {bound:e}",
                        at(pixel, width)
                    )
                });
            }
        }
    }
    judgement.error = Some(largest);
    judgement.error_over_bound = Some(worst);
    judgement
}

#[cfg(test)]
mod tests;
