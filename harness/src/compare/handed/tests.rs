//! Drivers played by the spec: it clips, rounds and covers what they are handed.

use triptych_spec::matrix::Matrix;
use triptych_spec::raster::{Fragment, cover};
use triptych_spec::scene::{Scene, Size, Triangle, Vertex};
use triptych_spec::vertex::{clip, snap, transform};

use super::{Columns, HALF, Handed, Pairs, Place, reach};
use crate::cause::Cause;
use crate::compare::Judgement;

const SIZE: Size = Size {
    width: 48,
    height: 32,
};

/// A step of a grid of 8 bits.
const STEP: f64 = 1.0 / 256.0;

/// Triangles in clip space: in view, across the near and the far plane and far out of the
/// guard rectangle, and out of view.
fn scene() -> Scene {
    let triangles = [
        [[-0.7, -0.6, 0.2], [0.8, -0.5, 0.3], [0.1, 0.9, 0.9]],
        [[-0.9, -0.9, -0.5], [0.9, -0.3, 0.8], [0.0, 0.7, 0.4]],
        [[-0.5, 0.9, 1.4], [0.6, 0.8, 0.6], [0.2, -0.9, 0.1]],
        [[-900.0, -3.0, 0.5], [900.0, -2.0, 0.5], [0.3, 0.4, 0.5]],
        [[2.0, 2.0, 0.5], [3.0, 2.0, 0.5], [2.0, 3.0, 0.5]],
        [[-0.5, -0.5, 2.0], [0.5, -0.5, 2.0], [0.0, 0.5, 2.0]],
    ];
    let vertex = |position| Vertex {
        position,
        instance: 0,
    };
    let triangle = |t: u32| Triangle {
        vertices: [3 * t, 3 * t + 1, 3 * t + 2],
        instance: 0,
        primitive: t,
        colour: [0.0; 4],
    };
    Scene {
        samples: triptych_spec::raster::Samples::ONE,
        order: triptych_spec::abuffer::Order::Centroid,
        size: SIZE,
        instances: vec![Matrix::IDENTITY],
        vertices: triangles.into_iter().flatten().map(vertex).collect(),
        triangles: (0..6).map(triangle).collect(),
        background: [0.0; 3],
    }
}

/// What a driver makes of a scene that rounds to 8 bits.
fn driver(scene: &Scene) -> Vec<Fragment> {
    let snapped = snap(scene, &clip(scene, &transform(scene)), 8);
    let mut fragments = Vec::new();
    cover(&snapped, |f| {
        let prim = snapped.source[f.prim as usize];
        fragments.push(Fragment { prim, ..f });
    });
    fragments
}

fn judge(seen: &[Fragment]) -> Judgement {
    let [pairs, triangles] = Handed::new(&scene(), STEP).judge(seen);
    assert_eq!((triangles.compared, triangles.admitted), (6, 0));
    pairs
}

/// The scene after a change of a triangle's vertices.
fn changed(triangle: usize, change: impl Fn(&mut [f32; 3])) -> Vec<Fragment> {
    let mut scene = scene();
    let vertices = &mut scene.vertices[3 * triangle..3 * triangle + 3];
    vertices.iter_mut().for_each(|v| change(&mut v.position));
    driver(&scene)
}

#[test]
fn a_driver_that_is_right_agrees() {
    let judgement = judge(&driver(&scene()));
    assert_eq!(judgement.differ(), 0, "{:?}", judgement.described);
    assert!(judgement.compared > 1000, "{}", judgement.note);
    assert!(
        judgement.admitted * 20 < judgement.compared,
        "{}",
        judgement.note
    );
}

#[test]
fn corners_off_by_more_than_a_step_are_seen() {
    // 2^-5 pixels: eight steps, of which a sample on every eighth row or column sees one.
    let by = 2.0 / 48.0 / 8.0;
    let judgement = judge(&changed(0, |v| v[0] += by));
    assert_eq!(
        judgement.causes.keys().copied().collect::<Vec<_>>(),
        [Cause::Coverage]
    );
}

#[test]
fn planes_that_cut_elsewhere_are_seen() {
    for (triangle, by) in [(1, 0.05), (1, -0.05), (2, 0.05), (2, -0.05)] {
        let judgement = judge(&changed(triangle, |v| v[2] += by));
        assert!(
            judgement.causes.contains_key(&Cause::Coverage),
            "{triangle} {by}"
        );
    }
    // What is out of view must not be seen.
    let judgement = judge(&changed(5, |v| v[2] = 0.5));
    assert!(judgement.causes.contains_key(&Cause::Coverage));
}

#[test]
fn fragments_that_are_lost_and_come_twice_are_seen() {
    let clean = driver(&scene());
    let middle = clean
        .iter()
        .position(|f| f.prim == 0 && f.pixel == 16 * 48 + 24);
    let middle = middle.expect("it is covered");
    let mut lost = clean.clone();
    lost.remove(middle);
    assert_eq!(judge(&lost).causes, [(Cause::Coverage, 1)].into());
    let mut twice = clean.clone();
    twice.push(clean[middle]);
    assert_eq!(judge(&twice).causes, [(Cause::Duplicate, 1)].into());
    assert!(judge(&[]).differ() > 1000, "nothing is covered");
}

