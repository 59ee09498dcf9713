//! Corners by hand against their bounds, and neighbours against each other.

use triptych_spec::scene::Size;
use triptych_spec::vertex::grid_position;

use super::*;
use crate::compare::vertex::axis::Judge;
use crate::compare::vertex::clip::Homogeneous;
use crate::compare::vertex::cracks::cracks;

const SIZE: Size = Size {
    width: 64,
    height: 64,
};

fn bounded(value: f64, bound: f64) -> Bounded {
    Bounded { value, bound }
}

/// A corner at sub-pixel (10.4, 20) in the middle of all depths, with these bounds of x in
/// sub-pixels and of z in keys.
fn corner(x: f64, z: f64) -> Position<Bounded> {
    let [x, z] = [x / 256.0, z / 2_f64.powi(31)];
    [
        bounded(10.4 / 256.0, x),
        bounded(20.0 / 256.0, 0.0),
        bounded(0.5, z),
        bounded(1.0, 0.0),
    ]
}

/// The key in the middle.
const MIDDLE: i32 = (1 << 30) - 1;

#[test]
fn a_corner_on_the_grid_is_off_by_what_rounding_proves() {
    let judge = Judge::new(SIZE, 8);
    let seen = |at, x, z| {
        judge
            .corner(corner(x, z), at)
            .map_err(|outside| outside.axis)
    };
    let near = |seen: f64, must: f64| (seen - must).abs() < 1e-3;
    let same = seen([10, 20, MIDDLE], 0.5, 3.0).expect("its own");
    assert_eq!(
        (same.moved, same.error_subpixels, same.error_keys),
        (0, 0.0, 0.0)
    );

    let moved = seen([11, 20, MIDDLE], 0.5, 3.0).expect("0.1 of 0.5");
    assert_eq!(
        (moved.moved, moved.unbounded, moved.error_keys),
        (1, 0, 0.0)
    );
    assert!(
        near(moved.error_subpixels, 0.1) && near(moved.bound_subpixels, 0.5),
        "{moved:?}"
    );
    assert!(
        near(moved.error_over_bound, 0.2) && moved.error == 0.0,
        "{moved:?}"
    );

    // The number is MIDDLE + 0.5; a kernel's scale is larger by half a key here.
    let deeper = seen([10, 20, MIDDLE + 2], 0.5, 1e3).expect("a key of some");
    assert_eq!((deeper.moved, deeper.error_subpixels), (0, 0.0));
    assert!(
        near(deeper.error_keys, 1.0) && deeper.error == deeper.error_keys,
        "{deeper:?}"
    );

    assert_eq!(seen([11, 20, MIDDLE], 0.05, 3.0), Err(0), "0.1 of 0.05");
    assert_eq!(seen([10, 22, MIDDLE], 0.5, 3.0), Err(1));
    assert_eq!(seen([10, 20, -1], 0.5, f64::INFINITY), Err(2), "no key");
}

#[test]
fn a_corner_that_may_be_anywhere_is_counted_and_its_other_numbers_are_judged() {
    let judge = Judge::new(SIZE, 8);
    for wide in [1e8, f64::INFINITY] {
        let figures = judge.corner(corner(wide, 3.0), [999, 20, MIDDLE]);
        let figures = figures.map_err(|outside| outside.axis).expect("x is free");
        assert_eq!(figures.unbounded, 1);
        assert!(figures.bound_subpixels < 1.0, "that of y: {figures:?}");
        let off = judge.corner(corner(wide, 3.0), [999, 22, MIDDLE]);
        assert_eq!(off.map_err(|outside| outside.axis), Err(1));
    }
}

/// Bounds are of real numbers, and `f64` is off by less than a part in 2^20.
#[test]
fn what_reaches_its_bound_is_inside() {
    let at = |observed: f32| Homogeneous.corner([bounded(1.0, 0.25); 4], [observed; 4]);
    let figures = at(1.25).map_err(|outside| outside.axis);
    let figures = figures.expect("at the bound");
    assert_eq!((figures.error, figures.error_over_bound), (0.25, 1.0));
    assert_eq!(at(1.250_001).map_err(|outside| outside.axis), Err(0));

    // On the grid, x may be off by 0.1 less a part in 2^21, and is by 0.1.
    let number = |x| grid_position(corner(x, 3.0), 8)[0];
    let off = 10.5 - number(0.1).value;
    let mut x = off;
    for _ in 0..4 {
        x *= off / number(x).bound;
    }
    let judge = Judge::new(SIZE, 8);
    let seen = |x| judge.corner(corner(x, 3.0), [11, 20, MIDDLE]).is_ok();
    let part = 1.0 / f64::from(1 << 21);
    assert!(seen(x * (1.0 - part)), "within what is allowed");
    assert!(!seen(x * (1.0 - 4.0 * part)), "less is outside");
}

/// A corner in the near plane, but for rounding.
#[test]
fn a_branch_that_may_go_either_way_goes_both() {
    let at = |x: f64, y: f64, z| [bounded(x, 0.0), bounded(y, 0.0), z, bounded(1.0, 0.0)];
    let corners = [
        at(10.0, 10.0, bounded(1e-9, 1e-6)),
        at(50.0, 10.0, bounded(0.5, 0.0)),
        at(10.0, 50.0, bounded(0.5, 0.0)),
    ];
    let ways = outcomes(&Plane::all(SIZE), corners).expect("two");
    assert_eq!(ways.iter().map(Vec::len).collect::<Vec<_>>(), [3, 4]);
    assert_eq!(ways[0], corners, "the spec's own comes first");
}

