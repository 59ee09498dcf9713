//! Traces: what is before and behind a point.

use proptest::prelude::*;
use triptych_spec::grid::Blockers;
use triptych_spec::grid::lattice::Point;
use triptych_spec::ldm::{Hits, KEYS_PER_STEP, Receiver, Rotation, layers, neighbours, own_band};
use triptych_spec::rsm::Face;

use super::{direction, empty, maps_of, mesh, normal_of, point, quad, sphere, uncropped};
use crate::config;

/// Layers of a stack, by height.
const HEIGHTS: [i32; 4] = [-3_000_000, -1_000_000, 250_000, 2_000_000];

fn stack() -> Blockers {
    let mut mesh = empty();
    for z in HEIGHTS {
        quad(&mut mesh, [-4_000_000; 2], [4_000_000; 2], z);
    }
    mesh
}

/// Along z, each layer of a stack sees the ones next to it, from itself, from half way between,
/// and from within a step of it; at their very distance.
#[test]
fn layers_see_their_neighbours() {
    let mesh = stack();
    for (z, up) in [(1.0, 1), (-1.0, -1)] {
        let maps = uncropped(&[[0.0, 0.0, z]], &mesh, 40);
        let layers = layers(&maps, &mesh).unwrap();
        let at = |height: i32, normal: i32, off: u32| {
            let receiver = Receiver {
                point: [123_456, -654_321, height],
                normal: [0, 0, normal],
                off,
            };
            let hits = neighbours(&maps, &maps.maps[0], &layers, &receiver);
            let distance = |key: Option<u32>| Some((key?.cast_signed() - hits.key) / KEYS_PER_STEP);
            [distance(hits.before), distance(hits.behind)]
        };
        let expected = |height: i32, own: Option<usize>| {
            let gap = |(n, z): (usize, &i32)| (Some(n) != own).then_some(z - height);
            let gaps: Vec<i32> = HEIGHTS.iter().enumerate().filter_map(gap).collect();
            let above = gaps.iter().copied().filter(|gap| *gap > 0).min();
            let below = gaps.iter().copied().filter(|gap| *gap < 0).max();
            // Depth grows away from the viewer, who is above or below.
            match up {
                1 => [above.map(|g| -g), below.map(|g| -g)],
                _ => [below, above],
            }
        };
        for (n, height) in HEIGHTS.into_iter().enumerate() {
            for normal in [16_384, -16_384] {
                assert_eq!(at(height, normal, 0), expected(height, Some(n)));
                assert_eq!(at(height + 1, normal, 1), expected(height + 1, Some(n)));
            }
            let between = height + 500_000;
            assert_eq!(at(between, 0, 0), expected(between, None), "{height}");
        }
    }
}

/// Two layers closer than half a pixel's slope are one surface to whom lies on either; farther
/// apart they are two. That is not so of the nearest key (the author's rule).
#[test]
fn what_is_within_half_a_pixels_slope_is_the_points_own() {
    // Seen from the side at 45 degrees, depth changes by a pixel a pixel.
    let side = 0.5_f64.sqrt();
    let mut mesh = empty();
    quad(&mut mesh, [-4_000_000; 2], [4_000_000; 2], 0);
    for (gap, seen) in [(1_000, false), (400_000, true)] {
        let mut two = mesh.clone();
        quad(&mut two, [-4_000_000; 2], [4_000_000; 2], gap);
        let maps = uncropped(&[[side, 0.0, side]], &two, 64);
        assert!(f64::from(gap) < maps.pixel * 0.3 || f64::from(gap) > maps.pixel * 1.5);
        let layers = layers(&maps, &two).unwrap();
        let mut found = 0;
        for n in -100..100 {
            let receiver = Receiver {
                point: [31_337 * n, 27_182 * n, 0],
                normal: normal_of(&two, 0),
                off: 0,
            };
            let hits = neighbours(&maps, &maps.maps[0], &layers, &receiver);
            assert_eq!(hits.behind, None, "{n}");
            found += u32::from(hits.before.is_some());
        }
        // The other layer is 1414 steps away along the direction: where a point's own key is as
        // far off as it may be, 1.6 % of the way, that one is beyond it.
        let right = if seen { found == 200 } else { found < 10 };
        assert!(right, "{gap}: {found}");
    }
}

/// What is beside the map, or over an empty pixel, sees nothing; a point on the map's last
/// border is beside it.
#[test]
fn beside_the_map_is_nothing() {
    let mesh = stack();
    let maps = uncropped(&[[0.0, 0.0, 1.0]], &mesh, 40);
    let layers = layers(&maps, &mesh).unwrap();
    let map = &maps.maps[0];
    let hits = |point| {
        let receiver = Receiver {
            point,
            normal: [0; 3],
            off: 0,
        };
        let Hits { before, behind, .. } = neighbours(&maps, map, &layers, &receiver);
        [before.is_some(), behind.is_some()]
    };
    assert_eq!(hits([0, 0, 0]), [true; 2]);
    for axis in 0..2 {
        for end in [-8_000_000, 8_000_000] {
            let mut point = [0; 3];
            point[axis] = end;
            assert_eq!(hits(point), [false; 2], "{point:?}");
        }
        // Walk to the border, step by step of a quarter of a sub-pixel.
        let ends = [map.size.width, map.size.height].map(|n| (n << maps.bits).cast_signed());
        let mut point = [0; 3];
        let place = |point| maps.place(map, point)[axis];
        let grows = place([1_000_000; 3]) > place([0; 3]);
        #[expect(clippy::cast_possible_truncation, reason = "a few hundred steps")]
        let step = (maps.pixel / 512.0) as i32;
        while (0..ends[axis]).contains(&place(point)) {
            point[axis] += step;
        }
        assert_eq!(place(point), if grows { ends[axis] } else { -1 });
        assert_eq!(hits(point), [false; 2], "on the border");
    }
}

