//! Lists that are blended at once and never kept.

use crate::abuffer::Sorted;
use crate::raster::{Fragment, Samples};

use super::packed;

/// What is left of a list that was read and is gone: how long it was, and a digest of its fragments.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Digest {
    /// Fragments.
    pub count: u32,
    /// FNV-1a by words (Fowler, Noll and Vo) of key and packed triangle of each, from 0 on.
    pub words: u32,
}

/// Stage `local`: the digest of every pixel's list, in order. The picture is that of [`super::shade`].
pub fn local(sorted: &Sorted, samples: Samples) -> Vec<Digest> {
    let entry = |f: &Fragment| [f.key, packed(samples, f.prim, f.mask)];
    let list = |pixel| sorted.list(pixel).iter().map(entry);
    (0..sorted.offsets.len() - 1)
        .map(|pixel| digest(list(pixel)))
        .collect()
}

/// The digest of a list.
pub fn digest(list: impl IntoIterator<Item = [u32; 2]>) -> Digest {
    const PRIME: u32 = 16_777_619;
    let mut digest = Digest::default();
    for fragment in list {
        digest.count += 1;
        for word in fragment {
            digest.words = (digest.words ^ word).wrapping_mul(PRIME);
        }
    }
    digest
}
