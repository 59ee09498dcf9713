//! What is off by twice its bound is outside.

use super::*;

#[test]
fn twice_the_bound_of_snap_is_outside() {
    for (name, scene) in random() {
        let run = in_f32(&scene, BITS);
        let polygons = run.polygons.as_ref().expect("the spec's");
        let own = Judged::new(&scene, &run).snap;
        for axis in 0..3 {
            let mut worse = run.clone();
            let mut moved = 0;
            for (snapped, corner) in worse.primitives.snapped.iter_mut().zip(&polygons.corners) {
                let number = vertex::grid_position(exact(*corner), BITS)[axis];
                // Rounding takes up to one unit of the difference away, and z has a
                // factor of 1 + 2^-31 to itself.
                let by = (2.0 * number.bound + 2.0).ceil();
                let target = f64::from(snapped[axis]) + by;
                let low_enough = target < f64::from(last(axis, scene.size));
                if number.value >= 0.0 && low_enough {
                    #[expect(clippy::cast_possible_truncation, reason = "below an i32")]
                    let target = target as i32;
                    snapped[axis] = target;
                    moved += 1;
                }
            }
            let report = Judged::new(&scene, &worse).snap;
            if own.admitted == 0 {
                assert_eq!(report.outside, moved, "{name}, axis {axis}: {report}");
            }
            assert!(
                moved > 0 && report.outside > 0,
                "{name}, axis {axis}: nothing moved"
            );
        }
    }
}

/// Corners that were cut by twice their bound, others by the least that there is.
#[test]
fn twice_the_bound_of_clip_is_outside() {
    for (name, scene) in random() {
        let run = in_f32(&scene, BITS);
        let polygons = run.polygons.as_ref().expect("the spec's");
        let positions: Vec<_> = run.positions.iter().map(|p| exact(*p)).collect();
        let must = vertex::clip(&scene, &positions);
        assert_eq!(must.offsets, polygons.offsets, "{name}");
        let own = Judged::new(&scene, &run).clip;
        for axis in 0..4 {
            let mut worse = polygons.clone();
            let (mut moved, mut cut) = (0, 0);
            for (corner, number) in worse.corners.iter_mut().zip(&must.corners) {
                let number = number[axis];
                #[expect(clippy::cast_possible_truncation, reason = "by a quarter of the bound")]
                let off = (number.value + 2.0 * number.bound) as f32;
                let off = if number.bound > 0.0 {
                    off
                } else {
                    off.next_up()
                };
                if off.is_finite() {
                    corner[axis] = off;
                    moved += 1;
                    cut += u64::from(number.bound > 0.0);
                }
            }
            let report = compare_clip(&scene, &run.positions, &worse);
            if own.admitted == 0 {
                assert_eq!(report.outside, moved, "{name}, axis {axis}: {report}");
            }
            assert!(report.outside > 0, "{name}, axis {axis}: nothing moved");
            assert!(cut > 0, "{name}, axis {axis}: nothing is cut");
        }
    }
}
