//! Stage `bin`: the triangles of each tile, as sets, for nobody relies on their order.
//!
//! A triangle that a bin lacks is a `lost-node`, one that it holds too often a `duplicate`, and one
//! that does not belong there `coverage`. Bins that do not follow one another up to the end are
//! `corrupt-link`, and nothing else is looked at.

use std::ops::Range;

use triptych_spec::tiles::{Bins, Digest};

use crate::cause::Cause;
use crate::compare::Judgement;
use crate::compare::fragments::at;
use crate::row::Class;

/// Compares the bins of the same rows: where each begins, and triangles.
pub fn bins(spec: &Bins, offsets: &[u32], prims: &[u32]) -> Judgement {
    let mut judgement = Judgement::new(Class::Exact, "triangles in tiles");
    let follow = offsets.windows(2).all(|run| run[0] <= run[1]);
    let ends =
        offsets.first() == Some(&0) && offsets.last().map(|o| *o as usize) == Some(prims.len());
    if offsets.len() != spec.offsets.len() || !follow || !ends {
        judgement.compared = 1;
        judgement.differs(Cause::CorruptLink, None, || {
            let (tiles, all) = (spec.tiles(), prims.len());
            format!("the bins of {tiles} tiles do not follow one another up to {all} triangles")
        });
        return judgement;
    }
    for tile in 0..spec.tiles() {
        let own: Range<usize> = offsets[tile] as usize..offsets[tile + 1] as usize;
        bin(tile, spec.bin(tile), &prims[own], &mut judgement);
    }
    if judgement.compared == 0 {
        judgement.unit = "empty tiles";
        judgement.compared = spec.tiles() as u64;
    }
    judgement
}

/// One tile. The spec's triangles rise.
fn bin(tile: usize, must: &[u32], seen: &[u32], judgement: &mut Judgement) {
    let mut seen = seen.to_vec();
    seen.sort_unstable();
    judgement.compared += must.len() as u64;
    let mut differs = |cause, prim: u32| {
        judgement.differs(cause, None, || format!("tile {tile}, triangle {prim}"));
    };
    for pair in seen.windows(2).filter(|pair| pair[0] == pair[1]) {
        differs(Cause::Duplicate, pair[0]);
    }
    seen.dedup();
    for prim in must.iter().filter(|prim| seen.binary_search(prim).is_err()) {
        differs(Cause::LostNode, *prim);
    }
    for prim in seen.iter().filter(|prim| must.binary_search(prim).is_err()) {
        differs(Cause::Coverage, *prim);
    }
}

/// Stage `local`: what is left of lists that were blended at once. One of another length is `coverage`;
/// one of the same length has another key, triangle or order: `sort-order`.
pub fn digests(spec: &[Digest], other: &[Digest], width: u32) -> Judgement {
    let mut judgement = Judgement::new(Class::Exact, "digests of lists");
    if spec.len() != other.len() {
        judgement.differs(Cause::ReferenceMissing, None, || {
            format!("{} lists, must be {}", other.len(), spec.len())
        });
        return judgement;
    }
    for (pixel, (must, seen)) in (0_u32..).zip(spec.iter().zip(other)) {
        judgement.compared += 1;
        if must == seen {
            continue;
        }
        let cause = match must.count == seen.count {
            true => Cause::SortOrder,
            false => Cause::Coverage,
        };
        judgement.differs(cause, Some(pixel), || {
            let [own, spec] = [seen, must].map(|d| format!("{} ({:08x})", d.count, d.words));
            format!("{} has {own} fragments, must have {spec}", at(pixel, width))
        });
    }
    judgement
}

/// The same stage: tiles that must do without lists in memory. One that was left to them all the same is
/// `stale-pass`: what is shown of it comes from other passes.
pub fn left(must: &[bool], left: &[bool]) -> Judgement {
    let mut judgement = Judgement::new(Class::Exact, "tiles that need no lists");
    if must.len() != left.len() {
        judgement.differs(Cause::ReferenceMissing, None, || {
            format!("{} tiles, must be {}", left.len(), must.len())
        });
        return judgement;
    }
    let all = must.iter().zip(left).enumerate();
    for (tile, (_, left)) in all.filter(|(_, (must, _))| **must) {
        judgement.compared += 1;
        if *left {
            judgement.differs(Cause::StalePass, None, || {
                format!("tile {tile} was left to lists")
            });
        }
    }
    judgement
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digests_tell_what_differs() {
        let list = [[5, 1], [9, 0]];
        let of = |list: &[[u32; 2]]| triptych_spec::tiles::digest(list.iter().copied());
        let judged = |seen: &[[u32; 2]]| {
            let judgement = digests(&[of(&list)], &[of(seen)], 1);
            assert_eq!(judgement.compared, 1);
            judgement.causes.into_keys().collect::<Vec<_>>()
        };
        assert_eq!(judged(&list), []);
        assert_eq!(judged(&[[5, 1]]), [Cause::Coverage]);
        assert_eq!(judged(&[[9, 0], [5, 1]]), [Cause::SortOrder]);
        assert_eq!(judged(&[[5, 1], [8, 0]]), [Cause::SortOrder]);
        let none = digests(&[of(&list)], &[], 1);
        assert_eq!(
            none.causes.into_keys().collect::<Vec<_>>(),
            [Cause::ReferenceMissing]
        );
    }

    fn spec() -> Bins {
        Bins {
            rows: 0..8,
            across: 3,
            offsets: vec![0, 2, 2, 3],
            prims: vec![1, 4, 2],
        }
    }

    #[test]
    fn order_does_not_matter() {
        let judgement = bins(&spec(), &[0, 2, 2, 3], &[4, 1, 2]);
        assert_eq!((judgement.compared, judgement.differ()), (3, 0));
        let empty = Bins {
            offsets: vec![0; 4],
            prims: Vec::new(),
            ..spec()
        };
        let judgement = bins(&empty, &[0; 4], &[]);
        assert_eq!((judgement.compared, judgement.unit), (3, "empty tiles"));
    }

    #[test]
    fn what_differs_has_a_cause() {
        let causes = |offsets: &[u32], prims: &[u32]| -> Vec<(Cause, u64)> {
            bins(&spec(), offsets, prims).causes.into_iter().collect()
        };
        assert_eq!(causes(&[0, 1, 1, 2], &[4, 2]), [(Cause::LostNode, 1)]);
        assert_eq!(
            causes(&[0, 3, 3, 4], &[4, 1, 4, 2]),
            [(Cause::Duplicate, 1)]
        );
        assert_eq!(causes(&[0, 2, 3, 4], &[4, 1, 9, 2]), [(Cause::Coverage, 1)]);
        for offsets in [&[0, 2, 1, 3][..], &[1, 2, 2, 3], &[0, 2, 2, 2], &[0, 2, 3]] {
            assert_eq!(causes(offsets, &[4, 1, 2]), [(Cause::CorruptLink, 1)]);
        }
    }

    #[test]
    fn what_needs_no_lists_must_have_none() {
        let judged = left(&[true, false, true], &[false, true, true]);
        assert_eq!((judged.compared, judged.differ()), (2, 1));
        assert_eq!(left(&[true; 2], &[false; 2]).differ(), 0);
        assert_eq!(
            left(&[true; 2], &[false; 3]).differ(),
            1,
            "tiles are missing"
        );
    }
}
