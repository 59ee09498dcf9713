//! Laws of the A-buffer's lists in other layouts.

#[path = "layouts/adapters.rs"]
mod adapters;
#[path = "layouts/colours.rs"]
mod colours;
#[path = "layouts/nearest.rs"]
mod nearest;

use std::ops::Range;

use proptest::prelude::*;
use triptych_spec::abuffer::{EOL, Opaque, Sorted, build, nearest_of, opaque, sort};
use triptych_spec::layouts::{
    ALL, Arrays, Entry, PRIMS_MAX, Runs, bucket, entry, fragment, ordered, precalc, rank, regions,
};
use triptych_spec::raster::{Fragment, Samples};

use super::abuffer::{Layers, coloured};
use super::config;
use super::samples::soup;

/// Layers with one or several samples a pixel.
fn layers() -> impl Strategy<Value = Layers> {
    let samples = prop::sample::select(vec![1, 1, 4, 8]);
    (coloured(soup(1..24)), samples).prop_map(|(mut layers, samples)| {
        let samples = Samples::standard(samples).expect("a pattern");
        (layers.scene.samples, layers.primitives.samples) = (samples, samples);
        layers
    })
}

/// What the A-buffer makes of them.
fn lists(layers: &Layers, surfaces: &Opaque, depth_test: bool) -> Sorted {
    let Layers { scene, primitives } = layers;
    sort(&build(scene, primitives, surfaces, depth_test, u32::MAX))
}

/// Arrays of the fragments within a range.
fn arrays(layers: &Layers, of: (&Opaque, bool), room: u32, range: &Range<Entry>) -> Arrays {
    bucket(&layers.scene, &layers.primitives, of, room, range)
}

/// Runs one behind another, pixel by pixel.
fn joined(parts: &[Runs]) -> Runs {
    let pixels = parts[0].offsets.len() - 1;
    let mut all = Runs {
        offsets: vec![0],
        entries: Vec::new(),
    };
    for pixel in 0..pixels {
        for part in parts {
            let own = part.offsets[pixel] as usize..part.offsets[pixel + 1] as usize;
            all.entries.extend(&part.entries[own]);
        }
        all.offsets
            .push(u32::try_from(all.entries.len()).expect("few"));
    }
    all
}

