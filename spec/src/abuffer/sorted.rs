//! Lists put in order, as runs of one array. Yang et al. 2010, section 4.1, step 3.

use super::{EOL, Lists, Node};
use crate::raster::Fragment;

/// Lists as runs of an array: `offsets[p]..offsets[p + 1]` is pixel `p`, nearest
/// fragment first, ties by [`Fragment::prim`].
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Sorted {
    /// Where each pixel's run starts; one entry more than there are pixels.
    pub offsets: Vec<u32>,
    /// The fragments.
    pub fragments: Vec<Fragment>,
}

impl Sorted {
    /// The fragments of a pixel, nearest first.
    pub fn list(&self, pixel: usize) -> &[Fragment] {
        &self.fragments[self.offsets[pixel] as usize..self.offsets[pixel + 1] as usize]
    }

    /// Fragments of each pixel.
    pub fn lengths(&self) -> impl Iterator<Item = u32> + '_ {
        self.offsets.windows(2).map(|ends| ends[1] - ends[0])
    }

    /// Fragments of the longest list.
    pub fn longest(&self) -> u32 {
        self.lengths().max().unwrap_or(0)
    }

    /// Fragments of each row of a target so many pixels wide.
    pub fn rows(&self, width: u32) -> Vec<u32> {
        let ends: Vec<u32> = self
            .offsets
            .iter()
            .step_by(width as usize)
            .copied()
            .collect();
        ends.windows(2).map(|ends| ends[1] - ends[0]).collect()
    }
}

/// Stage `sort`: each list in order of `(key, prim)` (section 4.1, step 3). Rows
/// of `prims` are in order of source triangle, instance and piece, so this is
/// the total order that the comparison asks for.
pub fn sort(lists: &Lists) -> Sorted {
    let mut sorted = Sorted {
        offsets: vec![0],
        fragments: Vec::with_capacity(lists.nodes.len()),
    };
    for (pixel, &head) in (0_u32..).zip(&lists.heads) {
        let start = sorted.fragments.len();
        let mut at = head;
        while at != EOL {
            let Node {
                key,
                next,
                prim,
                mask,
            } = lists.nodes[at as usize];
            sorted.fragments.push(Fragment {
                pixel,
                prim,
                key,
                mask,
            });
            at = next;
        }
        sorted.fragments[start..].sort_unstable_by_key(|f| (f.key, f.prim));
        let end = u32::try_from(sorted.fragments.len()).expect("fewer than 2^32 nodes");
        sorted.offsets.push(end);
    }
    sorted
}
