//! Stage `light`: rays to the lamps that could light a point.

use super::World;
use super::lamp::Lamp;
use super::ray::{Carried, Ray, WEIGHT_ONE, Weight};
use crate::bound::{Bounded, Real};
use crate::grid::exact::minus;
use crate::grid::ray::Ray as Way;
use crate::rsm::{Colour, Surface, faces, projected, squared};

/// What a lamp adds to a pixel, if nothing is in between; `None` if it cannot add anything:
/// the surface is turned away from it, or one of strength, colour and weight is 0 for every
/// colour.
///
/// With `d` from the point to the lamp, `n` the unit normal and `D = max(|d|, least)`, it is
/// `weight colour strength (n . d / D) (reference / D)^2`, and `1 / D` by `inverseSqrt`: an
/// irradiance, which a white surface gives back as it is. Who faces whom is exact; a kernel takes 0 for an `n . d`
/// that its rounding made negative.
pub fn lit(world: &World, weight: Weight, surface: &Surface, lamp: &Lamp) -> Option<Colour> {
    let model = &world.model;
    let colour = model.colours[surface.triangle as usize];
    let counts = |i: usize| weight[i] > 0 && colour[i] > 0.0 && lamp.strength[i] > 0.0;
    if !((0..3).any(counts) && faces(model, surface, lamp.position)) {
        return None;
    }
    let way = minus(lamp.position, surface.point);
    let least = u64::from(lamp.least);
    let inverse = squared(way, least * least).inverse_sqrt();
    let cosine = projected(model, surface, way).mul(inverse);
    let ratio = Bounded::exact(f64::from(lamp.reference)).mul(inverse);
    let factor = cosine.mul(ratio.mul(ratio));
    Some([0, 1, 2].map(|i| {
        let exact = |value: f32| Bounded::exact(f64::from(value));
        let part = Bounded::exact(f64::from(weight[i]) / f64::from(WEIGHT_ONE));
        let given = exact(lamp.strength[i]).mul(exact(colour[i])).mul(part);
        factor.mul(given)
    }))
}

/// Stage `light` (paper section 5.1: "one shadow ray per light source"): the shadow rays of a
/// point, lamp by lamp, each with the light that it brings and the bound of that light.
pub fn light<'a>(
    world: &'a World,
    ray: &'a Ray,
    surface: &'a Surface,
) -> impl Iterator<Item = (Ray, Colour)> + 'a {
    let weight = match ray.carried {
        Carried::Weight(weight) => weight,
        Carried::Light(_) => [0; 3],
    };
    world.lamps.iter().filter_map(move |lamp| {
        let light = lit(world, weight, surface, lamp)?;
        #[expect(clippy::cast_possible_truncation, reason = "rounding to f32 is meant")]
        let brought = light.map(|c| c.value as f32);
        let ray = Ray {
            way: Way::between(surface.point, lamp.position),
            carried: Carried::Light(brought),
            ..*ray
        };
        Some((ray, light))
    })
}
