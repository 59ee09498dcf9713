//! The pairs of a point and a texel that give light, as the spec's stages have them.

use triptych_spec::grid::ray::Ray;
use triptych_spec::rsm::{Frame, Light, Setting, fine, term, texels};

/// A texel that gives light to a pixel unless something is between them.
pub(super) struct Pair {
    /// What it gives: irradiance.
    pub(super) light: [f64; 3],
    /// From the pixel's point to the texel's.
    pub(super) ray: Ray,
}

/// The texels that light a pixel of the picture.
pub(super) fn pairs<'f>(
    setting: &'f Setting<'_>,
    frame: &'f Frame,
    lights: &'f [Option<Light>],
    pixel: usize,
) -> impl Iterator<Item = Pair> + 'f {
    let seen = frame.seen.surfaces[pixel].zip(frame.places[pixel]);
    let parameters = &setting.parameters;
    let of_pixel =
        move |(surface, place): (triptych_spec::rsm::Surface, triptych_spec::rsm::Place)| {
            let all = texels(parameters, place.texel, frame.rsm.seen.size);
            all.filter_map(move |(_, texel)| {
                let light = lights[texel].as_ref()?;
                let term = term(setting.model, &surface, light, parameters.clamp)?;
                Some(Pair {
                    light: term.map(|channel| channel.value),
                    ray: Ray::between(surface.point, light.surface.point),
                })
            })
        };
    seen.into_iter().flat_map(of_pixel)
}

/// The pixel of the picture that a pixel of buffer B is.
pub(super) fn of_coarse(setting: &Setting<'_>, frame: &Frame, pixel: usize) -> usize {
    let divisor = setting.parameters.divisor;
    fine(pixel, frame.coarse.size, frame.seen.size, divisor)
}
