//! Laws of the nearest layers.

use proptest::prelude::*;
use triptych_spec::abuffer::{EOL, Lists, Node, nearest_layers, nearest_of, sort};

use super::{by_pixel, layers};
use crate::config;

proptest! {
    #![proptest_config(config(600))]

    /// The nearest layers are the beginning of each sorted list, whatever came first.
    #[test]
    fn nearest_layers_begin_sorted_lists(
        layers in layers(0..10),
        depth_test in any::<bool>(),
        n in prop_oneof![0_u32..6, Just(u32::MAX)],
    ) {
        let lists = layers.build(depth_test, u32::MAX);
        let mut must = by_pixel(&sort(&lists));
        must.iter_mut().for_each(|list| list.truncate(n as usize));
        prop_assert_eq!(by_pixel(&nearest_layers(&lists, n)), must);
        prop_assert_eq!(nearest_of(&sort(&lists), n), nearest_layers(&lists, n));
    }

    /// The same of equal keys in any order, as a GPU leaves them and the spec never does.
    #[test]
    fn nearest_layers_of_ties(
        rows in Just((0_u32..12).collect::<Vec<_>>()).prop_shuffle(),
        keys in prop::collection::vec(0_u32..3, 12),
        n in 0_u32..14,
    ) {
        let node = |((next, prim), key): ((u32, &u32), &u32)| Node {
            key: *key,
            next: if next == 12 { EOL } else { next },
            prim: *prim,
            mask: 1,
        };
        let lists = Lists {
            heads: vec![0],
            nodes: (1..).zip(&rows).zip(&keys).map(node).collect(),
            colours: vec![[0.0; 4]; 12],
            attempts: 12,
            capacity: 12,
        };
        let mut must = by_pixel(&sort(&lists));
        must[0].truncate(n as usize);
        prop_assert_eq!(by_pixel(&nearest_layers(&lists, n)), must);
    }
}