/// Triangles 0 and 1 share an edge, 2 shares but a vertex, 3 has an edge twice.
fn neighbours() -> Scene {
    let (_, mut scene) = random().swap_remove(0);
    scene.triangles.truncate(4);
    let faces = [[0, 1, 2], [2, 1, 3], [3, 4, 5], [6, 7, 6]];
    for (triangle, vertices) in scene.triangles.iter_mut().zip(faces) {
        triangle.vertices = vertices;
    }
    scene
}

#[test]
fn neighbours_must_meet_and_others_need_not() {
    let scene = neighbours();
    // All must have a corner of their own, and then one and the same.
    let torn = |t: usize| vec![(100 + t, 0), (7, t)];
    let kind = Kind::Crack {
        corner: 1,
        neighbour: 0,
    };
    let told = Difference { triangle: 1, kind };
    assert_eq!(cracks(&scene, &[0, 1, 2, 3], torn), [told]);
    assert_eq!(cracks(&scene, &[0, 2, 3], torn), [], "1 was not cut");
    assert_eq!(
        cracks(&scene, &[0, 1, 2, 3], |t| vec![(100 + t, 0), (7, 7)]),
        []
    );
    // A corner of 3 is another than its own neighbour, itself, has it.
    assert_eq!(cracks(&scene, &[3], |_| vec![(7, 0), (7, 1)]), []);
}

/// What is outside its bounds need not meet its neighbours, too.
#[test]
fn a_triangle_that_is_outside_is_told_once() {
    let scene = floor();
    let run = in_f32(&scene, BITS);
    let polygons = run.polygons.as_ref().expect("the spec's");
    let visible = |t: &usize| {
        let whole = scene.triangles[*t]
            .vertices
            .map(|v| run.positions[v as usize]);
        let seen = polygon(polygons, *t);
        !seen.is_empty() && seen != whole
    };
    let sound = Judged::new(&scene, &run);
    let all = (0..scene.triangles.len()).filter(|t| !polygon(polygons, *t).is_empty());
    assert_eq!(sound.snap.triangles, all.count() as u64);
    assert_eq!(sound.clip.triangles, scene.triangles.len() as u64);
    for triangle in (0..scene.triangles.len()).filter(visible).take(20) {
        let corners = polygons.offsets[triangle] as usize..polygons.offsets[triangle + 1] as usize;
        let mut worse = run.clone();
        let moved = worse.polygons.as_mut().expect("the spec's");
        moved.corners[corners.clone()]
            .iter_mut()
            .for_each(|c| c[0] += 64.0);
        let report = compare_clip(&scene, &run.positions, moved);
        assert_eq!(
            (report.differing, report.cracks),
            (1, 0),
            "{:?}",
            report.told
        );
        worse.primitives.snapped[corners]
            .iter_mut()
            .for_each(|c| c[1] ^= 64);
        let primitives = &worse.primitives;
        let report = compare_snap(&scene, BITS, &run.positions, polygons, primitives);
        assert_eq!(
            (report.differing, report.cracks),
            (1, 0),
            "{:?}",
            report.told
        );
    }
}

#[test]
fn every_triangle_is_judged_as_its_own_row() {
    let (_, mut scene) = random().swap_remove(0);
    let last = u32::try_from(CHUNK).expect("few") + 1;
    let triangle = |primitive| Triangle {
        primitive,
        ..scene.triangles[0]
    };
    scene.triangles = (0..=last).map(triangle).collect();
    let (report, rows) = each(&scene, |row, triangle, part| {
        part.triangles += 1;
        assert_eq!(row, triangle.primitive as usize);
        row % CHUNK == 1
    });
    assert_eq!(
        (report.triangles, rows),
        (u64::from(last) + 1, vec![1, CHUNK + 1])
    );
}

/// A key is turned into its neighbour, which is inside: only where the triangle was cut must
/// it be that of those beside it.
#[test]
fn corners_of_cut_triangles_must_meet_on_the_grid() {
    let scene = floor();
    let run = in_f32(&scene, BITS);
    let polygons = run.polygons.as_ref().expect("the spec's");
    let visible = |t: &usize| !polygon(polygons, *t).is_empty();
    let mut told = 0;
    for triangle in (0..scene.triangles.len()).filter(visible).step_by(61) {
        let vertices = scene.triangles[triangle].vertices;
        let seen = polygon(polygons, triangle);
        let is_cut = seen != vertices.map(|v| run.positions[v as usize]);
        let first = polygons.offsets[triangle] as usize;
        let mut torn = run.primitives.clone();
        let corners = torn.snapped[first..first + seen.len()].iter_mut();
        corners.filter(|c| c[2] > 1 << 28).for_each(|c| c[2] ^= 1);
        let report = compare_snap(&scene, BITS, &run.positions, polygons, &torn);
        assert_eq!(report.outside, 0, "{:?}", report.told);
        assert!(is_cut || report.cracks == 0, "{:?}", report.told);
        told += report.cracks;
    }
    assert!(told > 0, "none is torn");
}
