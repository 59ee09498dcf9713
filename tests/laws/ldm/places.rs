//! Places: a map's axes, and where points are along them.

use proptest::prelude::*;
use triptych_spec::grid::lattice::Point;
use triptych_spec::ldm::{KEYS_PER_STEP, Map, Maps, PLANE_BITS, RESOLUTION_MAX, RESOLUTION_MIN};

use super::{around, corners, direction, point};
use crate::config;

/// How far components of unit vectors may be off in `f64`, the spec's and ours together: fewer
/// than 64 roundings of numbers of at most 2, by 2^-53 of them each.
const FLOATS: f64 = 1.0 / 70_368_744_177_664.0;

/// Unit vectors along columns, rows, and to the viewer, from what they are: the axes of space
/// turned the shortest way that takes the nearer pole of z to the direction (rotation about an
/// axis by Rodrigues); with z turned around y is too, so that they stay right-handed.
pub(super) fn axes([x, y, z]: [f64; 3]) -> [[f64; 3]; 3] {
    let pole = if z < 0.0 { -1.0 } else { 1.0 };
    let (sin, cos) = (x.hypot(y), z.abs());
    let about = match sin > 0.0 {
        true => [-pole * y / sin, pole * x / sin, 0.0],
        false => [1.0, 0.0, 0.0],
    };
    let turned = |v: [f64; 3]| {
        let across = cross(about, v);
        let along = dot(about, v) * (1.0 - cos);
        [0, 1, 2].map(|i| v[i] * cos + across[i] * sin + about[i] * along)
    };
    [[1.0, 0.0, 0.0], [0.0, pole, 0.0], [0.0, 0.0, pole]].map(turned)
}

pub(super) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|i| a[i] * b[i]).sum()
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [(1, 2), (2, 0), (0, 1)].map(|(j, k)| a[j] * b[k] - a[k] * b[j])
}

/// Sub-pixels and keys to a step of the lattice.
fn units([low, high]: [Point; 2], resolution: u32, bits: u32) -> [f64; 3] {
    let side = |i: usize| f64::from(high[i]) - f64::from(low[i]);
    let diagonal = (0..3).map(|i| side(i) * side(i)).sum::<f64>().sqrt();
    let pixel = (diagonal / f64::from(resolution)).max(128.0);
    let across = f64::from(1 << bits) / pixel;
    [across, across, f64::from(KEYS_PER_STEP)]
}

fn resolution() -> impl Strategy<Value = u32> {
    prop_oneof![RESOLUTION_MIN..=64_u32, 300..=RESOLUTION_MAX]
}

/// Rows and planes are the axes, each component rounded by at most half; none of a row's 30 bits
/// is wasted.
fn check_axes(maps: &Maps, map: &Map, units: [f64; 3]) -> Result<(), TestCaseError> {
    let axes = axes(map.direction);
    for (i, j) in [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)] {
        let right = f64::from(u8::from(i == j));
        prop_assert!((dot(axes[i], axes[j]) - right).abs() < FLOATS);
    }
    let volume = dot(cross(axes[0], axes[1]), axes[2]);
    prop_assert!((volume - 1.0).abs() < 2.0 * FLOATS);
    prop_assert!(dot(axes[2], map.direction) > 1.0 - FLOATS);
    for axis in 0..3 {
        let long = f64::from(1_u32 << PLANE_BITS);
        for (c, exact) in map.planes[axis].into_iter().zip(axes[axis]) {
            let off = f64::from(c) - long * exact;
            prop_assert!(off.abs() <= 0.5 + long * FLOATS, "{}: {}", axis, off);
        }
        // Shifted down, a row is as long as there are sub-pixels, or keys, to a step.
        let shift = maps.shifts[usize::from(axis == 2)];
        let long = units[axis] * 2.0_f64.powi(shift.cast_signed());
        prop_assert!(
            (536_870_912.0..=1_073_741_824.0).contains(&long),
            "{}",
            long
        );
        let sign = if axis == 2 { -1.0 } else { 1.0 };
        for (c, exact) in map.rows[axis].into_iter().zip(axes[axis]) {
            let off = f64::from(c) - sign * long * exact;
            prop_assert!(off.abs() <= 0.5 + 2.0 * long * FLOATS, "{}: {}", axis, off);
        }
    }
    Ok(())
}

/// A point is where its projection is: the place is rounded by half. A row of at least 2^29 is
/// rounded by half in each component, so it moves a point by at most half of all of its
/// coordinates in 2^29.
fn check_place(maps: &Maps, map: &Map, p: Point, units: [f64; 3]) -> Result<(), TestCaseError> {
    let place = maps.place(map, p);
    let wide = p.map(f64::from);
    let size: f64 = wide.iter().map(|c| c.abs()).sum();
    let axes = axes(map.direction);
    for axis in 0..3 {
        let sign = if axis == 2 { -1.0 } else { 1.0 };
        let exact = sign * units[axis] * dot(axes[axis], wide);
        let off = f64::from(place[axis]) + f64::from(map.origin[axis]) - exact;
        let half_in_row = units[axis] * size * 0.5 / 536_870_912.0;
        let bound = 0.5 + half_in_row + 2.0 * units[axis] * size * FLOATS;
        prop_assert!(off.abs() <= bound, "{}: {} over {}", axis, off, bound);
    }
    Ok(())
}

proptest! {
    #![proptest_config(config(2000))]

    /// Points are where they should be; those of the box are in the map, no pixel of which is at
    /// a border for nothing.
    #[test]
    fn places(
        directions in prop::collection::vec(direction(), 1..4),
        points in prop::collection::vec(point(), 1..12),
        resolution in resolution(),
    ) {
        let bounds = around(&points);
        let maps = Maps::new(&directions, bounds, bounds, resolution).unwrap();
        let units = units(bounds, resolution, maps.bits);
        prop_assert!((f64::from(1 << maps.bits) / maps.pixel / units[0] - 1.0).abs() < FLOATS);
        let mut first = 0;
        for map in &maps.maps {
            prop_assert_eq!(map.first, first);
            first += map.size.width * map.size.height;
            check_axes(&maps, map, units)?;
            let ends = [map.size.width, map.size.height].map(u32::cast_signed);
            for p in &points {
                check_place(&maps, map, *p, units)?;
                let place = maps.place(map, *p);
                prop_assert!((0..2).all(|i| (0..ends[i]).contains(&(place[i] >> maps.bits))), "{:?} of {:?}", place, ends);
                prop_assert!(place[2] >= 0);
            }
            let places = corners(bounds).map(|corner| maps.place(map, corner));
            for axis in 0..2 {
                let pixels = places.map(|place| place[axis] >> maps.bits);
                prop_assert_eq!(pixels.iter().min(), Some(&0));
                prop_assert_eq!(pixels.iter().max(), Some(&(ends[axis] - 1)));
            }
            prop_assert_eq!(places.iter().map(|place| place[2]).min(), Some(0));
        }
        prop_assert_eq!(maps.pixels, first);
    }
}
