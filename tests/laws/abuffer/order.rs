//! Laws of order: what comes first must not matter.

use proptest::prelude::*;
use triptych_spec::abuffer::sort;
use triptych_spec::raster::Fragment;

use super::{layers, linked};
use crate::config;

proptest! {
    #![proptest_config(config(600))]

    /// Reordered triangles leave in every pixel what was there: keys, masks and colours,
    /// and the key of the opaque surface. Only which of equal keys comes first is theirs.
    #[test]
    fn permutation(
        (layers, order) in layers(0..8).prop_flat_map(|layers| {
            let order: Vec<usize> = (0..layers.primitives.prims.len()).collect();
            (Just(layers), Just(order).prop_shuffle())
        })
    ) {
        let rows = |rows: &[u32]| order.iter().map(|row| rows[*row]).collect::<Vec<_>>();
        let mut shuffled = layers.clone();
        shuffled.primitives.source = rows(&layers.primitives.source);
        let prims = order.iter().map(|row| layers.primitives.prims[*row]);
        shuffled.primitives.prims = prims.collect();
        prop_assert_eq!(shuffled.opaque().key, layers.opaque().key);
        prop_assert_eq!(shuffled.contents(), layers.contents());
    }

    /// The order in which fragments arrive does not matter; sorting twice is sorting.
    #[test]
    fn insertion_order(
        (layers, order) in layers(0..8).prop_flat_map(|layers| {
            let all: Vec<Fragment> = layers.visible().concat();
            (Just(layers), Just(all).prop_shuffle())
        })
    ) {
        let sorted = sort(&layers.build(true, u32::MAX));
        let pixels = layers.scene.size.pixels();
        prop_assert_eq!(&sort(&linked(pixels, order)), &sorted);
        let again = linked(pixels, sorted.fragments.iter().copied());
        prop_assert_eq!(&sort(&again), &sorted);
    }
}
