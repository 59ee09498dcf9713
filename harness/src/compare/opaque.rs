//! Stage `opaque`: the nearest opaque surface of every pixel.

use triptych_spec::abuffer::{NOTHING, Opaque};

use crate::cause::Cause;
use crate::compare::Judgement;
use crate::compare::fragments::at;
use crate::row::Class;

/// Compares key and triangle of every pixel.
///
/// Another triangle with the same key is a broken tie; the same triangle with
/// another key a wrong key; anything else is a surface that covers a pixel which it
/// must not, or the other way round.
pub fn compare(spec: &Opaque, other: &Opaque, width: u32) -> Judgement {
    let mut judgement = Judgement::new(Class::Exact, "pixels");
    if other.key.len() != spec.key.len() || other.prim.len() != spec.prim.len() {
        judgement.differs(Cause::ReferenceMissing, None, || {
            format!("{} pixels, must be {}", other.key.len(), spec.key.len())
        });
        return judgement;
    }
    let spec = spec.key.iter().zip(&spec.prim);
    let other = other.key.iter().zip(&other.prim);
    for (pixel, ((key, prim), (seen_key, seen_prim))) in (0_u32..).zip(spec.zip(other)) {
        judgement.compared += 1;
        let cause = match (key == seen_key, prim == seen_prim) {
            (true, true) => continue,
            (true, false) => Cause::TieOrder,
            (false, true) => Cause::DepthKey,
            (false, false) => Cause::Coverage,
        };
        judgement.differs(cause, Some(pixel), || {
            let (seen, must) = (surface(*seen_key, *seen_prim), surface(*key, *prim));
            format!("{} shows {seen}, must show {must}", at(pixel, width))
        });
    }
    judgement
}

fn surface(key: u32, prim: u32) -> String {
    match prim {
        NOTHING => "nothing".into(),
        prim => format!("triangle row {prim} at key {key}"),
    }
}
