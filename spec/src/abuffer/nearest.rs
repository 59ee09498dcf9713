//! The nearest layers alone, for what is seen of a pixel without all of them.
//!
//! Yang, Hensley, Grün and Thibieroz (2010), section 4.1, keep as many layers of a
//! pixel as a fixed array holds. Which they are is part of the meaning: the nearest
//! ones, not those that came first.

use super::{EOL, Lists, Sorted};
use crate::raster::Fragment;

/// The `n` nearest fragments of each list that is in order: what is left of [`super::sort`] by
/// [`nearest_layers`]. What blends lists in order makes the picture of `n` layers of it, whatever the
/// layout that they come from.
pub fn nearest_of(sorted: &Sorted, n: u32) -> Sorted {
    let mut nearest = Sorted {
        offsets: vec![0],
        fragments: Vec::new(),
    };
    for pixel in 0..sorted.offsets.len() - 1 {
        let list = sorted.list(pixel);
        nearest
            .fragments
            .extend(&list[..list.len().min(n as usize)]);
        let end = u32::try_from(nearest.fragments.len()).expect("fewer than 2^32 fragments");
        nearest.offsets.push(end);
    }
    nearest
}

/// Technique `nearest_layers`: the `n` nearest fragments of each list, in the order that
/// [`super::sort`] gives them, `(key, prim)`; all of a list that has no more than `n`.
///
/// The list is walked once, as it was built; the nearest so far are kept in order by
/// insertion, O(length * n). [`super::resolve`] of the result is the picture of the
/// `n` nearest layers, inside the bound of `n` layers at most: what is left out is not
/// drawn, and the opaque surface or the background shows in its place. With `n` 0 that
/// is all there is. Twin: `nearest_layers` in `gpu/src/nearest.wgsl`.
pub fn nearest_layers(lists: &Lists, n: u32) -> Sorted {
    let n = n as usize;
    let most = lists.nodes.len().min(n.saturating_mul(lists.heads.len()));
    let mut sorted = Sorted {
        offsets: vec![0],
        fragments: Vec::with_capacity(most),
    };
    for (pixel, &head) in (0_u32..).zip(&lists.heads) {
        let start = sorted.fragments.len();
        let mut at = head;
        while at != EOL {
            let node = lists.nodes[at as usize];
            let kept = &sorted.fragments[start..];
            let place = kept.partition_point(|f| (f.key, f.prim) < (node.key, node.prim));
            if place < n {
                sorted.fragments.truncate(start + n - 1);
                let fragment = Fragment {
                    pixel,
                    prim: node.prim,
                    key: node.key,
                    mask: node.mask,
                };
                sorted.fragments.insert(start + place, fragment);
            }
            at = node.next;
        }
        let end = u32::try_from(sorted.fragments.len()).expect("fewer than 2^32 nodes");
        sorted.offsets.push(end);
    }
    sorted
}
