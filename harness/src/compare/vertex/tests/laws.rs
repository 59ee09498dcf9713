//! The comparer by itself, without a device.

use super::scenes::{BITS, random};
use triptych_spec::bound::TINY;

use super::*;

/// The bounds travel along with the numbers and do not change them.
#[test]
fn bounded_numbers_are_the_plain_ones() {
    for (name, scene) in random() {
        let plain: Vec<Position<f64>> = vertex::transform(&scene);
        let bounded: Vec<Position<Bounded>> = vertex::transform(&scene);
        let value = |p: &Position<Bounded>| p.map(|n| n.value.to_bits());
        let bits = |p: &Position<f64>| p.map(f64::to_bits);
        assert!(
            plain.iter().map(bits).eq(bounded.iter().map(value)),
            "{name}"
        );
        let plain = vertex::clip(&scene, &plain);
        let bounded = vertex::clip(&scene, &bounded);
        assert_eq!(plain.offsets, bounded.offsets, "{name}");
        let same = plain
            .corners
            .iter()
            .map(bits)
            .eq(bounded.corners.iter().map(value));
        assert!(same, "{name}: corners after clipping");
        assert!(
            plain.offsets.windows(2).any(|w| w[1] - w[0] > 3),
            "{name}: some is cut"
        );
    }
}

#[test]
fn the_spec_conforms_to_itself() {
    for (name, scene) in random() {
        for bits in [4, BITS] {
            let judged = Judged::new(&scene, &in_f32(&scene, bits));
            let Judged { clip, snap, .. } = &judged;
            assert!(judged.diverging().is_empty(), "{name}: {clip}, {snap}");
            assert!(clip.agrees() && snap.agrees(), "{name}");
            let ratio = clip.figures.error_over_bound;
            assert!(0.0 < ratio && ratio < 1.0, "{name}: rounded once: {clip}");
            let figures = snap.figures;
            assert_eq!((figures.moved, figures.error_subpixels), (0, 0.0), "{name}");
            assert_eq!(figures.error_keys, 0.0, "{name}");
            let whole = whole(&scene, bits, &in_f32(&scene, bits).primitives);
            assert!(whole.agrees(), "{name}: {:?}", whole.told);
        }
    }
}

/// Holds other triangles against those that the spec makes of its polygons.
fn snapped(scene: &Scene, run: &VertexRun, observed: &Primitives) -> VertexReport {
    let polygons = run.polygons.as_ref().expect("the spec's");
    compare_snap(scene, BITS, &run.positions, polygons, observed)
}

#[test]
fn rows_that_are_no_fans_are_reported() {
    let (_, scene) = random().swap_remove(1);
    let run = in_f32(&scene, BITS);
    type Damage = fn(&mut Primitives);
    let damages: [Damage; 12] = [
        |p| {
            // A sound polygon of a triangle that the scene does not have.
            let end = u32::try_from(p.snapped.len()).expect("few");
            p.snapped.extend([[0; 3]; 3]);
            p.prims.push([end, end + 1, end + 2]);
            p.source.push(2000);
        },
        |p| p.bits = 4,
        |p| p.size.width += 1,
        |p| p.source[3] = u32::MAX,
        |p| p.source.swap(0, 99),
        |p| p.prims[5][2] = u32::MAX,
        |p| p.prims[0] = [0, 2, 1],
        |p| p.prims.swap(0, 1),
        |p| p.snapped.push([0; 3]),
        |p| p.snapped.truncate(17),
        |p| p.source.push(0),
        |p| {
            p.prims.pop();
            p.source.pop();
        },
    ];
    for (number, damage) in damages.into_iter().enumerate() {
        let mut bad = run.primitives.clone();
        damage(&mut bad);
        let report = snapped(&scene, &run, &bad);
        assert!(
            report.malformed.is_some() && !report.agrees(),
            "damage {number}"
        );
        let judgement = report.judgement();
        assert!(judgement.differ() > 0, "damage {number}: {judgement:?}");
    }
}

#[test]
fn a_missing_or_additional_triangle_is_reported() {
    let (_, scene) = random().swap_remove(1);
    let run = in_f32(&scene, BITS);
    let good = &run.primitives;
    // Without its last polygon.
    let mut less = good.clone();
    let last = less.source.last().copied();
    while less.source.last().copied() == last {
        less.source.pop();
        let [first, ..] = less.prims.pop().expect("as many as sources");
        less.snapped.truncate(first as usize);
    }
    // With one for the first triangle that has none, at the end of the rows.
    let mut more = good.clone();
    let missing = (0..)
        .find(|t| !good.source.contains(t))
        .expect("one is not visible");
    more.source.retain(|&s| s < missing);
    more.prims.truncate(more.source.len());
    let end = more.prims.last().expect("some are visible")[2] + 1;
    more.snapped.truncate(end as usize);
    more.snapped.extend([[0, 0, 0], [99, 0, 0], [0, 99, 0]]);
    more.prims.push([end, end + 1, end + 2]);
    more.source.push(missing);
    let less = snapped(&scene, &run, &less);
    assert_eq!(
        (less.differing, less.malformed),
        (1, None),
        "{:?}",
        less.told
    );
    let more = snapped(&scene, &run, &more);
    let count = |d: &&Difference| d.triangle == missing as usize;
    let told = more
        .told
        .iter()
        .find(count)
        .expect("the first that differs");
    assert_eq!(
        told.kind,
        Kind::Count {
            expected: 0,
            observed: 3
        }
    );
}

