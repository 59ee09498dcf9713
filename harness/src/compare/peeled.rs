//! Stages `peel` and `dual`: which fragments were peeled, layer by layer.
//!
//! If more fragments were counted than lists have, some were peeled again, which lists cannot
//! show, as they are read from what was peeled last: `duplicate`. Else a list that is not the
//! spec's has a fragment twice: `duplicate`. Else it has another triangle, or lacks one: `coverage`. Else a triangle has another key: `depth-key`.
//! Else the same fragments come in another order: `tie-order` if their keys do not, else
//! `sort-order`.

use std::collections::BTreeSet;

use triptych_spec::abuffer::Sorted;
use triptych_spec::raster::Fragment;

use super::Judgement;
use super::fragments::at;
use super::order::words;
use crate::cause::Cause;
use crate::row::Class;

/// Compares every layer of every pixel, bit for bit, and how many fragments were `counted`.
pub fn compare(spec: &Sorted, other: &Sorted, counted: u64, width: u32) -> Judgement {
    let mut judgement = Judgement::new(Class::Exact, "fragments");
    let listed = other.fragments.len() as u64;
    if counted != listed {
        judgement.compared = spec.fragments.len() as u64;
        let cause = match counted > listed {
            true => Cause::Duplicate,
            false => Cause::Overflow,
        };
        judgement.differs(cause, None, || {
            format!("{counted} fragments were counted, {listed} different ones were peeled")
        });
        return judgement;
    }
    if spec.offsets.len() != other.offsets.len() {
        let pixels = [other, spec].map(|of| of.offsets.len() - 1);
        judgement.differs(Cause::ReferenceMissing, None, || {
            format!("{} pixels, must be {}", pixels[0], pixels[1])
        });
        return judgement;
    }
    for pixel in 0..spec.offsets.len() - 1 {
        let (must, seen) = (spec.list(pixel), other.list(pixel));
        judgement.compared += must.len() as u64;
        let identify = |f: &Fragment| (f.key, f.prim);
        if must.iter().map(identify).eq(seen.iter().map(identify)) {
            continue;
        }
        let pixel = u32::try_from(pixel).expect("a target has fewer than 2^32 pixels");
        judgement.differs(cause(must, seen), Some(pixel), || {
            let at = at(pixel, width);
            format!("{at} is {}, must be {}", words(seen), words(must))
        });
    }
    if judgement.compared == 0 {
        judgement.unit = "empty lists";
        judgement.compared = spec.offsets.len() as u64 - 1;
    }
    judgement
}

/// Why two lists of a pixel differ, which they do.
fn cause(must: &[Fragment], seen: &[Fragment]) -> Cause {
    let prims = |list: &[Fragment]| list.iter().map(|f| f.prim).collect::<BTreeSet<u32>>();
    let both = |list: &[Fragment]| {
        let all = list.iter().map(|f| (f.prim, f.key));
        all.collect::<BTreeSet<(u32, u32)>>()
    };
    if prims(seen).len() < seen.len() {
        Cause::Duplicate
    } else if prims(must) != prims(seen) {
        Cause::Coverage
    } else if both(must) != both(seen) {
        Cause::DepthKey
    } else if must.iter().map(|f| f.key).eq(seen.iter().map(|f| f.key)) {
        Cause::TieOrder
    } else {
        Cause::SortOrder
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sorted(list: &[(u32, u32)]) -> Sorted {
        let fragment = |&(key, prim): &(u32, u32)| Fragment {
            pixel: 0,
            prim,
            key,
            mask: 1,
        };
        Sorted {
            offsets: vec![0, u32::try_from(list.len()).expect("a few")],
            fragments: list.iter().map(fragment).collect(),
        }
    }

    #[test]
    fn every_difference_has_its_cause() {
        let must = [(5, 1), (5, 2), (9, 0)];
        let judged = |seen: &[(u32, u32)]| {
            let counted = seen.len() as u64;
            let judgement = compare(&sorted(&must), &sorted(seen), counted, 1);
            assert_eq!(judgement.compared, 3, "all that must be there");
            judgement.causes.into_keys().collect::<Vec<_>>()
        };
        assert_eq!(judged(&must), [], "the same");
        for (seen, cause) in [
            (&[(5, 1), (5, 1), (9, 0)][..], Cause::Duplicate),
            (&[(5, 1), (9, 0)], Cause::Coverage),
            (&[(5, 1), (5, 2), (9, 3)], Cause::Coverage),
            (&[(5, 1), (6, 2), (9, 0)], Cause::DepthKey),
            (&[(5, 2), (5, 1), (9, 0)], Cause::TieOrder),
            (&[(9, 0), (5, 1), (5, 2)], Cause::SortOrder),
        ] {
            assert_eq!(judged(seen), [cause], "{seen:?}");
        }
        for (counted, cause) in [(4, Cause::Duplicate), (2, Cause::Overflow)] {
            let judgement = compare(&sorted(&must), &sorted(&must), counted, 1);
            let causes: Vec<Cause> = judgement.causes.into_keys().collect();
            assert_eq!(causes, [cause], "{counted} counted of three");
        }
    }

    #[test]
    fn nothing_to_compare_says_so() {
        let judgement = compare(&sorted(&[]), &sorted(&[]), 0, 1);
        assert_eq!((judgement.unit, judgement.compared), ("empty lists", 1));
        let short = Sorted {
            offsets: vec![0],
            fragments: Vec::new(),
        };
        let judgement = compare(&sorted(&[]), &short, 0, 1);
        assert_eq!(judgement.differ(), 1, "another number of pixels");
    }
}
