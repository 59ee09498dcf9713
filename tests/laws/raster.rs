//! Laws of the raster stage.

#[path = "raster/multisample.rs"]
pub mod multisample;
#[path = "raster/partition.rs"]
mod partition;

use proptest::prelude::*;
use triptych_spec::raster::{Fragment, Setup, count, sample};
use triptych_spec::scene::Size;
use triptych_spec::vertex::{DEPTH_ONE, GUARD, guard_origin};

use super::config;
use super::samples::{Triangle, fragments, primitives, samples, soup, triangle, triangles};

/// The top-left rule, said another way: a sample belongs to a triangle if it lies
/// strictly inside once it is moved right by an infinitesimal, and down by one that
/// is smaller still.
fn belongs(corners: Triangle, [x, y]: [i128; 2]) -> bool {
    let side = |i: usize| {
        let [ax, ay, _] = corners[i].map(i128::from);
        let [bx, by, _] = corners[(i + 1) % 3].map(i128::from);
        let (dx, dy) = (bx - ax, by - ay);
        let value = dx * (y - ay) - dy * (x - ax);
        [value, -dy, dx]
            .into_iter()
            .map(i128::signum)
            .find(|sign| *sign != 0)
            .unwrap_or(0)
    };
    let sides = [side(0), side(1), side(2)];
    sides == [1; 3] || sides == [-1; 3]
}

/// Depth by the plane's normal: `a_z - (n_x (x - a_x) + n_y (y - a_y)) / n_z`, rounded
/// down.
fn depth(corners: Triangle, [x, y]: [i128; 2]) -> i128 {
    let [a, b, c] = corners.map(|c| c.map(i128::from));
    let minus = |p: [i128; 3]| [p[0] - a[0], p[1] - a[1], p[2] - a[2]];
    let (u, v) = (minus(b), minus(c));
    let normal = [
        u[1] * v[2] - u[2] * v[1],
        u[2] * v[0] - u[0] * v[2],
        u[0] * v[1] - u[1] * v[0],
    ];
    let fall = -(normal[0] * (x - a[0]) + normal[1] * (y - a[1]));
    a[2] + (fall * normal[2].signum()).div_euclid(normal[2].abs())
}

/// Fragments without the row of their triangle.
fn anonymous(fragments: &[Fragment]) -> Vec<[u32; 3]> {
    fragments.iter().map(|f| [f.pixel, f.key, f.mask]).collect()
}

fn one_triangle() -> impl Strategy<Value = (Size, u32, Triangle)> {
    (super::samples::size(), 1_u32..=8)
        .prop_flat_map(|(size, bits)| (Just(size), Just(bits), triangle(size, bits)))
}

/// An edge function is linear in each coordinate of its edge and of the sample, so
/// over all that lies in the guard rectangle it is extreme where all are at its ends.
#[test]
fn edge_functions_are_at_most_the_square_of_the_guard() {
    let (size, bits) = (
        Size {
            width: 2048,
            height: 2048,
        },
        8,
    );
    let low = guard_origin(2048) << bits;
    let ends = [low, low + (GUARD << bits)];
    let square: Vec<[i32; 2]> = (0..4).map(|i| [ends[i & 1], ends[i >> 1]]).collect();
    let mut largest = 0;
    for number in 0..4 * 4 * 4 {
        let corners = [number & 3, number >> 2 & 3, number >> 4].map(|i| {
            let [x, y] = square[i];
            [x, y, DEPTH_ONE]
        });
        let Some(setup) = Setup::new(&primitives(size, bits, &[corners]), 0) else {
            continue;
        };
        for point in &square {
            for edge in setup.edges(point.map(i64::from)) {
                largest = largest.max(edge.abs());
            }
        }
        largest = largest.max(setup.area);
    }
    assert_eq!(largest, 1 << 40, "the bound is reached, not exceeded");
}

