//! Depth peeling: the layers of a pixel one after another, without lists.
//!
//! Everitt, "Interactive Order-Independent Transparency" (2001); a rival of the lists in
//! Yang, Hensley, Grün and Thibieroz (2010), section 2 and table 1.

use super::{Opaque, Sorted, is_opaque};
use crate::raster::{Fragment, cover_only};
use crate::scene::Scene;
use crate::vertex::Primitives;

/// Most layers that are peeled: each takes passes over all triangles. A scene with a longer
/// list is left out, and says so.
pub const LAYERS_MAX: u32 = 256;

/// Stage `peel`: the `layers` nearest transparent fragments of every pixel in front of its
/// opaque surface, in order of `(key, prim)`.
///
/// A pass over the triangles finds the smallest `(key, prim)` of each pixel beyond the one that
/// the pass before found, and before the opaque key. It ends early when no pixel has one. As
/// every pass sees the same fragments, they are covered once here, and what is peeled is
/// dropped: O(sum of the squares of the lists' lengths) at most, and 8 bytes a pixel beside
/// the result. Equal keys are told apart by `prim`, so no fragment is peeled twice and none is
/// lost. Exact: as [`super::nearest_layers`] of lists that hold what is in front.
/// [`super::resolve`] of it is the picture, inside its bound, as a kernel blends each layer
/// under those before it by the same operations. Twin: `peel` in `gpu/src/peel.wgsl`.
pub fn peel(scene: &Scene, primitives: &Primitives, opaque: &Opaque, layers: u32) -> Sorted {
    let mut left = in_front(scene, primitives, opaque);
    let mut peeled = Vec::new();
    for _ in 0..layers {
        let nearest = extreme(&left, primitives, |f, best| order(f) < order(best));
        if nearest.iter().all(Option::is_none) {
            break;
        }
        left.retain(|f| nearest[f.pixel as usize].is_some_and(|last| order(f) > order(&last)));
        peeled.extend(nearest.into_iter().flatten());
    }
    by_pixel(peeled, primitives.size.pixels())
}

/// What decides between two fragments of a pixel.
pub(super) fn order(f: &Fragment) -> (u32, u32) {
    (f.key, f.prim)
}

/// Transparent fragments in front of the opaque surfaces, in order of `prim`.
pub(super) fn in_front(scene: &Scene, primitives: &Primitives, opaque: &Opaque) -> Vec<Fragment> {
    let mut fragments = Vec::new();
    let select = |prim| !is_opaque(scene, primitives, prim);
    cover_only(primitives, select, |f| {
        if f.key < opaque.key[f.pixel as usize] {
            fragments.push(f);
        }
    });
    fragments
}

/// The fragment of each pixel that no other of it is `better` than.
pub(super) fn extreme(
    fragments: &[Fragment],
    primitives: &Primitives,
    better: impl Fn(&Fragment, &Fragment) -> bool,
) -> Vec<Option<Fragment>> {
    let mut best: Vec<Option<Fragment>> = vec![None; primitives.size.pixels()];
    for f in fragments {
        let here = &mut best[f.pixel as usize];
        if here.is_none_or(|best| better(f, &best)) {
            *here = Some(*f);
        }
    }
    best
}

/// Fragments as lists; those of a pixel keep their order.
pub(super) fn by_pixel(mut fragments: Vec<Fragment>, pixels: usize) -> Sorted {
    fragments.sort_by_key(|f| f.pixel);
    let mut counts = vec![0_u32; pixels];
    for f in &fragments {
        counts[f.pixel as usize] += 1;
    }
    let mut offsets = vec![0];
    let mut end = 0;
    offsets.extend(counts.into_iter().map(|count| {
        end += count;
        end
    }));
    Sorted { offsets, fragments }
}
