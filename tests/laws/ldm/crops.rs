//! Crops: maps that are cut to where receivers are hold what the whole ones do.

use proptest::prelude::*;
use triptych_spec::grid::Blockers;
use triptych_spec::grid::lattice::{Point, REACH};
use triptych_spec::ldm::{
    Map, Maps, RESOLUTION_MAX, Receiver, Rotation, chain, layers, neighbours,
};
use triptych_spec::raster::sample;

use super::{around, corners, direction, mesh, normal_of, point, uncropped};
use crate::config;

/// Two points of a box, as shares of its sides.
type Shares = ([f64; 3], [f64; 3]);

/// A point of a box.
fn inside([low, high]: [Point; 2], shares: [f64; 3]) -> Point {
    #[expect(clippy::cast_possible_truncation, reason = "within the box")]
    [0, 1, 2].map(|i| low[i] + (f64::from(high[i] - low[i]) * shares[i]) as i32)
}

/// A box anywhere, one inside the scene's, or one point.
fn bounds_of(scene: [Point; 2], kind: u8, ends: [Point; 2], (a, b): Shares) -> [Point; 2] {
    match kind {
        0 => around(&ends),
        1 => [inside(scene, a); 2],
        _ => around(&[inside(scene, a), inside(scene, b)]),
    }
}

fn shares() -> [std::ops::RangeInclusive<f64>; 3] {
    [0.0..=1.0, 0.0..=1.0, 0.0..=1.0]
}

/// All that both have in common but pixels.
fn check_axes(whole: &Maps, part: &Maps) -> Result<(), TestCaseError> {
    let all = |m: &Maps| (m.bits, m.shifts, m.pixel.to_bits(), m.half, m.half_shift);
    prop_assert_eq!(all(whole), all(part));
    for (whole, part) in whole.maps.iter().zip(&part.maps) {
        prop_assert_eq!(whole.rows, part.rows);
        prop_assert_eq!(whole.planes, part.planes);
        prop_assert_eq!(whole.origin[2], part.origin[2]);
    }
    Ok(())
}

/// The pixels of the whole map that a box covers, by its corners: where they begin, and how many.
fn covered(maps: &Maps, map: &Map, bounds: [Point; 2]) -> [[i32; 2]; 2] {
    let places = corners(bounds).map(|corner| maps.place(map, corner));
    let sides = [map.size.width, map.size.height].map(u32::cast_signed);
    let ends = [0, 1].map(|axis| {
        let pixels = places.map(|place| place[axis] >> maps.bits);
        let between = |n: &i32| pixels.iter().any(|p| p <= n) && pixels.iter().any(|p| p >= n);
        let mut held = (0..sides[axis]).filter(between);
        held.next().map(|first| (first, 1 + held.count()))
    });
    let [Some(x), Some(y)] = ends else {
        return [[0; 2]; 2];
    };
    let sides = [x.1, y.1].map(|n| i32::try_from(n).unwrap());
    [[x.0, y.0], sides]
}

/// Each map of `part` is a rectangle of the same map of `whole`: just the pixels that the box
/// covers, with the same lists.
fn check_part(
    whole: &Maps,
    part: &Maps,
    mesh: &Blockers,
    bounds: [Point; 2],
) -> Result<(), TestCaseError> {
    check_axes(whole, part)?;
    let all = layers(whole, mesh).unwrap();
    let few = layers(part, mesh).unwrap();
    let linked = chain(part, mesh, u32::MAX).unwrap();
    let mut first = 0;
    for (w, p) in whole.maps.iter().zip(&part.maps) {
        prop_assert_eq!(p.first, first);
        let [begin, sides] = covered(whole, w, bounds);
        prop_assert_eq!([p.size.width, p.size.height].map(u32::cast_signed), sides);
        first += p.size.width * p.size.height;
        if sides == [0; 2] {
            continue;
        }
        let origin = [0, 1].map(|axis| w.origin[axis] + (begin[axis] << whole.bits));
        prop_assert_eq!([p.origin[0], p.origin[1]], origin);
        let [column, row] = begin.map(i32::cast_unsigned);
        for (y, x) in (0..p.size.height).flat_map(|y| (0..p.size.width).map(move |x| (y, x))) {
            let own = p.first + y * p.size.width + x;
            let there = all.list(w.first + (row + y) * w.size.width + column + x);
            prop_assert_eq!(few.list(own), there);
            prop_assert_eq!(linked.list(own as usize), there);
        }
    }
    prop_assert_eq!(part.pixels, first);
    Ok(())
}

proptest! {
    #![proptest_config(config(1500))]

    /// A receiver in its box finds the same in a map that is cropped to it and in the whole one,
    /// of which that is a part.
    #[test]
    fn crops(
        directions in prop::collection::vec(direction(), 1..3),
        mesh in mesh(),
        resolution in 8..=32_u32,
        (kind, ends, split) in (0..4_u8, [point(), point()], (shares(), shares())),
        asked in prop::collection::vec((shares(), any::<prop::sample::Index>(), any::<bool>()), 1..8),
    ) {
        let scene = around(&mesh.vertices);
        let bounds = bounds_of(scene, kind, ends, split);
        let whole = uncropped(&directions, &mesh, resolution);
        let part = Maps::new(&directions, scene, bounds, resolution).unwrap();
        check_part(&whole, &part, &mesh, bounds)?;
        let [all, few] = [&whole, &part].map(|maps| layers(maps, &mesh).unwrap());
        for (shares, triangle, on) in asked {
            let triangle = u32::try_from(triangle.index(mesh.triangles.len())).unwrap();
            let normal = if on { normal_of(&mesh, triangle) } else { [0; 3] };
            let receiver = Receiver { point: inside(bounds, shares), normal, off: 1 };
            for (w, p) in whole.maps.iter().zip(&part.maps) {
                let found = neighbours(&part, p, &few, &receiver);
                prop_assert_eq!(neighbours(&whole, w, &all, &receiver), found);
            }
        }
    }
}