/// A corner in view so near the eye that its w is as small as rounding.
#[test]
fn what_cannot_be_judged_is_counted() {
    let mut scene = scene();
    // The eye is just behind the near plane, where z = 0.
    scene.instances[0].rows[3] = [0.0, 0.0, 1.0, 1e-6];
    scene.instances[0].rows[2] = [0.0, 0.0, 1.0, 0.0];
    let handed = Handed::new(&scene, STEP);
    let [pairs, triangles] = handed.judge(&driver(&scene));
    assert_eq!(pairs.differ(), 0, "{:?}", pairs.described);
    assert!(triangles.admitted > 0, "{}", triangles.note);
    assert!(triangles.note.contains("unjudged"), "{}", triangles.note);
    assert!(
        triangles.admitted < triangles.compared,
        "{}",
        triangles.note
    );
    assert_eq!(triangles.skipped, None, "others are judged");
    let none = Handed {
        size: SIZE,
        triangles: Vec::new(),
        places: vec![Place::Unjudged; 6],
    };
    let [pairs, triangles] = none.judge(&driver(&scene));
    assert_eq!((pairs.unit, pairs.compared), ("empty pixels", 48 * 32));
    assert_eq!((triangles.admitted, triangles.compared), (6, 6));
    assert_eq!(triangles.skipped, Some(triangles.note));
}

/// Of the columns of a row in 10, where 2 to 8 may be and 4 and 5 must be covered.
fn row(must: std::ops::Range<u32>, seen: &[u32]) -> Judgement {
    let columns = Columns {
        may: 2..9,
        must,
        lengths: [0.0; 2],
    };
    let mut pairs = Pairs::new(10);
    pairs.row(7, 3, &columns, seen);
    pairs.finish(SIZE)
}

#[test]
fn a_row_is_judged_column_by_column() {
    let judgement = row(4..6, &[0, 3, 4, 8, 8]);
    assert_eq!((judgement.compared, judgement.admitted), (8, 5));
    assert_eq!(
        (judgement.skipped, judgement.admitted_budget),
        (None, Some(1.0))
    );
    let note = "MAY: 5 of 8 pairs (62.50 %), 2 of these are covered";
    assert_eq!(judgement.note, note, "3 and 8 are");
    let differ = [
        "coverage: pixel (5, 3) must be covered, is not, by triangle 7",
        "coverage: pixel (0, 3) must not be covered, is, by triangle 7",
        "duplicate: pixel (8, 3) is covered more than once by triangle 7",
    ];
    assert_eq!(judgement.described, differ);
    let marks = [
        (35, Cause::Coverage),
        (30, Cause::Coverage),
        (38, Cause::Duplicate),
    ];
    assert_eq!(judgement.marks, marks);
}

#[test]
fn a_row_that_may_go_either_way_is_not_judged_unless_it_differs() {
    let all = "all 7 pairs may go either way";
    assert_eq!(row(4..4, &[2, 3]).skipped.as_deref(), Some(all));
    assert_eq!(row(4..5, &[4]).skipped, None, "4 must be covered");
    let twice = row(4..4, &[3, 3]);
    assert_eq!((twice.differ(), twice.skipped), (1, None));
}

#[test]
fn what_is_within_a_step_of_a_side_may_go_either_way() {
    let mut scene = scene();
    // A side a quarter of a pixel right of the samples of column 20.
    let x = (20.75 - 24.0) / 24.0;
    let corners = [[x, -0.9, 0.5], [x, 0.9, 0.5], [-0.9, 0.0, 0.5]];
    for (vertex, position) in scene.vertices.iter_mut().zip(corners) {
        vertex.position = position;
    }
    for (step, open) in [(0.5, true), (0.125, false)] {
        let handed = Handed::new(&scene, step);
        let Place::There(region) = &handed.places[0] else {
            panic!("it is in view");
        };
        assert_eq!(region.columns(16, SIZE).is_open(20), open, "{step}");
    }
}

/// Corners of w 2 and 4, in clip space and in pixels of a target whose middle is at (24, 16).
#[test]
fn the_reach_is_that_of_the_divided_corners() {
    let corners = [
        [0.5, -1.0, 1.0, 2.0],
        [-1.0, 0.5, 2.0, 4.0],
        [1.0, 1.0, 1.0, 2.0],
    ];
    let pixel = |[x, y, z, w]: [f64; 4]| [x * HALF + 24.0 * w, -y * HALF + 16.0 * w, z, w];
    let reach = reach(SIZE, corners, corners.map(pixel));
    assert_eq!(reach.corners, corners);
    let divided = [[0.25, 0.5, 0.5], [-0.25, -0.125, 0.25], [0.5, -0.5, 0.5]];
    assert_eq!(reach.deep, divided, "x, y down, one over w");
    assert_eq!(reach.target, [24.0 / HALF, 16.0 / HALF]);
    assert_eq!(reach.middle, 24.0);
}

/// The driver is handed clip space of the guard rectangle, in which the target's middle is
/// the middle.
#[test]
fn what_is_handed_is_centred() {
    let handed = Handed::new(&scene(), STEP);
    let share = [48.0, 32.0].map(|side: f32| side / 4096.0);
    let [x, y, z] = scene().vertices[0].position;
    assert_eq!(handed.triangles[0][0], [x * share[0], y * share[1], z, 1.0]);
}
