//! Laws of clipping.

use proptest::prelude::*;
use triptych_spec::scene::Size;
use triptych_spec::vertex::{CORNERS_MAX, GUARD, Plane, Position, clip_triangle, guard_origin};

use super::{bits, config, position, snapped, target, visible};

fn cut(size: Size, corners: [Position<f64>; 3]) -> Vec<Position<f64>> {
    clip_triangle(&Plane::all(size), corners, |_, plain| plain)
}

/// The ends of what is visible of an edge, from the triangle `a, b, b`; as it has no
/// other edge, clipping it is clipping the edge.
fn visible_ends(size: Size, a: Position<f64>, b: Position<f64>) -> Vec<[u64; 4]> {
    let mut ends: Vec<_> = cut(size, [a, b, b]).iter().map(bits).collect();
    ends.sort_unstable();
    ends.dedup();
    ends
}

#[test]
fn the_guard_is_centred_on_the_target() {
    for side in 1..=2048 {
        let before = -guard_origin(side);
        let after = GUARD - before - side.cast_signed();
        assert!(
            matches!(after - before, 0 | 1),
            "{side}: {before} and {after}"
        );
    }
}

/// A point without a place, `w = 0`, is on no plane's outer side if all else is 0 too.
#[test]
fn nothing_is_left_of_a_triangle_with_a_corner_nowhere() {
    let size = Size {
        width: 8,
        height: 8,
    };
    let (there, nowhere) = ([4.0, 4.0, 0.5, 1.0], [0.0; 4]);
    let beside = [6.0, 5.0, 0.25, 1.0];
    assert_eq!(
        cut(size, [there, beside, there]).len(),
        3,
        "all three are visible"
    );
    for corners in [
        [there, beside, nowhere],
        [nowhere, there, beside],
        [nowhere; 3],
    ] {
        assert_eq!(
            cut(size, corners),
            Vec::<Position<f64>>::new(),
            "{corners:?}"
        );
    }
}

proptest! {
    #![proptest_config(config(4000))]

    /// Two triangles on the two sides of an edge get the same points on it, to the
    /// bit, however they are wound; hence the same corners on the grid.
    #[test]
    fn neighbours_share_clip_points(
        size in target(),
        [a, b, c, d] in [position(), position(), position(), position()],
        sub in 1_u32..=8,
    ) {
        let ends = visible_ends(size, a, b);
        prop_assert_eq!(&ends, &visible_ends(size, b, a));
        for corners in [[a, b, c], [b, a, c], [c, b, a], [b, a, d], [a, b, d], [d, a, b]] {
            let polygon = cut(size, corners);
            prop_assert!(polygon.iter().all(|p| p[3] > 0.0), "all have a place: {polygon:?}");
            prop_assert!(!matches!(polygon.len(), 1 | 2), "a polygon: {polygon:?}");
            // Only what touches w = 0 vanishes with a visible edge.
            prop_assert!(polygon.len() >= 3 || ends.is_empty());
            let points: Vec<_> = polygon.iter().map(bits).collect();
            prop_assert!(ends.iter().all(|end| points.contains(end)), "{ends:?} of {points:?}");
            let on_grid = snapped(size, polygon, sub);
            let ends = snapped(size, cut(size, [a, b, b]), sub);
            prop_assert!(ends.iter().all(|end| on_grid.contains(end)));
        }
    }

    /// What is visible as a whole stays as it is, to the bit, on the planes too.
    #[test]
    fn visible_triangles_stay(
        (size, corners) in target().prop_flat_map(|size| {
            (Just(size), [visible(size), visible(size), visible(size)])
        })
    ) {
        let kept: Vec<_> = cut(size, corners).iter().map(bits).collect();
        prop_assert_eq!(kept, corners.iter().map(bits).collect::<Vec<_>>());
    }

    /// What is left lies on the kept side of every plane, and the ends of an edge on
    /// the edge, but for rounding.
    #[test]
    fn clipped_is_inside(size in target(), [a, b, c] in [position(), position(), position()]) {
        // A cut rounds distances and components a dozen times, none larger than
        // this; there are six cuts.
        let largest = [a, b, c].as_flattened().iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        let room = 6.0 * 16.0 * f64::EPSILON * (1.0 + f64::from(GUARD)) * largest;
        let polygon = cut(size, [a, b, c]);
        prop_assert!(polygon.len() <= CORNERS_MAX);
        let guard = [size.width, size.height].map(|side| {
            let low = guard_origin(side);
            [low, low + GUARD].map(f64::from)
        });
        for [x, y, z, w] in polygon {
            for (at, [low, high]) in [(x, guard[0]), (y, guard[1]), (z, [0.0, 1.0])] {
                let inside = low * w - room <= at && at <= high * w + room;
                prop_assert!(inside, "{at} is not in {low} to {high} times {w}");
            }
        }
        let along = [0, 1, 2, 3].map(|i| b[i] - a[i]);
        let dot = |u: [f64; 4], v: [f64; 4]| u.iter().zip(v).map(|(u, v)| u * v).sum::<f64>();
        for p in cut(size, [a, b, b]) {
            let t = dot([0, 1, 2, 3].map(|i| p[i] - a[i]), along) / dot(along, along);
            prop_assert!((-1e-9..=1.0 + 1e-9).contains(&t), "{t}");
            for i in 0..4 {
                let error = (p[i] - (a[i] + t * along[i])).abs();
                prop_assert!(error <= room, "{p:?} is off the edge by {error:e}");
            }
        }
    }
}
