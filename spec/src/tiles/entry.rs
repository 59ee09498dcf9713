//! Entries of lists: a key, and a triangle with its mask in a word.

use crate::abuffer::Sorted;
use crate::layouts::MASK_BITS;
use crate::raster::{Fragment, Samples};
use crate::vertex::Primitives;

use super::{Bins, Jagged, LISTS, SIDE, word};

/// A fragment's row of [`Primitives::prims`], and its mask where there are several samples: a word, so
/// that an entry takes 8 bytes, and words of a list are in order of triangle.
pub fn packed(samples: Samples, prim: u32, mask: u32) -> u32 {
    match samples.count() {
        1 => prim,
        _ => prim << MASK_BITS | mask,
    }
}

/// Triangle and mask of a [`packed`] word.
pub fn unpacked(samples: Samples, word: u32) -> (u32, u32) {
    match samples.count() {
        1 => (word, 1),
        _ => (word >> MASK_BITS, word & ((1 << MASK_BITS) - 1)),
    }
}

/// The lists of all pixels in order, row by row of the target.
pub fn sorted(primitives: &Primitives, bins: &Bins, jagged: &Jagged) -> Sorted {
    let width = primitives.size.width;
    let mut sorted = Sorted {
        offsets: vec![0],
        fragments: Vec::with_capacity(jagged.entries.len()),
    };
    for (y, x) in (0..bins.rows.end - bins.rows.start).flat_map(|y| (0..width).map(move |x| (y, x)))
    {
        let tile = y / SIDE * bins.across + x / SIDE;
        let list = (tile * LISTS + y % SIDE * SIDE + x % SIDE) as usize;
        let fragment = |i| {
            let [key, word] = jagged.entries[jagged.slot(list, i)];
            let (prim, mask) = unpacked(primitives.samples, word);
            Fragment {
                pixel: y * width + x,
                prim,
                key,
                mask,
            }
        };
        let start = sorted.fragments.len();
        sorted
            .fragments
            .extend((0..jagged.lists[list].length).map(fragment));
        sorted.fragments[start..].sort_unstable_by_key(|f| (f.key, f.prim));
        sorted.offsets.push(word(sorted.fragments.len()));
    }
    sorted
}
