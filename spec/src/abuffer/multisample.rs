//! Several samples in a pixel: whose surface is behind, which samples a fragment shows at,
//! and the picture.
//!
//! Yang, Hensley, Grün and Thibieroz (2010), section 4.1.2. A node has the mask of the samples
//! that its fragment covers, so that it is stored once, and the paper resolves it in two ways:
//! by a shader for each sample, which sees only the fragments that cover it, and the hardware's
//! resolve ([`resolve_samples`], [`average`]); or by a shader for each pixel, which sorts once
//! and averages samples itself ([`resolve_pixels`]). Both are means over the same colours. With
//! one key a fragment, at its centroid, layers that cross within a pixel are in one order at all
//! its samples; the alternative that the paper names is the true depth of each
//! ([`Order::Sample`]). Twin: `gpu/src/multisample.wgsl`.

use super::{NOTHING, Opaque, Sorted, behind, colour, over};
use crate::bound::{Bounded, TINY, gamma};
use crate::raster::{Fragment, SAMPLES_MAX, Setup, samples_of};
use crate::scene::Scene;
use crate::vertex::Primitives;

/// In which order a pixel's layers lie at each of its samples.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Order {
    /// By the keys of the list, which are those of the lowest covered samples: one order for
    /// all samples of a pixel, as the paper ships it.
    #[default]
    Centroid,
    /// By the keys that triangles have at the sample itself, ties by triangle.
    Sample,
}

/// The key of a fragment at one of its samples. At one that its triangle does not cover, which
/// only a leg with a defect says it does, it is the fragment's own.
fn key_at(primitives: &Primitives, f: &Fragment, s: u32) -> u32 {
    if primitives.samples.count() == 1 {
        return f.key;
    }
    let setup = Setup::new(primitives, f.prim);
    setup
        .and_then(|setup| setup.key_at(primitives, f.pixel, s))
        .unwrap_or(f.key)
}

/// Keys of an opaque fragment at all its samples, for the surface behind each.
pub(super) fn surface(primitives: &Primitives, f: &Fragment, mut emit: impl FnMut(usize, u32)) {
    let count = primitives.samples.count();
    for s in samples_of(f.mask) {
        let place = count as usize * f.pixel as usize + s as usize;
        emit(place, key_at(primitives, f, s));
    }
}

/// The samples at which a fragment lies in front of the opaque surface: early depth, sample
/// by sample, with the fragment's true key at each. The mask without it is what covers; the
/// key stays that of the lowest covered sample, hidden or not.
pub fn visible(primitives: &Primitives, opaque: &Opaque, f: &Fragment) -> u32 {
    let samples = primitives.samples;
    if samples.count() == 1 {
        return u32::from(f.key < opaque.key[f.pixel as usize]);
    }
    let first = samples.count() as usize * f.pixel as usize;
    let in_front = |s: &u32| {
        let end = opaque.key[first + *s as usize];
        end == NOTHING || key_at(primitives, f, *s) < end
    };
    samples_of(f.mask & samples.all())
        .filter(in_front)
        .map(|s| 1_u32 << s)
        .sum()
}

/// The picture a pixel at a time: its layers, sorted once, over the surfaces behind all
/// of its samples, and the mean of these.
pub fn resolve_pixels(
    scene: &Scene,
    primitives: &Primitives,
    opaque: &Opaque,
    sorted: &Sorted,
) -> Vec<[Bounded; 3]> {
    let count = primitives.samples.count();
    let pixel = |pixel: usize| {
        let mut layers: [Vec<[f32; 4]>; SAMPLES_MAX] = std::array::from_fn(|_| Vec::new());
        for f in sorted.list(pixel) {
            for s in samples_of(visible(primitives, opaque, f)) {
                layers[s as usize].push(colour(scene, primitives, f.prim));
            }
        }
        let sample = |s: usize| {
            let place = count as usize * pixel + s;
            over(&layers[s], behind(scene, primitives, opaque, place))
        };
        let samples: Vec<[Bounded; 3]> = (0..count as usize).map(sample).collect();
        mean(&samples)
    };
    (0..primitives.size.pixels()).map(pixel).collect()
}

/// Technique `resolve_samples`, the picture a sample at a time: the colour of every sample of every pixel, of the
/// fragments that show there, in the order of the list or of their keys at the sample.
pub fn resolve_samples(
    scene: &Scene,
    primitives: &Primitives,
    opaque: &Opaque,
    sorted: &Sorted,
    order: Order,
) -> Vec<[Bounded; 3]> {
    let count = primitives.samples.count();
    let sample = |pixel: usize, s: u32| {
        let place = count as usize * pixel + s as usize;
        let list = sorted.list(pixel).iter();
        let shows = |f: &&Fragment| visible(primitives, opaque, f) >> s & 1 == 1;
        let mut shown: Vec<&Fragment> = list.filter(shows).collect();
        if order == Order::Sample {
            shown.sort_by_key(|f| (key_at(primitives, f, s), f.prim));
        }
        let layers = shown.iter().map(|f| colour(scene, primitives, f.prim));
        let layers: Vec<[f32; 4]> = layers.collect();
        over(&layers, behind(scene, primitives, opaque, place))
    };
    let pixels = 0..primitives.size.pixels();
    pixels
        .flat_map(|pixel| (0..count).map(move |s| (pixel, s)))
        .map(|(pixel, s)| sample(pixel, s))
        .collect()
}

/// Every pixel's mean over its samples: what hardware makes of a multisampled target.
pub fn average(samples: &[[Bounded; 3]], count: u32) -> Vec<[Bounded; 3]> {
    samples.chunks(count as usize).map(mean).collect()
}

/// The mean of `n` colours, `n` a power of two. In any order each meets at most `n - 1`
/// additions and one product, so the error is at most theirs, and `gamma(n)` of what they may
/// be in all; results flushed in the additions, divided by `n`, are less than one [`TINY`], and
/// the product adds another. One sample is stored as it is.
fn mean(samples: &[[Bounded; 3]]) -> [Bounded; 3] {
    let n = u32::try_from(samples.len()).expect("at most eight");
    if n == 1 {
        return samples[0];
    }
    [0, 1, 2].map(|c| {
        let channel = || samples.iter().map(|sample| sample[c]);
        let share = 1.0 / f64::from(n);
        let size: f64 = channel().map(|b| b.value.abs() + b.bound).sum();
        let bounds: f64 = channel().map(|b| b.bound).sum();
        Bounded {
            value: share * channel().map(|b| b.value).sum::<f64>(),
            bound: share * (bounds + gamma(n) * size) + 2.0 * TINY,
        }
    })
}
