//! Linked lists: the same keys as in runs, whatever the capacity.

use proptest::prelude::*;
use triptych_spec::abuffer::EOL;
use triptych_spec::grid::Blockers;
use triptych_spec::ldm::{Chains, LdmError, chain, layers};

use super::{direction, mesh, quad, uncropped};
use crate::config;

/// Each entry is in one list, and in it once.
fn check_links(chains: &Chains) -> Result<(), TestCaseError> {
    let mut seen = vec![false; chains.links.len()];
    for head in &chains.heads {
        let mut at = *head;
        while at != EOL {
            prop_assert!(!std::mem::replace(&mut seen[at as usize], true), "{}", at);
            at = chains.links[at as usize].next;
        }
    }
    prop_assert!(seen.iter().all(|seen| *seen), "an entry is in no list");
    Ok(())
}

/// Whether `part` is rising and holds no key more often than `whole`, which rises.
fn is_sorted_part(part: &[u32], whole: &[u32]) -> bool {
    let mut rest = whole.iter();
    part.iter().all(|key| rest.any(|other| other == key))
}

proptest! {
    #![proptest_config(config(1500))]

    /// With room for all, lists are those of `layers`. With less, each keeps a part of its keys,
    /// in order; all room is used, and all that was asked for is counted.
    #[test]
    fn lists(
        directions in prop::collection::vec(direction(), 1..3),
        mesh in mesh(),
        doubled in any::<bool>(),
        resolution in 8..=24_u32,
        share in 0.0..1.0_f64,
    ) {
        let mut mesh = mesh;
        if doubled {
            // The same again: every key is there twice.
            mesh.triangles.extend(mesh.triangles.clone());
        }
        let maps = uncropped(&directions, &mesh, resolution);
        let layers = layers(&maps, &mesh).unwrap();
        let all = u32::try_from(layers.keys.len()).unwrap();
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "below all")]
        let less = (f64::from(all) * share) as u32;
        for capacity in [all, all + 1, less, 0] {
            let chains = chain(&maps, &mesh, capacity).unwrap();
            prop_assert_eq!([chains.attempts, chains.capacity], [all, capacity]);
            prop_assert_eq!(chains.heads.len(), maps.pixels as usize);
            prop_assert_eq!(chains.links.len(), all.min(capacity) as usize);
            check_links(&chains)?;
            for pixel in 0..maps.pixels {
                let (list, whole) = (chains.list(pixel as usize), layers.list(pixel));
                if capacity >= all {
                    prop_assert_eq!(list, whole);
                } else {
                    prop_assert!(is_sorted_part(&list, whole), "{:?} of {:?}", list, whole);
                }
            }
        }
    }
}

/// Entries are put in triangle by triangle, so the first that finds no room is the last one's.
#[test]
fn what_comes_last_overflows() {
    let mut mesh = super::empty();
    for z in [7, 3, 5] {
        quad(&mut mesh, [-1_000_000; 2], [1_000_000; 2], z * 100_000);
    }
    let maps = uncropped(&[[0.0, 0.0, 1.0]], &mesh, 20);
    let all = chain(&maps, &mesh, u32::MAX).unwrap();
    let two = chain(&maps, &mesh, all.attempts / 3 * 2).unwrap();
    assert_eq!([all.attempts, two.attempts % 3], [two.attempts, 0]);
    let mut held = 0;
    for pixel in 0..all.heads.len() {
        let (list, kept) = (all.list(pixel), two.list(pixel));
        held += list.len();
        // Seen from above: the quads at 7, 5 and 3, of which that at 5 came last.
        match list[..] {
            [near, _, far] => assert_eq!(kept, [near, far]),
            _ => assert!(list.is_empty() && kept.is_empty(), "{list:?}"),
        }
    }
    assert!(held > 3 * 100, "{held}");
}

#[test]
fn a_corner_that_is_no_vertex_is_named() {
    let mesh = Blockers {
        vertices: vec![[-9; 3], [9; 3]],
        triangles: vec![[0, 1, 1], [1, 2, 0]],
    };
    let maps = uncropped(&[[0.0, 0.0, 1.0]], &mesh, 8);
    assert_eq!(chain(&maps, &mesh, 9), Err(LdmError::Row(2)));
}
