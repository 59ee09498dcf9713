//! Laws of cameras.

use proptest::prelude::*;
use triptych_spec::camera::{Camera, CameraError, ENTRY_MAX, Projection};

use super::config;

/// Looks along -y from above, with x to the right and -z up: nothing is where it would be
/// by default.
fn camera(projection: Projection) -> Camera {
    Camera {
        eye: [1.0, 7.0, 3.0],
        target: [1.0, 2.0, 3.0],
        up: [0.0, 5.0, -1.0],
        projection,
        near: 2.0,
        far: 10.0,
    }
}

const PERSPECTIVE: Projection = Projection::Perspective { fov: 90.0 };
const ORTHOGRAPHIC: Projection = Projection::Orthographic { height: 8.0 };

/// A point so far to the right, up and in front, on the screen: x, y, depth and w.
fn seen(camera: &Camera, [right, up, front]: [f64; 3]) -> [f64; 4] {
    let matrix = camera.matrix(2.0).expect("a sound camera");
    let [x, y, z] = [1.0 + right, 7.0 - front, 3.0 - up];
    let clip = matrix
        .rows
        .map(|row| row[0] * x + row[1] * y + row[2] * z + row[3]);
    [
        clip[0] / clip[3],
        clip[1] / clip[3],
        clip[2] / clip[3],
        clip[3],
    ]
}

fn near(seen: [f64; 4], expected: [f64; 4]) {
    let close = |i: usize| (seen[i] - expected[i]).abs() < 1e-14;
    assert!((0..4).all(close), "{seen:?}, must be {expected:?}");
}

#[test]
fn a_perspective_divides_by_the_distance() {
    let camera = camera(PERSPECTIVE);
    // The right angle spans as much as the distance to either side; twice that across.
    near(seen(&camera, [0.0, 0.0, 2.0]), [0.0, 0.0, 0.0, 2.0]);
    near(seen(&camera, [0.0, 0.0, 10.0]), [0.0, 0.0, 1.0, 10.0]);
    near(seen(&camera, [8.0, 4.0, 4.0]), [1.0, 1.0, 0.625, 4.0]);
    near(seen(&camera, [-2.0, -1.0, 4.0]), [-0.25, -0.25, 0.625, 4.0]);
    // A narrower one, that spans half the distance to either side.
    let fov = 2.0 * 0.5_f64.atan().to_degrees();
    let narrow = self::camera(Projection::Perspective { fov });
    near(seen(&narrow, [4.0, 2.0, 4.0]), [1.0, 1.0, 0.625, 4.0]);
}

/// Right (1, -2, 2) / 3, up (2, 2, 1) / 3, forward (2, -1, -2) / 3: no component is zero.
#[test]
fn a_tilted_camera_sees_as_an_upright_one_does() {
    let tilted = Camera {
        eye: [1.0, 2.0, 3.0],
        target: [3.0, 1.0, 1.0],
        up: [4.0, 4.0, 2.0],
        ..camera(PERSPECTIVE)
    };
    let [right, up, front] = [8.0 / 3.0, 4.0 / 3.0, 4.0 / 3.0];
    let at = [
        1.0 + right + 2.0 * up + 2.0 * front,
        2.0 - 2.0 * right + 2.0 * up - front,
        3.0 + 2.0 * right + up - 2.0 * front,
    ];
    let matrix = tilted.matrix(2.0).expect("a sound camera");
    let clip = matrix
        .rows
        .map(|r| r[0] * at[0] + r[1] * at[1] + r[2] * at[2] + r[3]);
    let w = clip[3];
    near(
        [clip[0] / w, clip[1] / w, clip[2] / w, w],
        [1.0, 1.0, 0.625, 4.0],
    );
}

#[test]
fn an_orthographic_view_does_not() {
    let camera = camera(ORTHOGRAPHIC);
    near(seen(&camera, [0.0, 0.0, 2.0]), [0.0, 0.0, 0.0, 1.0]);
    near(seen(&camera, [8.0, 4.0, 10.0]), [1.0, 1.0, 1.0, 1.0]);
    near(seen(&camera, [-2.0, -1.0, 4.0]), [-0.25, -0.25, 0.25, 1.0]);
}

