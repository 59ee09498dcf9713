//! Programmable blending over sorted fragments: a medium between the layers.
//!
//! Yang, Hensley, Grün and Thibieroz (2010), section 5: what lies between the layers of a list
//! may attenuate light by the distance between them.

use super::{Opaque, Sorted, behind, colour};
use crate::bound::{Bounded, Real, Sum, TINY, U};
use crate::scene::Scene;
use crate::vertex::Primitives;

/// Stage `density`: sorted lists blended as by [`super::resolve`], where a medium of density
/// `sigma` fills the space between consecutive layers, and between the last and the opaque
/// surface.
///
/// Light that comes from a layer to the one before it is attenuated by `exp(-sigma d)`, with
/// `d` the difference of their keys over `2^31`: a part of the depth range, not a length, so
/// `sigma` is in units of one over the depth range, and at least 0. In front of the first layer
/// there is no medium, nor behind the last where nothing lies behind it: the background has no
/// depth. With `sigma` 0 it is [`super::resolve`].
///
/// `exp` is that of `libm`; WGSL's may be off by `3 + 2 |x|` units of its result, beside what
/// two roundings of `x` make of it. Other operations add what they round and flush
/// ([`Bounded`]), terms in any order ([`Sum`]). Twin: `density` in `gpu/src/density.wgsl`.
pub fn density(
    scene: &Scene,
    primitives: &Primitives,
    opaque: &Opaque,
    sorted: &Sorted,
    sigma: f32,
) -> Vec<[Bounded; 3]> {
    let blend = |pixel: usize| {
        let end = opaque.key[pixel];
        let visible = sorted.list(pixel).iter().take_while(|f| f.key < end);
        let layers: Vec<(u32, [f32; 4])> = visible
            .map(|f| (f.key, colour(scene, primitives, f.prim)))
            .collect();
        let surface = (opaque.prim[pixel] != super::NOTHING).then_some(end);
        let behind = behind(scene, primitives, opaque, pixel);
        through_medium(&layers, surface, behind, sigma)
    };
    (0..primitives.size.pixels()).map(blend).collect()
}

/// What is left of light over a difference of keys.
pub fn attenuation(keys: u32, sigma: f32) -> Bounded {
    let scale = f64::from(1_u32 << 31);
    let distance = f64::from(keys) / scale;
    let size = distance * f64::from(sigma);
    // The difference and the product are rounded, a subnormal density or product flushed.
    let off = (2.0 * U + U * U) * size + 2.0 * TINY;
    let value = libm::exp(-size);
    let largest = libm::exp(off - size);
    let units = 3.0 + 2.0 * (size + off);
    Bounded {
        value,
        bound: (largest - value) + units * U * largest + TINY,
    }
}

/// One pixel: keys and colours, nearest first, and the key of the surface behind, if any.
fn through_medium(
    layers: &[(u32, [f32; 4])],
    surface: Option<u32>,
    behind: [f32; 3],
    sigma: f32,
) -> [Bounded; 3] {
    if layers.is_empty() {
        return behind.map(given);
    }
    let mut sums = [Sum::default(); 3];
    let mut add = |weight: Bounded, colour: [f32; 3]| {
        for (sum, c) in sums.iter_mut().zip(colour) {
            sum.add(weight.mul(given(c)));
        }
    };
    let mut through = Bounded::exact(1.0);
    for (i, &(key, [r, g, b, a])) in layers.iter().enumerate() {
        add(through.mul(given(a)), [r, g, b]);
        through = through.mul(Bounded::exact(1.0).sub(given(a)));
        let next = layers.get(i + 1).map(|(key, _)| *key).or(surface);
        if let Some(next) = next {
            through = through.mul(attenuation(next - key, sigma));
        }
    }
    add(through, behind);
    sums.map(|sum| sum.finish())
}

/// A number of the scene, which may be flushed.
fn given(value: f32) -> Bounded {
    Bounded {
        value: value.into(),
        bound: if value == 0.0 { 0.0 } else { TINY },
    }
}
