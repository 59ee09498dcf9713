//! Lists that are in order while they are built.

use super::{Entry, entry, fragment, stored};
use crate::abuffer::{Opaque, Sorted};
use crate::scene::Scene;
use crate::vertex::Primitives;

/// Stage `ordered`: each fragment goes along its pixel's list from the head, and takes the place of
/// whatever is farther, which goes on in its stead, to the end of the list.
///
/// On a device each such step is one atomic minimum, which keeps the nearer of two fragments in a node and
/// gives back the other. So the first node is handed every fragment, keeps the nearest, and hands on each
/// of the others once; the second does the same with these. Whatever the order in which fragments come, and
/// however their walks interleave, node `i` ends with the `(i + 1)`-th nearest. A walk takes a step for each
/// node of a list that never has more nodes than fragments, and waits for nobody.
///
/// Ties go by triangle, as everywhere. A list has `most` nodes at most: what would go on beyond them is
/// dropped, which is the farthest, so that the nearest are left whoever comes first.
pub fn ordered(
    scene: &Scene,
    primitives: &Primitives,
    (opaque, depth_test): (&Opaque, bool),
    most: u32,
) -> Sorted {
    let mut lists: Vec<Vec<Entry>> = vec![Vec::new(); primitives.size.pixels()];
    stored(scene, primitives, (opaque, depth_test), |f| {
        let list = &mut lists[f.pixel as usize];
        let mut mine = entry(&f);
        for node in list.iter_mut() {
            if mine < *node {
                std::mem::swap(&mut mine, node);
            }
        }
        if list.len() < most as usize {
            list.push(mine);
        }
    });
    let mut sorted = Sorted {
        offsets: vec![0],
        fragments: Vec::new(),
    };
    for (pixel, list) in (0..).zip(lists) {
        let own = list.into_iter().map(|e| fragment(pixel, e));
        sorted.fragments.extend(own);
        let end = u32::try_from(sorted.fragments.len()).expect("fewer than 2^32 fragments");
        sorted.offsets.push(end);
    }
    sorted
}
