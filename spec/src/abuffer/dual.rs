//! Dual depth peeling: a pixel's layers from both ends at once, without lists.
//!
//! Bavoil and Myers, "Order Independent Transparency with Dual Depth Peeling" (2008); a rival
//! of the lists in Yang, Hensley, Grün and Thibieroz (2010), section 2 and table 1.

use super::peel::{by_pixel, extreme, in_front, order};
use super::{Opaque, Sorted, behind, colour};
use crate::bound::{Bounded, TINY, gamma};
use crate::scene::Scene;
use crate::vertex::Primitives;

/// Stage `dual`: all transparent fragments of every pixel in front of its opaque surface, in
/// order of `(key, prim)`.
///
/// A pass over the triangles finds the smallest and the largest `(key, prim)` of each pixel
/// strictly between those that the pass before found; at first, before the opaque key. Half as
/// many passes as [`super::peel`] find all. Where both are one fragment, it is the last of its
/// pixel, and belongs to the front half: of `n` layers, those before [`middle`]. Exact, ties
/// by `prim`. [`halves`] is the picture. Twin: `dual` in `gpu/src/dual.wgsl`.
pub fn dual(scene: &Scene, primitives: &Primitives, opaque: &Opaque) -> Sorted {
    let mut left = in_front(scene, primitives, opaque);
    let (mut front, mut back) = (Vec::new(), Vec::new());
    while !left.is_empty() {
        let nearest = extreme(&left, primitives, |f, best| order(f) < order(best));
        let farthest = extreme(&left, primitives, |f, best| order(f) > order(best));
        let ends = |pixel: u32| [&nearest, &farthest].map(|of| of[pixel as usize]);
        left.retain(|f| ends(f.pixel).iter().all(|end| *end != Some(*f)));
        let pairs = nearest.iter().zip(&farthest);
        back.extend(pairs.filter(|(a, b)| a != b).filter_map(|(_, b)| *b));
        front.extend(nearest.into_iter().flatten());
    }
    // What was found last at the back lies nearest.
    back.reverse();
    front.extend(back);
    by_pixel(front, primitives.size.pixels())
}

/// How many of `n` layers are peeled from the front.
pub fn middle(n: usize) -> usize {
    n.div_ceil(2)
}

/// The picture of stage `dual`: the back halves are blended over what lies behind, the front
/// halves under those before, and then one over the other.
///
/// With `h` = [`middle`]`(n)` and `T_i = prod_{j<i} (1 - a_j)`, an evaluation is
/// `sum_{i<h} T_i a_i c_i + T_h B_h`, `B_i = a_i c_i + (1 - a_i) B_{i+1}`, `B_n = b`. Term `i`
/// of the front meets `2i` roundings in `T_i`, two products and at most `h - i + 1` additions:
/// `gamma(i + h + 3)`. Term `i` of the back meets one product, `i - h + 1` additions, `2(i - h)`
/// operations of opacities before it, `2h` in `T_h`, and a product and an addition at the end:
/// `gamma(3i - h + 4)`; and what lies behind, which is no product, `gamma(3n - h + 2)`.
///
/// Flushing, as for [`super::resolve`]: of the front `(3i + 2) |c_i| + 3` times [`TINY`]. Each
/// of the `n - h` steps of the back flushes at most an opacity and a colour of its layer, a
/// difference that is a factor of what lies behind it, two products and a sum: with `C` the
/// largest colour of all, which `B` cannot exceed, `3C + 3`; at the end `2h + 1` operations of
/// `T_h` times `C`, a product and a sum.
pub fn halves(
    scene: &Scene,
    primitives: &Primitives,
    opaque: &Opaque,
    sorted: &Sorted,
) -> Vec<[Bounded; 3]> {
    let blend = |pixel: usize| {
        let list = sorted.list(pixel).iter();
        let layers: Vec<[f32; 4]> = list.map(|f| colour(scene, primitives, f.prim)).collect();
        let behind = behind(scene, primitives, opaque, pixel);
        [0, 1, 2].map(|c| {
            let channel: Vec<[f64; 2]> = layers
                .iter()
                .map(|l| [f64::from(l[c]), f64::from(l[3])])
                .collect();
            channel_of(&channel, f64::from(behind[c]))
        })
    };
    (0..primitives.size.pixels()).map(blend).collect()
}

/// One channel: colour and opacity of each layer, nearest first.
fn channel_of(layers: &[[f64; 2]], behind: f64) -> Bounded {
    if layers.is_empty() {
        return Bounded {
            value: behind,
            bound: TINY,
        };
    }
    let word = |n: usize| u32::try_from(n).expect("fewer than 2^32 layers");
    let n = word(layers.len());
    let h = word(middle(layers.len()));
    let mut sum = Bounded {
        value: 0.0,
        bound: 0.0,
    };
    let mut add = |term: f64, roundings: u32| {
        sum.value += term;
        sum.bound += gamma(roundings) * term.abs();
    };
    let mut transmittance = 1.0;
    let mut flushed = 0.0;
    let mut largest = behind.abs();
    for (i, [c, a]) in (0..).zip(layers) {
        let front = i < h;
        add(
            transmittance * a * c,
            if front { i + h + 3 } else { 3 * i - h + 4 },
        );
        if front {
            flushed += f64::from(3 * i + 2) * c.abs() + 3.0;
        }
        transmittance *= 1.0 - a;
        largest = largest.max(c.abs());
    }
    add(transmittance * behind, 3 * n - h + 2);
    flushed += f64::from(n - h) * (3.0 * largest + 3.0);
    flushed += f64::from(2 * h + 1) * largest + 2.0;
    sum.bound += flushed * TINY;
    sum
}