proptest! {
    #![proptest_config(config(2000))]

    /// Spans and keys are those of a look at every sample, in wide integers.
    #[test]
    fn brute_force((size, bits, corners) in one_triangle()) {
        let all = fragments(&primitives(size, bits, &[corners]));
        let expected = samples(size, bits).filter(|(_, at)| belongs(corners, *at));
        let expected: Vec<(u32, i128)> = expected.map(|(p, at)| (p, depth(corners, at))).collect();
        let seen: Vec<(u32, i128)> = all.iter().map(|f| (f.pixel, i128::from(f.key))).collect();
        prop_assert_eq!(seen, expected);
    }

    /// A key lies between the corners' keys.
    #[test]
    fn keys_stay_between_the_corners((size, bits, corners) in one_triangle()) {
        let z = corners.map(|c| c[2].cast_unsigned());
        let [low, high] = [z.into_iter().min(), z.into_iter().max()];
        for f in fragments(&primitives(size, bits, &[corners])) {
            prop_assert!(low <= Some(f.key) && Some(f.key) <= high, "{f:?}");
            prop_assert_eq!(f.mask, 1);
        }
    }

    /// Rows and columns are those whose samples lie in the triangle's extent, its ends
    /// included.
    #[test]
    fn extents((size, bits, corners) in one_triangle()) {
        let Some(setup) = Setup::new(&primitives(size, bits, &[corners]), 0) else {
            return Ok(());
        };
        let within = |axis: usize, side: u32| -> Vec<u32> {
            let ends = corners.map(|c| i64::from(c[axis]));
            let [low, high] = [ends.iter().min(), ends.iter().max()].map(|end| end.unwrap_or(&0));
            (0..side).filter(|pixel| (low..=high).contains(&&sample(*pixel, bits))).collect()
        };
        let columns: Vec<u32> = setup.columns(size, bits).collect();
        prop_assert_eq!(columns, within(0, size.width));
        let rows: Vec<u32> = setup.rows(size, bits).collect();
        prop_assert_eq!(rows, within(1, size.height));
    }

    /// Counting is covering.
    #[test]
    fn count_is_cover(soup in soup(0..8)) {
        prop_assert_eq!(count(&soup), fragments(&soup).len() as u64);
    }

    /// The order of the triangles decides nothing but the order of the fragments.
    #[test]
    fn permutation(
        (soup, order) in soup(0..8).prop_flat_map(|soup| {
            let order: Vec<usize> = (0..soup.prims.len()).collect();
            (Just(soup), Just(order).prop_shuffle())
        })
    ) {
        let all = triangles(&soup);
        let shuffled: Vec<Triangle> = order.iter().map(|t| all[*t]).collect();
        let mut seen = fragments(&primitives(soup.size, soup.bits, &shuffled));
        for f in &mut seen {
            f.prim = u32::try_from(order[f.prim as usize]).expect("few triangles");
        }
        seen.sort_by_key(|f| (f.prim, f.pixel));
        prop_assert_eq!(seen, fragments(&soup));
    }

    /// Neither the first corner nor the winding matters.
    #[test]
    fn winding((size, bits, [a, b, c]) in one_triangle()) {
        let plain = fragments(&primitives(size, bits, &[[a, b, c]]));
        for turned in [[b, c, a], [c, a, b], [a, c, b], [c, b, a], [b, a, c]] {
            prop_assert_eq!(&fragments(&primitives(size, bits, &[turned])), &plain);
        }
    }

    /// A triangle moved by whole pixels covers the pixels moved, with equal keys.
    #[test]
    fn translation_by_pixels(
        (size, bits, corners) in one_triangle(),
        [dx, dy] in [-24..=24, -24..=24],
    ) {
        let moved = corners.map(|[x, y, z]| [x + (dx << bits), y + (dy << bits), z]);
        let places = |corners, [dx, dy]: [i32; 2]| {
            let all = fragments(&primitives(size, bits, &[corners]));
            let within = |(x, y, _): &(i32, i32, u32)| {
                (0..size.width.cast_signed()).contains(&(x + dx))
                    && (0..size.height.cast_signed()).contains(&(y + dy))
            };
            let place = |f: &Fragment| {
                let [x, y] = [f.pixel % size.width, f.pixel / size.width];
                (x.cast_signed(), y.cast_signed(), f.key)
            };
            all.iter().map(place).filter(within).collect::<Vec<_>>()
        };
        let plain = places(corners, [dx, dy]);
        let back = places(moved, [-dx, -dy]);
        let back: Vec<_> = back.into_iter().map(|(x, y, key)| (x - dx, y - dy, key)).collect();
        prop_assert_eq!(back, plain);
    }

    /// Triangle and sample moved by sub-pixels: nothing changes.
    #[test]
    fn translation_by_sub_pixels(
        (size, bits, corners) in one_triangle(),
        [x, y] in [-5000_i32..5000, -5000..5000],
        [dx, dy] in [-5000_i32..5000, -5000..5000],
    ) {
        let moved = corners.map(|[x, y, z]| [x + dx, y + dy, z]);
        let plain = Setup::new(&primitives(size, bits, &[corners]), 0);
        let moved = Setup::new(&primitives(size, bits, &[moved]), 0);
        prop_assert_eq!(plain.is_some(), moved.is_some());
        if let (Some(plain), Some(moved)) = (plain, moved) {
            let edges = plain.edges([x, y].map(i64::from));
            prop_assert_eq!(edges, moved.edges([x + dx, y + dy].map(i64::from)));
            prop_assert_eq!(edges.iter().sum::<i64>(), plain.area);
            prop_assert_eq!(plain.covers(edges), moved.covers(edges));
            if plain.covers(edges) {
                prop_assert_eq!(plain.key(edges), moved.key(edges));
            }
        }
    }

    /// The same corners on a finer grid: the same fragments.
    #[test]
    fn refinement((size, bits, corners) in one_triangle(), finer in 0_u32..4) {
        let finer = finer.min(8 - bits);
        let scaled = corners.map(|[x, y, z]| [x << finer, y << finer, z]);
        let fine = fragments(&primitives(size, bits + finer, &[scaled]));
        let coarse = fragments(&primitives(size, bits, &[corners]));
        prop_assert_eq!(anonymous(&fine), anonymous(&coarse));
    }
}
