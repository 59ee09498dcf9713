//! Laws of coverage with several samples a pixel.

use proptest::prelude::*;
use triptych_spec::raster::{Samples, Setup, count, sample_nodes, samples_of};
use triptych_spec::scene::Size;
use triptych_spec::vertex::Primitives;

use crate::config;
use crate::samples::{Triangle, area, coordinate, depth, flat, fragments, primitives, soup_on};

/// Standard samples, of every number.
pub fn standard() -> impl Strategy<Value = Samples> {
    prop::sample::select(&Samples::COUNTS[..]).prop_filter_map("a pattern", Samples::standard)
}

/// Triangles on a grid that holds the standard places.
pub fn sampled(count: std::ops::Range<usize>) -> impl Strategy<Value = Primitives> {
    let soup = (4_u32..=8).prop_flat_map(move |bits| soup_on(bits, count.clone()));
    (soup, standard()).prop_map(|(soup, samples)| Primitives { samples, ..soup })
}

/// The masks of every pixel, one triangle at a time.
fn masks(primitives: &Primitives) -> Vec<u32> {
    let mut masks = vec![0; primitives.size.pixels()];
    for f in fragments(primitives) {
        masks[f.pixel as usize] |= f.mask;
    }
    masks
}

/// Four corners; `a`, `b`, `c` and `a`, `c`, `d` lie on both sides of their common edge.
fn quad() -> impl Strategy<Value = (Size, u32, [[i32; 3]; 4])> {
    let size = Size {
        width: 16,
        height: 16,
    };
    (4_u32..=8)
        .prop_flat_map(move |bits| {
            let corner = move || {
                let place = || coordinate(16, bits);
                (place(), place(), depth()).prop_map(|(x, y, z)| [x, y, z])
            };
            (
                Just(size),
                Just(bits),
                [corner(), corner(), corner(), corner()],
            )
        })
        .prop_filter("on both sides", |(_, _, [a, b, c, d])| {
            let [a, b, c, d] = [a, b, c, d].map(|p| flat(*p));
            area(a, b, c).signum() * area(a, c, d).signum() == 1
        })
}

