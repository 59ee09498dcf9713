//! Stage `opaque`: the nearest opaque surface at every sample of every pixel.

use triptych_spec::abuffer::{NOTHING, Opaque};
use triptych_spec::raster::Setup;
use triptych_spec::vertex::Primitives;

use crate::cause::Cause;
use crate::compare::Judgement;
use crate::compare::fragments::at;
use crate::row::Class;

/// Compares key and triangle at every sample.
///
/// Another triangle with the same key is a broken tie. A triangle with another key
/// than the spec gives it there is a wrong key; with the same key, it shows through
/// because a nearer one is not there, which is coverage, as is a triangle that must
/// not be there at all.
pub fn compare(spec: &Opaque, other: &Opaque, primitives: &Primitives) -> Judgement {
    let width = primitives.size.width;
    let samples = primitives.samples.count();
    let unit = if samples == 1 { "pixels" } else { "samples" };
    let mut judgement = Judgement::new(Class::Exact, unit);
    if other.key.len() != spec.key.len() || other.prim.len() != spec.prim.len() {
        judgement.differs(Cause::ReferenceMissing, None, || {
            format!("{} {unit}, must be {}", other.key.len(), spec.key.len())
        });
        return judgement;
    }
    let spec = spec.key.iter().zip(&spec.prim);
    let other = other.key.iter().zip(&other.prim);
    for (place, ((key, prim), (seen_key, seen_prim))) in (0_u32..).zip(spec.zip(other)) {
        judgement.compared += 1;
        if (key, prim) == (seen_key, seen_prim) {
            continue;
        }
        let (pixel, s) = (place / samples, place % samples);
        let cause = match key_at(primitives, *seen_prim, pixel, s) {
            Some(must) if must != *seen_key => Cause::DepthKey,
            Some(_) if key == seen_key => Cause::TieOrder,
            _ => Cause::Coverage,
        };
        judgement.differs(cause, Some(pixel), || {
            let (seen, must) = (surface(*seen_key, *seen_prim), surface(*key, *prim));
            let of = match samples {
                1 => String::new(),
                _ => format!(" sample {s}"),
            };
            format!("{}{of} shows {seen}, must show {must}", at(pixel, width))
        });
    }
    judgement
}

/// The spec's key of a triangle at a sample of a pixel, if it covers that.
fn key_at(primitives: &Primitives, prim: u32, pixel: u32, s: u32) -> Option<u32> {
    let known = (prim as usize) < primitives.prims.len();
    let setup = known.then(|| Setup::new(primitives, prim)).flatten()?;
    setup.key_at(primitives, pixel, s)
}

fn surface(key: u32, prim: u32) -> String {
    match prim {
        NOTHING => "nothing".into(),
        prim => format!("triangle row {prim} at key {key}"),
    }
}

#[cfg(test)]
mod tests;
