//! Stage `block`: which rays are asked for, and what blocks them.

use triptych_spec::rsm::Blocked;

use super::listed;
use crate::cause::Cause;
use crate::compare::Judgement;
use crate::row::Class;

/// The same number of rays, and the same texels of each pixel's kernel blocked. A pixel that
/// differs is counted once; `place` is which pixel of the picture it is.
pub fn blocked(
    spec: &Blocked,
    (bits, rays): (&[u32], u64),
    place: impl Fn(usize) -> u32,
) -> Judgement {
    let mut judgement = listed(Class::Exact, "words of bits", spec.bits.len(), bits.len());
    if rays != spec.rays {
        judgement.differs(Cause::Coverage, None, || {
            format!("{rays} rays are asked for, must be {}", spec.rays)
        });
    }
    let words = spec.bits.len() / spec.size.pixels();
    let pixels = spec.bits.chunks(words).zip(bits.chunks(words));
    for (at, (spec, seen)) in pixels.enumerate() {
        if spec != seen {
            judgement.differs(Cause::Coverage, Some(place(at)), || {
                let differ = spec.iter().zip(seen).map(|(a, b)| (a ^ b).count_ones());
                let differ: u32 = differ.sum();
                format!("pixel {at} of buffer B has {differ} texels wrong")
            });
        }
    }
    judgement.note = format!("{} rays", spec.rays);
    judgement
}
