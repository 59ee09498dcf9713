//! Stage `gather`: buffer A.

use super::kernel::texels;
use super::sum::Sum;
use super::{Colour, DARK, Gbuffer, Light, Model, Parameters, Place, term};
use crate::scene::Size;

/// Stage `gather`: the irradiance of each pixel by all texels of the kernel around its
/// place in the map, as if nothing were between them.
///
/// Texels that see nothing, and those that do not face the pixel's point or are not faced
/// by it, give nothing, by decision on integers. `size` is that of the map.
pub fn gather(
    model: &Model,
    seen: &Gbuffer,
    places: &[Option<Place>],
    lights: &[Option<Light>],
    size: Size,
    parameters: &Parameters,
) -> Vec<Colour> {
    let pixel = |pixel: usize| {
        let (Some(surface), Some(place)) = (&seen.surfaces[pixel], &places[pixel]) else {
            return DARK;
        };
        let mut sum = Sum::default();
        for (_, texel) in texels(parameters, place.texel, size) {
            let light = lights[texel].as_ref();
            if let Some(term) = light.and_then(|l| term(model, surface, l, parameters.clamp)) {
                sum.add(&term);
            }
        }
        sum.finish()
    };
    (0..seen.surfaces.len()).map(pixel).collect()
}
