//! What of a replay people look at.

use triptych_spec::abuffer::NOTHING;
use triptych_spec::scene::Size;

use super::rows::Spot;
use super::spec::SpecRun;
use crate::observe::{Observed, Spec};
use crate::picture;
use crate::report::Picture;

/// A leg's picture.
pub fn leg(label: &str, size: Size, pixels: &[[f32; 3]]) -> Picture {
    Picture {
        title: label.into(),
        caption: "What this leg makes of the scene.".into(),
        image: picture::linear(size, pixels),
    }
}

/// The spec's picture, and how many layers it found.
pub fn spec(spec: &SpecRun) -> [Picture; 2] {
    let size = spec.primitives.size;
    let layers = Picture {
        title: "layers".into(),
        caption: "Fragments per pixel by the spec: those in lists, and one for an opaque surface."
            .into(),
        image: picture::counts(size, &layers(spec)),
    };
    [leg("spec", size, &spec.picture()), layers]
}

/// Smallest distance of colours that is worth a picture: half a step of eight bits. It
/// decides what is shown, and judges nothing.
const VISIBLE: f32 = 1.0 / 512.0;

/// How far a leg's picture is from the spec's on the same grid; `None` if nobody could
/// see it.
pub fn difference(label: &str, size: Size, spec: &[[f32; 3]], leg: &[[f32; 3]]) -> Option<Picture> {
    let near = |(a, b): (&f32, &f32)| (a - b).abs() < VISIBLE || a.to_bits() == b.to_bits();
    let alike = |(a, b): (&[f32; 3], &[f32; 3])| a.iter().zip(b).all(near);
    if spec.len() != leg.len() || spec.iter().zip(leg).all(alike) {
        return None;
    }
    Some(Picture {
        title: format!("difference of {label}"),
        caption: "Largest difference of a component from the spec's picture.".into(),
        image: picture::difference(size, spec, leg),
    })
}

/// Which pixels differ, and why; `None` if none does.
pub fn causes(spec: Option<&Observed<Spec, SpecRun>>, spots: &[Spot]) -> Option<Picture> {
    let spec = &spec.filter(|_| !spots.is_empty())?.value;
    let marks = spots.iter().map(|spot| (spot.pixel, Some(spot.cause)));
    Some(Picture {
        title: "causes".into(),
        caption: "Pixels that differ in any leg, over the spec's picture.".into(),
        image: picture::causes(spec.primitives.size, Some(&spec.picture()), marks),
    })
}

/// Layers per pixel: transparent ones, and one for an opaque surface.
fn layers(spec: &SpecRun) -> Vec<u32> {
    let samples = spec.primitives.samples.count() as usize;
    let surfaces = spec.opaque.prim.chunks(samples);
    let opaque = surfaces.map(|prims| u32::from(prims.iter().any(|p| *p != NOTHING)));
    let lists = spec.sorted.lengths();
    lists
        .zip(opaque)
        .map(|(list, opaque)| list + opaque)
        .collect()
}
