//! Stage `direct`: the light's own light, with its shadow map.

use super::kernel::{projected, squared};
use super::{Colour, DARK, Gbuffer, Lamp, Model, Parameters, Place, Surface, Viewpoint};
use crate::bound::{Bounded, Real};
use crate::scene::Size;

/// Direct light of each pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct Direct {
    /// Whether the light reaches it.
    pub lit: Vec<bool>,
    /// Irradiance; [`DARK`] where it is not lit.
    pub light: Vec<Colour>,
}

/// Stage `direct`: the light that comes straight from the lamp, and whether it does.
///
/// A point is lit if it faces the light, lies in its map, and if its key exceeds that of
/// the map's texel by [`Parameters::bias`] at most; a texel that sees nothing shades
/// nothing. All are integers. Irradiance is `strength n . l`; from a spot light, with `d`
/// to the light, `strength (n . d / |d|) (reference / |d|)^2`, and `1 / |d|` by
/// `inverseSqrt`.
pub fn direct(
    model: &Model,
    seen: &Gbuffer,
    places: &[Option<Place>],
    lamp: &Lamp,
    map: &[u32],
    parameters: &Parameters,
) -> Direct {
    let mut direct = Direct {
        lit: vec![false; places.len()],
        light: vec![DARK; places.len()],
    };
    for (pixel, (surface, place)) in seen.surfaces.iter().zip(places).enumerate() {
        let (Some(surface), Some(place)) = (surface, place) else {
            continue;
        };
        let reached = reached(*place, lamp.view.size, map, parameters.bias);
        if reached && towards(model, surface, lamp) {
            direct.lit[pixel] = true;
            direct.light[pixel] = irradiance(model, surface, lamp);
        }
    }
    direct
}

/// The traditional shadow test; `map` holds keys, [`crate::abuffer::NOTHING`] among them.
fn reached(place: Place, size: Size, map: &[u32], bias: u32) -> bool {
    let [Ok(x), Ok(y)] = place.texel.map(u32::try_from) else {
        return false;
    };
    if x >= size.width || y >= size.height {
        return false;
    }
    let nearest = map[(y * size.width + x) as usize];
    // NOTHING is farther than every key.
    u64::from(place.key) <= u64::from(nearest) + u64::from(bias)
}

/// Whether the side that is seen faces the light, exactly.
fn towards(model: &Model, surface: &Surface, lamp: &Lamp) -> bool {
    let way = lamp.view.viewpoint.from(surface.point);
    model.face(surface.triangle).along(way).signum() == i128::from(surface.side)
}

fn irradiance(model: &Model, surface: &Surface, lamp: &Lamp) -> Colour {
    let way = lamp.view.viewpoint.from(surface.point);
    let along = projected(model, surface, way);
    // At least 1, for a surface that is at the light is not turned to it.
    let inverse = squared(way, 1).inverse_sqrt();
    let cosine = along.mul(inverse);
    let factor = match lamp.view.viewpoint {
        Viewpoint::Far(_) => cosine,
        Viewpoint::Near(_) => {
            let ratio = Bounded::exact(f64::from(lamp.reference)).mul(inverse);
            cosine.mul(ratio.mul(ratio))
        }
    };
    lamp.strength
        .map(|c| factor.mul(Bounded::exact(f64::from(c))))
}
