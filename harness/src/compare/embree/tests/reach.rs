//! Which pairs are looked at, against all that there are.

use triptych_spec::raster::{Setup, sample};
use triptych_spec::vertex::Primitives;

use super::{Random, embree, scene, three};
use crate::compare::embree::edge::{EDGE_BITS, is_edge};
use crate::compare::embree::pairs::Pairs;
use crate::compare::embree::screen::Screen;
use crate::compare::embree::{Pair, pair};
use crate::embree::ScreenHits;
use crate::embree::bound::{Promise, Triangle};

/// Triangles about as large as a pixel, of which half have a corner on a sample.
fn small(count: u32) -> Primitives {
    let mut random = Random(3);
    let mut triangle = |t: u32| {
        let [x, y, _] = random.corner(0, 16384);
        let mut corners = [0; 3].map(|_| random.corner(-200, 200));
        for corner in &mut corners {
            (corner[0], corner[1]) = (corner[0] + x, corner[1] + y);
        }
        if t.is_multiple_of(2) {
            let on_sample = |v: i32| (v & !255) + 128;
            let [x, y, z] = corners[0];
            corners[0] = [on_sample(x), on_sample(y), z];
        }
        corners
    };
    let triangles: Vec<_> = (0..count).map(&mut triangle).collect();
    scene(64, &triangles)
}

/// Triangles as large as the guard rectangle, of which a side passes a sample by less than a
/// sub-pixel.
fn huge(count: u32) -> Primitives {
    let mut random = Random(4);
    let mut triangle = |t: u32| {
        let at = [0; 2].map(|_| (random.within(0, 63) << 8) + 128);
        let a = [
            random.within(-490_000, -300_000),
            random.within(-60_000, 60_000),
            5,
        ];
        let b = [2 * at[0] - a[0] + 1, 2 * at[1] - a[1], 5];
        let c = [
            random.within(-99_999, 99_999),
            if t.is_multiple_of(2) {
                -480_000
            } else {
                480_000
            },
            5,
        ];
        [a, b, c]
    };
    let triangles: Vec<_> = (0..count).map(&mut triangle).collect();
    scene(64, &triangles)
}

/// Holds the pairs of each triangle against all samples; gives how many there are, and
/// how many of them lie outside of their triangle.
fn pairs(spec: &Primitives) -> [u32; 2] {
    let screen = Screen {
        spec,
        depth: embree(spec).depth(),
    };
    let [mut all, mut beside] = [0, 0];
    for prim in 0..screen.count() {
        let candidate = screen.candidate(prim);
        let mut met = vec![false; 64 * 64];
        for row in screen.rows(&candidate) {
            let columns = screen.reach(&candidate, row).0;
            columns.for_each(|column| met[(row * 64 + column) as usize] = true);
        }
        let Some(setup) = Setup::new(spec, prim) else {
            assert!(!met.contains(&true), "triangle {prim} has no area");
            continue;
        };
        for (pixel, met) in (0_u32..).zip(met) {
            let edges = setup.edges([pixel % 64, pixel / 64].map(|at| sample(at, 8)));
            let near = edges.into_iter().min().unwrap_or(0);
            if setup.covers(edges) || is_edge(edges) {
                assert!(met, "pixel {pixel}, triangle {prim}: {edges:?}");
                all += 1;
                beside += u32::from(near < 0);
            }
            // Class edge, and as little more as can be told by a constant.
            let nearly = near >= -(setup.area >> EDGE_BITS) - 3;
            assert!(!met || nearly, "pixel {pixel}, triangle {prim}: {edges:?}");
        }
    }
    [all, beside]
}

#[test]
fn no_pair_of_a_small_triangle_is_left_out() {
    let [all, _] = pairs(&small(2000));
    assert!((400..1800).contains(&all), "{all} of 2000: few have one");
}

#[test]
fn no_pair_beside_a_huge_triangle_is_left_out() {
    let [all, beside] = pairs(&huge(500));
    assert!(all > 100_000 && beside > 100, "{all}, {beside} outside");
}

/// The sample is within the extent of both, and inside the second one.
#[test]
fn a_triangle_beside_its_only_sample_has_no_rows() {
    let beside = [[120, 200, 5], [200, 120, 5], [200, 200, 5]];
    let around = [[120, 200, 5], [200, 120, 5], [120, 120, 5]];
    let spec = scene(64, &[beside, around]);
    let screen = Screen {
        spec: &spec,
        depth: embree(&spec).depth(),
    };
    assert_eq!(screen.rows(&screen.candidate(0)), 0..0);
    assert_eq!(screen.rows(&screen.candidate(1)), 0..1);
}

/// A key is the floor of the exact depth, of which the bound is.
#[test]
fn depths_may_differ_by_the_bound_and_what_floor_takes() {
    let spec = three();
    let depth = embree(&spec).depth();
    let promise = Triangle::new(&spec, &depth, 0).promise([sample(8, 8); 2]);
    let Promise::Hit { bound } = promise else {
        panic!("{promise:?} at a sample well inside");
    };
    let pair = pair(&spec, &depth, 0, [8, 8], Some(1.0));
    assert!(
        matches!(pair, Pair::Depth(judged) if judged.bound == bound + 1.0),
        "{bound}: {pair:?}"
    );
}
