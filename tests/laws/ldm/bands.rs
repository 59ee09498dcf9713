//! A point's own layers: how far their keys may be from its own.

use proptest::prelude::*;
use proptest::test_runner::Config;
use triptych_spec::grid::Blockers;
use triptych_spec::grid::lattice::Point;
use triptych_spec::ldm::{
    Hits, KEYS_PER_STEP, Layers, Map, Maps, OFF_MAX, PLANE_BITS, RESOLUTION_MAX, RESOLUTION_MIN,
    Receiver, Rotation, layers, neighbours, own_band,
};
use triptych_spec::rsm::Face;

use super::places::{axes, dot};
use super::traces::{triangle, whole};
use super::{around, direction};
use crate::config;

/// Where a point is in a map before it is rounded, in sub-pixels.
fn unrounded(maps: &Maps, map: &Map, point: Point) -> [f64; 2] {
    [0, 1].map(|axis| {
        let terms = (0..3).map(|i| i64::from(map.rows[axis][i]) * i64::from(point[i]));
        let scale = 2.0_f64.powi(-maps.shifts[0].cast_signed());
        terms.sum::<i64>() as f64 * scale - f64::from(map.origin[axis])
    })
}

/// The shares of three corners that a point in their plane has.
fn shares(corners: [[f64; 2]; 3], p: [f64; 2]) -> [f64; 3] {
    let area =
        |[a, b, c]: [[f64; 2]; 3]| (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    let [a, b, c] = corners;
    [[p, b, c], [a, p, c], [a, b, p]].map(|part| area(part) / area(corners))
}

/// A point nearby whose place is rounded by nearly a half along both axes, up or down.
fn nudged(maps: &Maps, point: Point, up: [bool; 2]) -> Point {
    let map = &maps.maps[0];
    let at = unrounded(maps, map, point);
    let step = maps.pixel / f64::from(1 << maps.bits);
    let by = [0, 1].map(|axis| {
        let target = at[axis].floor() + if up[axis] { 0.52 } else { 0.48 };
        (target - at[axis]) * step
    });
    [0, 1, 2].map(|i| {
        let along = |axis: usize| f64::from(map.planes[axis][i]) / 16_384.0 * by[axis];
        whole(f64::from(point[i]) + along(0) + along(1))
    })
}

proptest! {
    #![proptest_config(Config { max_global_rejects: u32::MAX, ..config(1000) })]

    /// Nothing that lies on a triangle sees it from the very corner of a pixel, which is as far
    /// from its middle as can be; corners of triangles are rounded against that, too.
    #[test]
    fn corners_of_pixels(
        direction in direction(),
        (corners, height) in triangle(),
        worst in any::<[bool; 2]>(),
        near in prop::collection::vec((0..3_usize, 0.0..0.5_f64, 0.0..0.5_f64), 8),
        resolution in 25..=200_u32,
    ) {
        let [low, high] = around(&corners);
        let bounds = [low.map(|c| c - 200_000), high.map(|c| c + 200_000)];
        let maps = Maps::new(&[direction], bounds, bounds, resolution).unwrap();
        let corners = corners.map(|corner| nudged(&maps, corner, worst));
        let face = Face::new(corners);
        let mesh = Blockers { vertices: corners.to_vec(), triangles: vec![[0, 1, 2]] };
        let layers = layers(&maps, &mesh).unwrap();
        let map = &maps.maps[0];
        let facing: f64 = (0..3).map(|i| f64::from(face.unit[i]) * direction[i]).sum();
        prop_assume!(height * facing.abs() > 6.0 * maps.pixel);
        let places = corners.map(|corner| unrounded(&maps, map, corner));
        let side = f64::from(1 << maps.bits);
        for (corner, b, c) in near {
            let [p, q, r] = [0, 1, 2].map(|n| places[(corner + n) % 3]);
            let border = |axis: usize| {
                let at = p[axis] + b * (q[axis] - p[axis]) + c * (r[axis] - p[axis]);
                (at / side).round() * side
            };
            // Halves go up: a little more than half below the border is across it.
            for off in [[-0.45, -0.45], [-0.55, -0.45], [-0.45, -0.55], [-0.55, -0.55]] {
                let target = [0, 1].map(|axis| border(axis) + off[axis]);
                let shares = shares(places, target);
                if shares.iter().any(|share| *share < 0.0) {
                    continue;
                }
                let point = [0, 1, 2].map(|i| {
                    whole((0..3).map(|n| shares[n] * f64::from(corners[n][i])).sum())
                });
                let receiver = Receiver { point, normal: face.coarse, off: 1 };
                let hits = neighbours(&maps, map, &layers, &receiver);
                prop_assert_eq!([hits.before, hits.behind], [None; 2], "{:?}", receiver);
            }
        }
    }

    /// A point that was moved off a triangle does not see it, however steep that is in the map:
    /// the triangle is looked for where the point is.
    #[test]
    fn a_point_off_its_triangle_does_not_see_it(
        direction in direction(),
        (corners, height) in triangle(),
        [b, c] in prop::array::uniform2(0.0..0.5_f64),
        by in prop::array::uniform3(-64..=64_i32),
        resolution in 100..=RESOLUTION_MAX,
    ) {
        // So small that pixels are hardly wider than the point is off.
        let corners = corners.map(|corner| corner.map(|c| c >> 5));
        let [low, high] = around(&corners);
        let bounds = [low.map(|c| c - 200), high.map(|c| c + 200)];
        let maps = Maps::new(&[direction], bounds, bounds, resolution).unwrap();
        let face = Face::new(corners);
        let mesh = Blockers { vertices: corners.to_vec(), triangles: vec![[0, 1, 2]] };
        let layers = layers(&maps, &mesh).unwrap();
        let map = &maps.maps[0];
        let facing: f64 = (0..3).map(|i| f64::from(face.unit[i]) * direction[i]).sum();
        let [x, y] = [0, 1].map(|axis| {
            let along = (0..3).map(|i| f64::from(map.planes[axis][i]) * f64::from(face.unit[i]));
            along.sum::<f64>().abs() / 16_384.0
        });
        // What is steeper is taken for this steep.
        prop_assume!(height > 0.0 && (x + y) < 120.0 * facing.abs());
        let at = |i: usize| {
            let [p, q, r] = corners.map(|corner| f64::from(corner[i]));
            whole(p + b * (q - p) + c * (r - p)) + by[i]
        };
        let off = by.map(i32::unsigned_abs).into_iter().max().unwrap_or(0) + 1;
        let receiver = Receiver { point: [at(0), at(1), at(2)], normal: face.coarse, off };
        let hits = neighbours(&maps, map, &layers, &receiver);
        prop_assert_eq!([hits.before, hits.behind], [None; 2], "{:?}", receiver);
    }

    /// A band holds what a surface of its slope may be off within half a pixel and a sub-pixel,
    /// and what roundings and the point's own distance add; it is no wider than what roundings of
    /// normals and of itself come to.
    #[test]
    fn bands_are_as_wide_as_slopes_are_steep(
        (direction, normal) in (direction(), direction()),
        off in prop_oneof![3 => 0..200_u32, 1 => 0..=OFF_MAX],
        resolution in RESOLUTION_MIN..=RESOLUTION_MAX,
        size in 1..8_388_608_i32,
        on in prop::bool::weighted(0.9),
    ) {
        let bounds = [[-size; 3], [size; 3]];
        let maps = Maps::new(&[direction], bounds, bounds, resolution).unwrap();
        let coarse = normal.map(|c| whole(16_384.0 * c));
        let normal_of = if on { coarse } else { [0; 3] };
        let receiver = Receiver { point: [0; 3], normal: normal_of, off };
        let band = f64::from(own_band(&maps, &maps.maps[0], &receiver));
        let keys = f64::from(KEYS_PER_STEP);
        // Its own key by a half, those of corners by a half, theirs at the pixel by one.
        let least = keys * 3.0_f64.sqrt() * f64::from(off) + 2.0;
        let most = 14.0 * f64::from(off) + 4.0;
        if !on {
            prop_assert!((least..=most).contains(&band), "{} {} {}", least, band, most);
            return Ok(());
        }
        let [x, y, z] = axes(direction).map(|axis| dot(axis, normal).abs());
        let half = maps.pixel * keys * (0.5 + f64::from(maps.bits).exp2().recip());
        // By how much a dot product of vectors that are rounded in each component may be off.
        let rounded = 28_380.0 / f64::from(1 << (2 * PLANE_BITS));
        let cut = 256.0 / f64::from(1 << (2 * PLANE_BITS));
        let lowest = z - 2.0 * rounded - cut;
        let steepest = match lowest > 0.0 {
            true => ((x + y + 4.0 * rounded + cut) / lowest + 1.0 / 256.0).min(127.0),
            false => 127.0,
        };
        let largest = f64::from(1 << 30);
        let aside = keys * 3.0_f64.sqrt() * f64::from(off);
        let least = least + ((x + y) / z).min(127.0) * (half + aside);
        // Half a pixel is rounded up to keys, and to 16 bits.
        let aside = 14.0 * f64::from(off);
        let most = most + steepest * ((half + 1.0) * (1.0 + 1.0 / 32_768.0) + aside) + 2.0;
        prop_assert!(band >= least.min(largest), "{} < {}", band, least);
        prop_assert!(band <= most.min(largest + 127.0 * 14.0 * f64::from(OFF_MAX)), "{} > {}", band, most);
    }
}

/// However normals and axes are rounded, a band is no narrower than its surface's slope needs:
/// where surfaces are nearly level, slopes have the fewest digits.
#[test]
fn rounded_normals_do_not_narrow_a_band() {
    let turned = |seed: u64, n: u32, v: [f64; 3]| Rotation::of(seed, n).turn(v);
    let set: Vec<[f64; 3]> = (1..200).map(|n| turned(8, n, [0.0, 0.0, 1.0])).collect();
    let bounds = [[-8_000_000; 3], [8_000_000; 3]];
    let maps = Maps::new(&set, bounds, bounds, RESOLUTION_MIN).unwrap();
    let half = maps.pixel * f64::from(KEYS_PER_STEP) * (0.5 + 1.0 / 128.0);
    for (map, direction) in maps.maps.iter().zip(&set) {
        let axes = axes(*direction);
        for n in 0..500 {
            let aside = turned(9, n, [0.0, 0.3, 0.0]);
            let normal = [0, 1, 2].map(|i| direction[i] + aside[i]);
            let long = dot(normal, normal).sqrt();
            let normal = normal.map(|c| c / long);
            let receiver = Receiver {
                point: [0; 3],
                normal: normal.map(|c| whole(16_384.0 * c)),
                off: 0,
            };
            let [x, y, z] = axes.map(|axis| dot(axis, normal).abs());
            let band = f64::from(own_band(&maps, map, &receiver));
            assert!(band >= (x + y) / z * half, "{band} {normal:?} {map:?}");
        }
    }
}

/// Keys at the ends of a band are the point's own; the next ones are not.
#[test]
fn the_ends_of_a_band_are_in_it() {
    let bounds = [[-1_000_000; 3], [1_000_000; 3]];
    let maps = Maps::new(&[[0.0, 0.6, 0.8]], bounds, bounds, 40).unwrap();
    let map = &maps.maps[0];
    for normal in [[0; 3], [0, 0, 16_384], [9_459; 3]] {
        let receiver = Receiver {
            point: [77, -5_555, 1_234],
            normal,
            off: 3,
        };
        let [x, y, key] = maps.place(map, receiver.point);
        let band = own_band(&maps, map, &receiver);
        let pixel =
            (y >> maps.bits).cast_unsigned() * map.size.width + (x >> maps.bits).cast_unsigned();
        let found = |aparts: &[i32]| {
            let keys: Vec<u32> = aparts.iter().map(|a| (key + a).cast_unsigned()).collect();
            let count = u32::try_from(keys.len()).unwrap();
            let offset = |at: u32| if at <= pixel { 0 } else { count };
            let offsets = (0..=maps.pixels).map(offset).collect();
            let layers = Layers { offsets, keys };
            let Hits { before, behind, .. } = neighbours(&maps, map, &layers, &receiver);
            [before, behind].map(|found| found.map(|k| k.cast_signed() - key))
        };
        let ends = [-band, -band, -1, 0, 1, band, band];
        assert_eq!(found(&ends), [None; 2]);
        let beyond = [&[-band - 2, -band - 1], &ends[..], &[band + 1, band + 2]].concat();
        assert_eq!(found(&beyond), [Some(-band - 1), Some(band + 1)]);
    }
}