#[test]
fn a_missing_or_additional_polygon_is_reported() {
    let (_, scene) = random().swap_remove(1);
    let run = in_f32(&scene, BITS);
    let good = run.polygons.as_ref().expect("the spec's");
    let visible = (0..scene.triangles.len()).filter(|t| !polygon(good, *t).is_empty());
    let first = visible.clone().next().expect("some are visible");
    // A polygon less, or with a corner less, as far as a single one.
    let corners = polygon(good, first).len();
    for left in 0..corners {
        let mut bad = good.clone();
        let start = good.offsets[first] as usize;
        bad.corners.drain(start + left..start + corners);
        for offset in &mut bad.offsets[first + 1..] {
            *offset -= u32::try_from(corners - left).expect("few");
        }
        let report = compare_clip(&scene, &run.positions, &bad);
        assert_eq!(
            report.differing, 1,
            "{left} of {corners}: {:?}",
            report.told
        );
        assert_eq!(report.told[0].triangle, first, "{left} of {corners}");
        let outside = if left == 1 || left == 2 {
            left
        } else {
            corners
        };
        assert_eq!(report.outside, outside as u64, "{left} of {corners}");
    }
    let fewer = &run.positions[1..];
    for report in [
        compare_clip(&scene, fewer, good),
        compare_clip(
            &scene,
            &run.positions,
            &Polygons {
                offsets: vec![0],
                corners: Vec::new(),
            },
        ),
    ] {
        assert!(report.malformed.is_some() && !report.agrees(), "{report}");
    }
}

/// A component that is not finite may be anything to the stage that follows; the others
/// are judged as ever.
#[test]
fn a_component_that_is_not_finite_is_free_and_counted() {
    let (_, scene) = random().swap_remove(1);
    let run = in_f32(&scene, BITS);
    let polygons = run.polygons.as_ref().expect("the spec's");
    let whole = |t: &usize| {
        let corners = scene.triangles[*t]
            .vertices
            .map(|v| run.positions[v as usize]);
        polygon(polygons, *t) == corners
    };
    let visible = (0..scene.triangles.len())
        .find(whole)
        .expect("some is not cut");
    let vertex = scene.triangles[visible].vertices[1] as usize;
    let before = compare_clip(&scene, &run.positions, polygons);
    for bad in [f32::INFINITY, f32::NEG_INFINITY, f32::NAN] {
        for axis in 0..4 {
            let mut positions = run.positions.clone();
            positions[vertex][axis] = bad;
            let report = compare_clip(&scene, &positions, polygons);
            let at = format!("{bad} in component {axis}: {:?}", report.told);
            assert_eq!(report.differing, 0, "{at}");
            assert_eq!(report.admitted, before.admitted + 1, "{at}");
            // Of the other components nothing is free.
            let mut moved = polygons.clone();
            moved.corners[polygons.offsets[visible] as usize + 1][(axis + 1) % 4] += 64.0;
            let report = compare_clip(&scene, &positions, &moved);
            assert!(
                report.differing == 1 || report.undecided > before.undecided,
                "{at}"
            );
        }
    }
}

/// Edges that meet in a vertex of a plane are cut there, each from its own other end:
/// nothing promises that the roundings of two of them are alike.
#[test]
fn points_of_different_edges_need_not_be_one() {
    let scene = hub_in_plane();
    let mut apart = 0;
    for gpu in devices() {
        let run = run_with(&gpu, Sources::shipped(false), &scene);
        let report = Judged::new(&scene, &run).clip;
        assert!(report.agrees(), "{}: {:?}", gpu.name, report.told);
        let hub = run.positions[0];
        let polygons = run.polygons.expect("they were asked for");
        let near = |c: &&Position<f32>| (c[0] - hub[0]).abs() < 1.0 && c[0] != hub[0];
        apart += polygons.corners.iter().filter(near).count();
    }
    assert!(apart > 0, "no device rounded: the scene shows nothing");
}

#[test]
fn where_nothing_is_promised_nothing_is_judged_but_counted() {
    // Beyond the largest f32 in clip space: no number has a finite bound.
    let (_, mut scene) = random().swap_remove(0);
    for row in &mut scene.instances[0].rows {
        *row = row.map(|v| v * 1e45);
    }
    let run = in_f32(&scene, BITS);
    let Judged {
        transform, clip, ..
    } = Judged::new(&scene, &run);
    assert_eq!(transform.unbounded, transform.vertices);
    // Nor is it an error of anything to be elsewhere.
    let elsewhere = compare_transform(&scene, &vec![[0.0; 4]; scene.vertices.len()]);
    for report in [&transform, &elsewhere] {
        let figures = (report.outside, report.error, report.error_over_bound);
        assert_eq!(figures, (0, 0.0, 0.0));
    }
    assert_eq!(clip.undecided + clip.decisions, clip.triangles, "{clip}");
    assert_eq!(clip.admitted, clip.triangles, "{clip}");
    let nothing = Scene {
        triangles: Vec::new(),
        ..scene
    };
    let infinite = [f32::INFINITY, f32::NEG_INFINITY, f32::NAN];
    for position in infinite.map(|v| [v, 1e-40, 0.0, 2.0]) {
        let bounds = exact(position).map(|n| n.bound);
        assert_eq!(bounds, [f64::INFINITY, TINY, 0.0, 0.0], "{position:?}");
    }
    let Judged { clip, snap, .. } = Judged::new(&nothing, &in_f32(&nothing, BITS));
    assert!(!clip.agrees(), "nothing compared is no agreement");
    assert!(!snap.agrees(), "nothing compared is no agreement");
}