/// The camera after a change, and what it says.
fn refused(change: impl FnOnce(&mut Camera)) -> CameraError {
    let mut changed = camera(PERSPECTIVE);
    change(&mut changed);
    changed.matrix(1.0).expect_err("no camera")
}

#[test]
fn numbers_that_make_no_camera_are_refused_by_name() {
    let coordinate = CameraError::OutOfRange("a coordinate");
    assert_eq!(refused(|c| c.eye[0] = f64::NAN), coordinate);
    assert_eq!(refused(|c| c.target[1] = f64::INFINITY), coordinate);
    assert_eq!(refused(|c| c.up[2] = f64::NEG_INFINITY), coordinate);
    let order = CameraError::Projection("near must be less than far");
    assert_eq!(refused(|c| c.near = c.far), order);
    assert_eq!(refused(|c| c.near = 11.0), order);
    assert_eq!(refused(|c| c.near = f64::NEG_INFINITY), order);
    assert_eq!(refused(|c| c.far = f64::INFINITY), order);
    assert_eq!(refused(|c| c.far = f64::NAN), order);
    let positive = CameraError::Projection("near must be positive for a perspective");
    assert_eq!(refused(|c| c.near = 0.0), positive);
    for wrong in [0.0, -1.0, 180.0, 200.0, f64::NAN] {
        let fov = CameraError::Projection("fov must lie in (0, 180) degrees");
        let projection = Projection::Perspective { fov: wrong };
        assert_eq!(refused(|c| c.projection = projection), fov, "{wrong}");
    }
    for wrong in [0.0, -1.0, f64::INFINITY, f64::NAN] {
        let height = CameraError::Projection("height must be positive");
        let projection = Projection::Orthographic { height: wrong };
        assert_eq!(refused(|c| c.projection = projection), height, "{wrong}");
    }
}

#[test]
fn an_orthographic_view_may_begin_behind_the_eye() {
    let mut behind = camera(ORTHOGRAPHIC);
    behind.near = -2.0;
    near(seen(&behind, [0.0, 0.0, -2.0]), [0.0, 0.0, 0.0, 1.0]);
    behind.near = 0.0;
    near(seen(&behind, [0.0, 0.0, 0.0]), [0.0, 0.0, 0.0, 1.0]);
}

#[test]
fn a_view_needs_two_directions() {
    let none = CameraError::NoDirection;
    assert_eq!(refused(|c| c.target = c.eye), none, "nowhere to look");
    assert_eq!(refused(|c| c.up = [0.0; 3]), none, "no up");
    assert_eq!(refused(|c| c.up = [0.0, 3.0, 0.0]), none, "up is back");
    assert_eq!(refused(|c| c.up = [0.0, 1.0, 5e-10]), none, "nearly so");
    let mut tilted = camera(PERSPECTIVE);
    tilted.up = [0.0, 1.0, -2e-9];
    near(seen(&tilted, [8.0, 4.0, 4.0]), [1.0, 1.0, 0.625, 4.0]);
}

#[test]
fn a_matrix_beyond_the_range_is_refused() {
    let small = |height: f64| {
        let mut small = camera(Projection::Orthographic { height });
        (small.eye, small.target) = ([0.0; 3], [0.0, -1.0, 0.0]);
        small.matrix(1.0)
    };
    let beyond = Err(CameraError::OutOfRange("the matrix"));
    assert_eq!(small(1.9 / ENTRY_MAX), beyond);
    let within = small(2.1 / ENTRY_MAX).expect("within the range");
    assert!(within.rows[0][0] > 0.9 * ENTRY_MAX, "{within:?}");
}

proptest! {
    #![proptest_config(config(500))]

    /// Lengths say nothing: of the way to the target, of up, from 1e-300 to 1e300.
    #[test]
    fn directions_have_no_length(exponent in -300_i32..300) {
        let scale = 10_f64.powi(exponent);
        let mut scaled = camera(PERSPECTIVE);
        scaled.up = scaled.up.map(|x| x * scale);
        let matrix = |camera: &Camera| camera.matrix(2.0).expect("a sound camera");
        let (seen, expected) = (matrix(&scaled), matrix(&camera(PERSPECTIVE)));
        for (seen, expected) in seen.rows.iter().flatten().zip(expected.rows.iter().flatten()) {
            prop_assert!((seen - expected).abs() < 1e-13, "{seen} {expected}");
        }
    }
}
