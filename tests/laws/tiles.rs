//! Laws of the A-buffer by tiles.

#[path = "tiles/adapters.rs"]
mod adapters;

use std::ops::Range;

use proptest::prelude::*;
use triptych_spec::abuffer::{EOL, NOTHING, Opaque, build, opaque, resolve, sort};
use triptych_spec::raster::{Fragment, Samples, Setup, cover};
use triptych_spec::scene::Size;
use triptych_spec::tiles::{
    Bins, Jagged, LISTS, ROWS, SIDE, bin, digest, jagged, linked, local, packed, shade, sorted,
};
use triptych_spec::vertex::Primitives;

use super::abuffer::{Layers, coloured, painted};
use super::config;
use super::samples::{fragments, soup};

fn is_opaque(layers: &Layers, prim: u32) -> bool {
    let source = layers.primitives.source[prim as usize];
    layers.scene.triangles[source as usize].is_opaque()
}

/// Bins of the whole target, of what is not opaque.
fn whole(layers: &Layers) -> Bins {
    let rows = 0..layers.primitives.size.height;
    bin(&layers.primitives, rows, |prim| !is_opaque(layers, prim))
}

/// A row of a target somewhere, and one that comes after it.
fn rows(height: u32) -> impl Strategy<Value = Range<u32>> {
    (0..height).prop_flat_map(move |first| (first + 1..=height).prop_map(move |end| first..end))
}

/// So many as adapters may have.
fn samples() -> impl Strategy<Value = Samples> {
    let standard = |count| Samples::standard(count).expect("a pattern");
    prop::sample::select(Samples::COUNTS.to_vec()).prop_map(standard)
}

/// Every slot of a tile's lists, row by row.
fn slots(jagged: &Jagged, tile: usize) -> Vec<usize> {
    let lists = tile * LISTS as usize..(tile + 1) * LISTS as usize;
    let longest = lists.clone().map(|list| jagged.lists[list].length).max();
    let row = |i: u32| {
        let has = move |list: &usize| i < jagged.lists[*list].length;
        let mut row: Vec<usize> = lists
            .clone()
            .filter(has)
            .map(|l| jagged.slot(l, i))
            .collect();
        row.sort_unstable();
        row
    };
    (0..longest.unwrap_or(0)).flat_map(row).collect()
}

/// So many layers over a pixel, the first behind all others, and one over its neighbours.
pub fn stack(layers: u32) -> Layers {
    let corners = |size: i32, key: i32| [[0, 0, key], [size << 8, 0, key], [0, size << 8, key]];
    let snapped = (0..layers).flat_map(|i| {
        let key = i32::try_from(layers - i).expect("few layers");
        corners(if i == 0 { 18 } else { 2 }, key)
    });
    let primitives = Primitives {
        size: Size {
            width: 9,
            height: 9,
        },
        bits: 8,
        samples: Samples::default(),
        snapped: snapped.collect(),
        prims: (0..layers).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(),
        source: (0..layers).collect(),
    };
    let colours = vec![[0.5, 0.25, 0.125, 0.5]; layers as usize];
    Layers {
        scene: painted(&primitives, &colours, [1.0; 3]),
        primitives,
    }
}