proptest! {
    #![proptest_config(config(1000))]

    /// A mask is what each sample by itself covers, and the key is that of the lowest.
    #[test]
    fn masks_are_unions(primitives in sampled(0..3)) {
        let mut must = std::collections::BTreeMap::new();
        for s in 0..primitives.samples.count() {
            for f in fragments(&primitives.of_sample(s)) {
                let (mask, _) = must.entry((f.prim, f.pixel)).or_insert((0, f.key));
                *mask |= 1_u32 << s;
            }
        }
        let all = fragments(&primitives);
        let seen = all.iter().map(|f| ((f.prim, f.pixel), (f.mask, f.key)));
        prop_assert_eq!(seen.collect::<std::collections::BTreeMap<_, _>>(), must);
        prop_assert_eq!(all.len() as u64, count(&primitives));
        let covered: u32 = all.iter().map(|f| f.mask.count_ones()).sum();
        prop_assert_eq!(sample_nodes(all.iter()), u64::from(covered));
    }

    /// A pixel with all four corners inside a triangle is covered as a whole.
    #[test]
    fn inner_pixels_are_full(primitives in sampled(1..2)) {
        let Some(setup) = Setup::new(&primitives, 0) else {
            return Ok(());
        };
        let (width, bits) = (primitives.size.width, primitives.bits);
        let masks = masks(&primitives);
        for (pixel, mask) in (0_u32..).zip(masks) {
            let corner = |i: u32| [pixel % width + (i & 1), pixel / width + (i >> 1)];
            let inside = (0..4).all(|i| {
                let point = corner(i).map(|at| i64::from(at) << bits);
                setup.edges(point).iter().all(|edge| *edge > 0)
            });
            prop_assert!(!inside || mask == primitives.samples.all(), "pixel {pixel}: {mask:#b}");
        }
    }

    /// Neighbours have every sample around their edge once, and whichever diagonal splits a
    /// convex quadrangle, its halves together have the same.
    #[test]
    fn neighbours_share_no_sample((size, bits, [a, b, c, d]) in quad(), samples in standard()) {
        let of = |corners: Triangle| {
            let one = primitives(size, bits, &[corners]);
            masks(&Primitives { samples, ..one })
        };
        let halves = [of([a, b, c]), of([a, c, d])];
        let both = || halves[0].iter().zip(&halves[1]);
        prop_assert!(both().all(|(x, y)| x & y == 0));
        let [p, q, r, s] = [a, b, c, d].map(flat);
        let turns = [area(p, q, r), area(p, q, s), area(q, r, s)].map(i64::signum);
        if turns[1] == turns[0] && turns[2] == turns[0] {
            let others = [of([a, b, d]), of([b, c, d])];
            let all = both().map(|(x, y)| x | y);
            let others = others[0].iter().zip(&others[1]).map(|(x, y)| x | y);
            prop_assert!(all.eq(others));
        }
    }

    /// Four samples in the middles of a pixel's quarters are a target of twice the size: as
    /// many covered, at the same places, with the same keys.
    #[test]
    fn quarters_are_pixels_of_twice_the_size(soup in (5_u32..=8).prop_flat_map(|b| soup_on(b, 1..3))) {
        let quarters: Vec<[u32; 2]> = (0..4_u32)
            .map(|i| [i & 1, i >> 1].map(|half| (2 * half + 1) << (soup.bits - 2)))
            .collect();
        let Size { width, height } = soup.size;
        let coarse = Primitives {
            samples: Samples::found(&quarters, soup.bits).expect("places inside the pixel"),
            ..soup.clone()
        };
        let fine = Primitives {
            size: Size { width: 2 * width, height: 2 * height },
            bits: soup.bits - 1,
            ..soup
        };
        let mut split = Vec::new();
        for f in fragments(&coarse) {
            let setup = Setup::new(&coarse, f.prim).expect("it covers something");
            for s in samples_of(f.mask) {
                let [x, y] = [2 * (f.pixel % width) + (s & 1), 2 * (f.pixel / width) + (s >> 1)];
                split.push((f.prim, y * 2 * width + x, setup.key_at(&coarse, f.pixel, s)));
            }
        }
        split.sort_unstable();
        let fine = fragments(&fine);
        let mut must: Vec<_> = fine.iter().map(|f| (f.prim, f.pixel, Some(f.key))).collect();
        must.sort_unstable();
        prop_assert_eq!(split, must);
    }
}

/// The patterns as Vulkan's table of standard sample locations has them.
#[test]
fn standard_places() {
    let at = |count| Samples::standard(count).map(|s| s.positions());
    assert_eq!(at(1), Some(vec![[0.5, 0.5]]));
    assert_eq!(at(2), Some(vec![[0.75, 0.75], [0.25, 0.25]]));
    assert_eq!(
        at(4),
        Some(vec![
            [0.375, 0.125],
            [0.875, 0.375],
            [0.125, 0.625],
            [0.625, 0.875]
        ])
    );
    let eight = [
        [0.5625, 0.3125],
        [0.4375, 0.6875],
        [0.8125, 0.5625],
        [0.3125, 0.1875],
        [0.1875, 0.8125],
        [0.0625, 0.4375],
        [0.6875, 0.9375],
        [0.9375, 0.0625],
    ];
    assert_eq!(at(8), Some(eight.to_vec()));
    assert_eq!([0, 3, 5, 16].map(at), [None, None, None, None]);
}

#[test]
fn places_that_are_none() {
    let found = |places: &[[u32; 2]]| Samples::found(places, 4);
    let four = [[6, 2], [14, 6], [2, 10], [10, 14]];
    assert_eq!(found(&four), Samples::standard(4));
    assert_eq!(found(&[[8, 8]]), Some(Samples::ONE));
    assert_eq!(found(&[[8, 7]]), None, "one beside the middle");
    assert_eq!(found(&four[..3]), None, "three");
    assert_eq!(found(&[[6, 2], [16, 6]]), None, "in the next pixel");
    assert_eq!(found(&[[6, 2], [u32::MAX, 6]]), None, "nowhere");
    assert_eq!(Samples::found(&four, 9), None, "a finer grid than there is");
}
