//! Lists that are blended at once and never kept.

use crate::abuffer::Sorted;
use crate::raster::{Fragment, Samples};

use super::{Bins, SIDE, packed};

/// Fragments of a pixel that wait to be put in order.
pub const WINDOW: u32 = 8;

/// Triangles of the longest bin that is put in order.
pub const BIN_SORTED: u32 = 512;

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

/// Of each tile of the bins' rows, whether it must do without lists, in whatever order its triangles
/// come: its bin is not too long, and no pixel has more fragments than may wait.
pub fn needs_no_lists(bins: &Bins, sorted: &Sorted, width: u32) -> Vec<bool> {
    let mut short: Vec<bool> = (0..bins.tiles())
        .map(|tile| bins.bin(tile).len() <= BIN_SORTED as usize)
        .collect();
    for (y, x) in bins
        .rows
        .clone()
        .flat_map(|y| (0..width).map(move |x| (y, x)))
    {
        if sorted.list((y * width + x) as usize).len() > WINDOW as usize {
            short[((y - bins.rows.start) / SIDE * bins.across + x / SIDE) as usize] = false;
        }
    }
    short
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