proptest! {
    #![proptest_config(config(256))]

    /// A tile lists whatever covers a sample of it, and nothing that an edge keeps out of all that its
    /// samples span; rows of a target have the bins of the whole one where tiles begin alike.
    #[test]
    fn bins_hold_what_is_covered(
        mut primitives in soup(1..24),
        samples in samples(),
        rows in rows(8),
    ) {
        primitives.samples = samples;
        let bins = bin(&primitives, rows.clone(), |_| true);
        let tile_of = |f: &Fragment| {
            let (x, y) = (f.pixel % primitives.size.width, f.pixel / primitives.size.width);
            let within = rows.contains(&y);
            within.then(|| (y - rows.start) / SIDE * bins.across + x / SIDE)
        };
        for fragment in fragments(&primitives) {
            if let Some(tile) = tile_of(&fragment) {
                prop_assert!(bins.bin(tile as usize).contains(&fragment.prim));
            }
        }
        for (number, tile) in (0_u32..).zip(0..bins.tiles()) {
            let x = number % bins.across * SIDE;
            let y = rows.start + number / bins.across * SIDE;
            let bin = bins.bin(tile);
            prop_assert!(bin.windows(2).all(|pair| pair[0] < pair[1]), "rising");
            for &prim in bin {
                let setup = Setup::new(&primitives, prim).expect("it has an area");
                let [low, high] = samples.extent(primitives.bits);
                let ends = |first: u32, axis: usize| {
                    let at = |pixel: u32| i64::from(pixel) << primitives.bits;
                    [at(first) + low[axis], at(first + SIDE - 1) + high[axis]]
                };
                let edges = ends(y, 1).into_iter().flat_map(|y| {
                    ends(x, 0).map(|x| setup.edges([x, y]))
                });
                let best = edges.reduce(|a, b| [0, 1, 2].map(|i| a[i].max(b[i])));
                prop_assert!(best.is_some_and(|best| best.iter().all(|e| *e >= 0)), "{best:?}");
            }
        }
    }

    /// The lists are those of stages build and sort, with or without what is hidden, and so is the
    /// picture.
    #[test]
    fn lists_are_those_of_the_abuffer(
        mut layers in coloured(soup(1..24)),
        samples in samples(),
        depth_test: bool,
    ) {
        (layers.primitives.samples, layers.scene.samples) = (samples, samples);
        let Layers { scene, primitives } = &layers;
        let surfaces = opaque(scene, primitives);
        let bins = whole(&layers);
        let own = jagged(primitives, &surfaces, depth_test, &bins);
        let lists = build(scene, primitives, &surfaces, depth_test, u32::MAX);
        let must = sort(&lists);
        prop_assert_eq!(&sorted(primitives, &bins, &own), &must);
        prop_assert_eq!(
            shade(scene, primitives, &surfaces, (&bins, &own)),
            resolve(scene, primitives, &surfaces, &must)
        );
    }

    /// A tile's counter counts all of its fragments, and as many nodes are stored as there is room for;
    /// with room for all, the lists are those of stage build, and so is what is left of them.
    #[test]
    fn tiles_have_counters_of_their_own(
        mut layers in coloured(soup(1..24)),
        samples in samples(),
        capacity in 0_u32..96,
    ) {
        (layers.primitives.samples, layers.scene.samples) = (samples, samples);
        let Layers { scene, primitives } = &layers;
        let surfaces = opaque(scene, primitives);
        let own = jagged(primitives, &surfaces, false, &whole(&layers));
        let count = |tile: usize| {
            let lists = &own.lists[tile * LISTS as usize..(tile + 1) * LISTS as usize];
            lists.iter().map(|list| list.length).sum::<u32>()
        };
        let few = linked(scene, primitives, (&surfaces, false), capacity);
        for (tile, attempts) in few.attempts.iter().enumerate() {
            prop_assert_eq!(*attempts, count(tile));
            let first = tile * capacity as usize;
            let region = &few.nodes[first..first + capacity as usize];
            let stored = region.iter().flatten().count();
            prop_assert_eq!(stored, capacity.min(*attempts) as usize);
        }
        let most = few.attempts.iter().max().copied().unwrap_or(0);
        let all = linked(scene, primitives, (&surfaces, false), most);
        let must = sort(&build(scene, primitives, &surfaces, false, u32::MAX));
        for (pixel, left) in local(&must, primitives.samples).into_iter().enumerate() {
            let mut list = Vec::new();
            let mut at = all.heads[pixel];
            while at != EOL {
                let node = all.nodes[at as usize].expect("what is linked is stored");
                list.push([node.key, packed(samples, node.prim, node.mask)]);
                at = node.next;
            }
            list.sort_unstable();
            prop_assert_eq!(digest(list.iter().copied()), left);
            let reversed = digest(list.iter().rev().copied());
            prop_assert_eq!(reversed == left, list.len() < 2, "the order matters");
        }
    }

    /// Every entry is in one list, and each row of a tile lies behind the one before it.
    #[test]
    fn nothing_lies_between_entries(layers in coloured(soup(1..24))) {
        let nothing = Opaque {
            key: vec![NOTHING; layers.primitives.size.pixels()],
            prim: vec![NOTHING; layers.primitives.size.pixels()],
        };
        let bins = whole(&layers);
        let own = jagged(&layers.primitives, &nothing, false, &bins);
        let all: Vec<usize> = (0..bins.tiles()).flat_map(|tile| slots(&own, tile)).collect();
        prop_assert_eq!(all, (0..own.entries.len()).collect::<Vec<_>>());
    }
}

/// One more entry than rows go with: the tile's lists lie one after another, and hold the same.
#[test]
fn deep_lists_lie_one_after_another() {
    for (depth, in_rows) in [(ROWS, true), (ROWS + 1, false)] {
        let layers = stack(depth);
        let surfaces = opaque(&layers.scene, &layers.primitives);
        let bins = whole(&layers);
        let own = jagged(&layers.primitives, &surfaces, false, &bins);
        assert_eq!(own.rows[0].is_some(), in_rows, "{depth} layers");
        assert_eq!(own.lists[0].length, depth, "layers over the first pixel");
        let must = sort(&build(
            &layers.scene,
            &layers.primitives,
            &surfaces,
            false,
            u32::MAX,
        ));
        assert_eq!(
            sorted(&layers.primitives, &bins, &own),
            must,
            "{depth} layers"
        );
        let mut covered = 0;
        cover(&layers.primitives, |_| covered += 1);
        assert_eq!(own.entries.len(), covered, "8 bytes for each fragment");
    }
}
