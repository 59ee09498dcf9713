//! What of a replay people look at.

use triptych_spec::abuffer::NOTHING;
use triptych_spec::scene::Size;

use super::spec::SpecRun;
use crate::cause::Cause;
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

/// Which pixels differ, and why; `None` if none does.
pub fn causes(spec: Option<&Observed<Spec, SpecRun>>, marks: &[(u32, Cause)]) -> Option<Picture> {
    let spec = &spec.filter(|_| !marks.is_empty())?.value;
    let marks = marks.iter().map(|(pixel, cause)| (*pixel, Some(*cause)));
    Some(Picture {
        title: "causes".into(),
        caption: "Pixels that differ in any leg, over the spec's picture.".into(),
        image: picture::causes(spec.primitives.size, Some(&spec.picture()), marks),
    })
}

/// Layers per pixel: transparent ones, and one for an opaque surface.
fn layers(spec: &SpecRun) -> Vec<u32> {
    let lists = spec.sorted.offsets.windows(2).map(|w| w[1] - w[0]);
    let opaque = spec.opaque.prim.iter().map(|p| u32::from(*p != NOTHING));
    lists
        .zip(opaque)
        .map(|(list, opaque)| list + opaque)
        .collect()
}