/// Whatever reaches beyond the scene takes nothing away; what is beside it leaves no pixels.
#[test]
fn boxes_beyond_the_scene() {
    let scene = [[-1000, -2000, -3000], [4000, 5000, 6000]];
    let set: Vec<[f64; 3]> = (0..9)
        .map(|n| Rotation::of(1, n).turn([0.0, 0.6, 0.8]))
        .collect();
    let whole = Maps::new(&set, scene, scene, 20).unwrap();
    let all = Maps::new(&set, scene, [[-REACH; 3], [REACH; 3]], 20).unwrap();
    assert_eq!(whole, all);
    let above = [[0, 0, 100_000], [0, 0, 200_000]];
    let beside = Maps::new(&[[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]], scene, above, 20).unwrap();
    let sizes: Vec<[u32; 2]> = beside
        .maps
        .iter()
        .map(|m| [m.size.width, m.size.height])
        .collect();
    assert_eq!(sizes, [[0, 0], [1, 1]]);
    assert_eq!([beside.maps[1].first, beside.pixels], [0, 1]);
}

/// At every pixel of the largest maps, edge functions between any two places of the scene fit in
/// 31 bits and a sign: the most there is comes near what is derived at [`RESOLUTION_MAX`].
#[test]
fn edges_fit_beyond_a_crop() {
    let end = REACH;
    let half = 0.5_f64.sqrt();
    let mut set = vec![
        [0.0, 0.0, 1.0],
        [1.0 / 3.0_f64.sqrt(); 3],
        [half, half, 0.0],
    ];
    set.extend((1..60).map(|n| Rotation::of(3, n).turn([0.0, 0.0, 1.0])));
    let cube = [[-end; 3], [end; 3]];
    let square = [[-end, -end, 0], [end, end, 0]];
    let line = [[-end, 0, 0], [end, 0, 0]];
    let mut most = 0;
    for (scene, resolution) in [cube, square, line]
        .into_iter()
        .flat_map(|s| [8, 25, 362, 363, 724].map(|r| (s, r)))
    {
        assert!(resolution <= RESOLUTION_MAX);
        let small = corners(scene).map(|corner| [corner; 2]);
        for receivers in small.into_iter().chain([scene, cube]) {
            let maps = Maps::new(&set, scene, receivers, resolution).unwrap();
            for map in &maps.maps {
                let places = corners(scene).map(|corner| maps.place(map, corner));
                most = most.max(largest_edge(&maps, map, &places));
            }
        }
    }
    // A quarter turn from the sides of a square map, a corner of it is the farthest: 3/4 of it.
    assert!((1_610_000_000..1_792_000_000).contains(&most), "{most}");
}

/// The largest edge function of two places at the corners of a map.
fn largest_edge(maps: &Maps, map: &Map, places: &[Point; 8]) -> i64 {
    let ends = [map.size.width, map.size.height].map(|n| [0, n - 1].map(|n| sample(n, maps.bits)));
    let pixels = (0..4).map(|n| [ends[0][n & 1], ends[1][n >> 1]]);
    for axis in 0..2 {
        let along = places.map(|place| place[axis]);
        let wide = along.iter().max().unwrap() - along.iter().min().unwrap();
        assert!(wide <= 46_338, "products of their differences: {wide}");
    }
    let mut most = 0;
    for [px, py] in pixels {
        let from = places.map(|[x, y, _]| [i64::from(x) - px, i64::from(y) - py]);
        for [ax, ay] in from {
            assert!(ax.abs().max(ay.abs()) < 1 << 16, "{ax} {ay}");
            most = from
                .iter()
                .fold(most, |m, [bx, by]| m.max((ax * by - ay * bx).abs()));
        }
    }
    most
}

/// Triangles through the whole lattice, drawn into a corner of the finest map.
#[test]
fn a_corner_of_the_finest_map() {
    let end = triptych_spec::grid::lattice::EXTENT;
    let scene = [[-end; 3], [end; 3]];
    let mesh = Blockers {
        vertices: corners(scene).to_vec(),
        triangles: vec![
            [0, 1, 7],
            [2, 5, 6],
            [3, 4, 0],
            [1, 2, 4],
            [7, 0, 5],
            [6, 3, 1],
        ],
    };
    let set = [Rotation::of(5, 1).turn([0.0, 0.0, 1.0]), [0.0, 0.0, -1.0]];
    let whole = uncropped(&set, &mesh, RESOLUTION_MAX);
    for corner in corners(scene) {
        let bounds = around(&[corner, corner.map(|c| c / 8 * 7)]);
        let part = Maps::new(&set, scene, bounds, RESOLUTION_MAX).unwrap();
        assert!(
            part.pixels > 1000 && part.pixels < whole.pixels / 20,
            "{}",
            part.pixels
        );
        check_part(&whole, &part, &mesh, bounds).unwrap();
    }
}
