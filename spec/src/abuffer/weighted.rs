//! Weighted blended order-independent transparency: sums in place of an order.
//!
//! McGuire and Bavoil, "Weighted Blended Order-Independent Transparency" (2013), a rival of the
//! A-buffer of which the error matters, not the order.

use super::peel::{by_pixel, in_front};
use super::{Opaque, behind, colour};
use crate::bound::{Bounded, Real, Sum, TINY, gamma};
use crate::scene::Scene;
use crate::vertex::Primitives;

/// The least factor of a weight (equation 10).
pub const WEIGHT_LEAST: f32 = 0.01;

/// The factor of the nearest fragments (equation 10).
pub const WEIGHT_MOST: f32 = 3000.0;

/// Sums of opacities and weights below this, 2^-64, are taken for it: such layers are of
/// opacities under 2^-29, which `f32` cannot tell from none in `1 - a`, and a quotient by
/// nothing has no value.
pub const SUM_LEAST: f32 = 1.0 / ((1_u64 << 32) as f32 * (1_u64 << 32) as f32);

/// Stage `weighted`: the mean of the transparent colours in front of a pixel's opaque surface,
/// weighted by opacity and depth, over what lies behind as far as that shows through.
///
/// With `d = key / 2^31` in `[0, 1]`, a fragment's weight is
/// `w = a max(0.01, 3000 (1 - d)^3)` (the paper's equation 10, for the depth of a depth
/// buffer), and the picture is `(sum a c w) / (sum a w) (1 - prod (1 - a)) + b prod (1 - a)`.
/// One fragment gives the picture of [`super::resolve`], in other roundings. Terms are added
/// from the smallest to the largest, so that the order of triangles is not even in the last
/// bit.
///
/// `2^31 - key` is an integer, so `1 - d` is rounded once, and in no way cancelled. Sums may be
/// added in any order ([`Sum`]), and the product of `n` factors, each rounded once, multiplied
/// in any: `gamma(2n - 1)`, and a flush for each of `2n - 1` operations, which are factors of
/// numbers within 1. Twin: `weighted` in `gpu/src/weighted.wgsl`.
pub fn weighted(scene: &Scene, primitives: &Primitives, opaque: &Opaque) -> Vec<[Bounded; 3]> {
    let sorted = by_pixel(
        in_front(scene, primitives, opaque),
        primitives.size.pixels(),
    );
    let blend = |pixel: usize| {
        let list = sorted.list(pixel).iter();
        let layers: Vec<([f32; 4], u32)> = list
            .map(|f| (colour(scene, primitives, f.prim), f.key))
            .collect();
        let behind = behind(scene, primitives, opaque, pixel);
        picture(&layers, behind)
    };
    (0..primitives.size.pixels()).map(blend).collect()
}

/// The factor of an opacity: how near a key is.
fn nearness(key: u32) -> Bounded {
    let rest = f64::from((1_u32 << 31).saturating_sub(key)) / f64::from(1_u32 << 31);
    // Every integer but 0 is normal when it is scaled.
    let near = match rest {
        0.0 => Bounded::exact(0.0),
        _ => Bounded::once(rest),
    };
    let cube = near.mul(near).mul(near);
    Bounded::exact(WEIGHT_MOST.into())
        .mul(cube)
        .at_least(WEIGHT_LEAST.into())
}

/// A pixel's picture from colours and keys in any order.
fn picture(layers: &[([f32; 4], u32)], behind: [f32; 3]) -> [Bounded; 3] {
    if layers.is_empty() {
        return behind.map(|c| Bounded {
            value: c.into(),
            bound: TINY,
        });
    }
    let mut terms: [Vec<Bounded>; 4] = Default::default();
    let mut factors = Vec::with_capacity(layers.len());
    for &([r, g, b, a], key) in layers {
        let given = |x: f32| Bounded {
            value: x.into(),
            bound: if x == 0.0 { 0.0 } else { TINY },
        };
        let weight = given(a).mul(nearness(key));
        let weight = given(a).mul(weight);
        for (terms, c) in terms.iter_mut().zip([r, g, b]) {
            terms.push(weight.mul(given(c)));
        }
        terms[3].push(weight);
        factors.push(1.0 - f64::from(a));
    }
    let [r, g, b, whole] = terms.map(sum);
    let through = revealed(factors);
    let covered = Bounded::exact(1.0).sub(through);
    let whole = whole.at_least(SUM_LEAST.into());
    let mut channels = [r, g, b];
    for (channel, behind) in channels.iter_mut().zip(behind) {
        let behind = Bounded {
            value: behind.into(),
            bound: TINY,
        };
        let mean = channel.div(whole);
        *channel = mean.mul(covered).add(behind.mul(through));
    }
    channels
}

/// The sum of terms, whatever their order was.
fn sum(mut terms: Vec<Bounded>) -> Bounded {
    terms.sort_by(|x, y| {
        x.value
            .total_cmp(&y.value)
            .then(x.bound.total_cmp(&y.bound))
    });
    let mut sum = Sum::default();
    terms.into_iter().for_each(|term| sum.add(term));
    sum.finish()
}

/// The product of what goes through each layer, whatever their order was.
fn revealed(mut factors: Vec<f64>) -> Bounded {
    factors.sort_by(f64::total_cmp);
    let n = u32::try_from(factors.len()).expect("fewer than 2^32 layers");
    let value: f64 = factors.iter().product();
    let operations = 2 * n - 1;
    Bounded {
        value,
        bound: gamma(operations) * value + f64::from(operations) * TINY,
    }
}