proptest! {
    #![proptest_config(config(256))]

    /// Entries are in the order of their fragments, and are these fragments.
    #[test]
    fn entries_are_fragments(
        (near, keys) in (0..0x7fff_fff0_u32, [0..4_u32, 0..4]),
        (first, prims) in (0..PRIMS_MAX - 4, [0..4_u32, 0..4]),
        mask in 1..=255_u32,
    ) {
        let made = [0, 1].map(|i| Fragment {
            pixel: 7,
            prim: first + prims[i],
            key: near + keys[i],
            mask,
        });
        for f in made {
            prop_assert_eq!(fragment(7, entry(&f)), f);
            prop_assert!(ALL.contains(&entry(&f)), "{:?}", f);
        }
        let order = (made[0].key, made[0].prim).cmp(&(made[1].key, made[1].prim));
        prop_assert_eq!(entry(&made[0]).cmp(&entry(&made[1])), order);
    }

    /// With room for the longest list, arrays hold what lists hold; passes over ranges that follow each
    /// other hold one after another what one holds, nearest first.
    #[test]
    fn arrays_hold_the_lists(
        layers in layers(),
        depth_test: bool,
        ends in prop::collection::vec((0..=0x7fff_ffff_u32, any::<u32>()), 0..4),
    ) {
        let surfaces = opaque(&layers.scene, &layers.primitives);
        let must = lists(&layers, &surfaces, depth_test);
        let of = (&surfaces, depth_test);
        let counted = arrays(&layers, of, 0, &ALL);
        let room = counted.longest();
        let whole = arrays(&layers, of, room, &ALL).runs().expect("there is room");
        prop_assert_eq!(&rank(&whole), &must);
        let mut ends: Vec<Entry> = ends.into_iter().map(|(key, face)| [key, face]).collect();
        ends.extend([ALL.start, ALL.end]);
        ends.sort_unstable();
        let parts = ends.windows(2).map(|ends| {
            let part = arrays(&layers, of, room, &(ends[0]..ends[1]));
            part.runs().expect("no more than all")
        });
        let parts: Vec<Runs> = parts.collect();
        prop_assert_eq!(&rank(&joined(&parts)), &must);
        let each: Vec<Sorted> = parts.iter().map(rank).collect();
        for pixel in 0..layers.primitives.size.pixels() {
            let all: Vec<Fragment> = each.iter().flat_map(|s| s.list(pixel)).copied().collect();
            prop_assert_eq!(&all[..], must.list(pixel), "nearest first");
        }
    }

    /// Without enough room, what is stored came first, and nothing is forgotten to be counted.
    #[test]
    fn full_arrays_say_so(layers in layers(), depth_test: bool, room in 0_u32..4) {
        let surfaces = opaque(&layers.scene, &layers.primitives);
        let of = (&surfaces, depth_test);
        let few = arrays(&layers, of, room, &ALL);
        let all = arrays(&layers, of, few.longest(), &ALL);
        prop_assert_eq!(&few.counts, &all.counts);
        prop_assert_eq!(few.runs().is_none(), few.longest() > room);
        let must = lists(&layers, &surfaces, depth_test);
        for (pixel, &count) in few.counts.iter().enumerate() {
            prop_assert_eq!(count as usize, must.list(pixel).len());
            let stored = count.min(room) as usize;
            let own = |arrays: &Arrays| {
                let first = pixel * arrays.room as usize;
                arrays.entries[first..first + stored].to_vec()
            };
            prop_assert_eq!(own(&few), own(&all));
        }
    }

    /// Counting first, and keeping lists in order while they are built, give the same lists; of ordered lists
    /// with no more than so many nodes the nearest are left.
    #[test]
    fn runs_and_ordered_lists_are_the_lists(layers in layers(), depth_test: bool, most in 0_u32..6) {
        let Layers { scene, primitives } = &layers;
        let surfaces = opaque(scene, primitives);
        let must = lists(&layers, &surfaces, depth_test);
        let of = (&surfaces, depth_test);
        prop_assert_eq!(&rank(&precalc(scene, primitives, of)), &must);
        prop_assert_eq!(&ordered(scene, primitives, of, u32::MAX), &must);
        prop_assert_eq!(&ordered(scene, primitives, of, most), &nearest_of(&must, most));
    }

    /// Of each region the first attempts are stored, as many as it has room for, and each node is in one
    /// list, which holds fragments of its own alone.
    #[test]
    fn regions_store_what_they_have_room_for(
        layers in layers(),
        depth_test: bool,
        (count, capacity) in (1_u32..5, 0_u32..40),
    ) {
        let Layers { scene, primitives } = &layers;
        let surfaces = opaque(scene, primitives);
        let must = lists(&layers, &surfaces, depth_test);
        let of = (&surfaces, depth_test);
        let region = |f: &Fragment| f.prim % count;
        let lists = regions(scene, primitives, of, (count, capacity), region);
        let mut met = vec![false; lists.nodes.len()];
        for (pixel, &head) in lists.heads.iter().enumerate() {
            let mut at = head;
            while at != EOL {
                let node = lists.nodes[at as usize].expect("a link leads to a node");
                prop_assert!(!std::mem::replace(&mut met[at as usize], true), "twice");
                prop_assert_eq!(at / capacity, node.prim % count, "of another region");
                let own = must.list(pixel).iter();
                let same = own.filter(|f| (f.key, f.prim, f.mask) == (node.key, node.prim, node.mask));
                prop_assert_eq!(same.count(), 1);
                at = node.next;
            }
        }
        for (region, &attempts) in (0_u32..).zip(&lists.attempts) {
            let asked = must.fragments.iter().filter(|f| f.prim % count == region).count();
            prop_assert_eq!(attempts as usize, asked);
            let stored = (region * capacity..(region + 1) * capacity).map(|at| met[at as usize]);
            let stored: Vec<bool> = stored.collect();
            let full = attempts.min(capacity) as usize;
            prop_assert!(stored[..full].iter().all(|met| *met), "the first are stored");
            prop_assert!(!stored[full..].contains(&true), "no others are");
        }
    }
}