proptest! {
    #![proptest_config(config(1500))]

    /// The neighbours are what a search through the whole list finds.
    #[test]
    fn brute_force(
        direction in direction(),
        mesh in mesh(),
        asked in prop::collection::vec((point(), 0..3_u32, any::<prop::sample::Index>(), any::<bool>()), 1..6),
        resolution in 8..=24_u32,
    ) {
        let maps = uncropped(&[direction], &mesh, resolution);
        let map = &maps.maps[0];
        let layers = layers(&maps, &mesh).unwrap();
        for (point, off, triangle, on) in asked {
            let triangle = u32::try_from(triangle.index(mesh.triangles.len())).unwrap();
            let normal = if on { Face::new(mesh.corners(triangle)).coarse } else { [0; 3] };
            let receiver = Receiver { point, normal, off };
            let hits = neighbours(&maps, map, &layers, &receiver);
            let [x, y, key] = maps.place(map, point);
            prop_assert_eq!(hits.key, key);
            let [w, h] = [map.size.width, map.size.height].map(u32::cast_signed);
            let (column, row) = (x >> maps.bits, y >> maps.bits);
            let list: &[u32] = match (0..w).contains(&column) && (0..h).contains(&row) {
                true => layers.list(map.first + (row * w + column).unsigned_abs()),
                false => &[],
            };
            // On each side the first key beyond the point's own band, or none: that is what tells
            // a side on which all keys are its own from one that was not looked at.
            let band = i64::from(own_band(&maps, map, &receiver));
            for (found, sign) in [(hits.before, -1), (hits.behind, 1)] {
                let apart = |k: &u32| sign * (i64::from(*k) - i64::from(key));
                let beyond = list.iter().filter(|k| apart(k) > band).min_by_key(|k| apart(k));
                prop_assert_eq!(found, beyond.copied(), "{} {}", sign, band);
            }
        }
    }

    /// Nothing that lies on a triangle sees that triangle, from whatever direction it is seen.
    #[test]
    fn a_triangle_alone_is_not_in_its_own_way(
        direction in direction(),
        (corners, height) in triangle(),
        shares in prop::collection::vec([0.0..1.0_f64, 0.0..1.0], 1..12),
        resolution in 64..=200_u32,
    ) {
        let face = Face::new(corners);
        let mesh = Blockers { vertices: corners.to_vec(), triangles: vec![[0, 1, 2]] };
        let maps = uncropped(&[direction], &mesh, resolution);
        let layers = layers(&maps, &mesh).unwrap();
        let map = &maps.maps[0];
        let facing: f64 = (0..3).map(|i| f64::from(face.unit[i]) * direction[i]).sum();
        // As seen, its height is several pixels: snapping to sub-pixels turns slivers around.
        prop_assume!(height * facing.abs() > 6.0 * maps.pixel);
        for [a, b] in shares {
            let (a, b) = if a + b > 1.0 { (1.0 - a, 1.0 - b) } else { (a, b) };
            let point = [0, 1, 2].map(|i| {
                let [o, p, q] = [0, 1, 2].map(|c| f64::from(corners[c][i]));
                whole(o + a * (p - o) + b * (q - o))
            });
            let receiver = Receiver { point, normal: face.coarse, off: 1 };
            let hits = neighbours(&maps, map, &layers, &receiver);
            prop_assert_eq!([hits.before, hits.behind], [None; 2], "{:?}", receiver);
        }
    }
}

#[expect(clippy::cast_possible_truncation, reason = "within the lattice")]
pub(super) fn whole(x: f64) -> i32 {
    x.round() as i32
}

/// A triangle that is no sliver, anywhere, and its height over its longest side, or less.
pub(super) fn triangle() -> impl Strategy<Value = ([Point; 3], f64)> {
    let sides = [2e5..4e6_f64, 2e5..4e6];
    (any::<u64>(), sides, 0.6..2.5_f64, point()).prop_map(|(seed, [a, b], angle, from)| {
        let rotation = Rotation::of(seed, 1);
        let from = from.map(|c| f64::from(c / 4));
        let at = |v: [f64; 3]| {
            let v = rotation.turn(v);
            [0, 1, 2].map(|i| whole(from[i] + v[i]))
        };
        let (sin, cos) = angle.sin_cos();
        let corners = [at([0.0; 3]), at([a, 0.0, 0.0]), at([b * cos, b * sin, 0.0])];
        (corners, a * b * sin / (a + b))
    })
}

/// From the middle of a closed mesh something is seen both ways, in all directions.
#[test]
fn a_closed_mesh_is_seen_from_inside() {
    let mesh = sphere([4e6; 3], 20, 12);
    for frame in 0..3 {
        let maps = maps_of(&mesh, 64, 32, frame);
        let layers = layers(&maps, &mesh).unwrap();
        for map in &maps.maps {
            let receiver = Receiver {
                point: [12_345, -54_321, 99_999],
                normal: [0; 3],
                off: 0,
            };
            let hits = neighbours(&maps, map, &layers, &receiver);
            assert!(hits.before.is_some() && hits.behind.is_some(), "{map:?}");
        }
    }
}
