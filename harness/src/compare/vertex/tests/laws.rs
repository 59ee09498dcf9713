//! The comparer by itself, without a device.

use super::scenes::{BITS, random};
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
            let report = compare(&scene, bits, &vertex::primitives(&scene, bits));
            assert!(report.agrees(), "{name}: {:?}", report.told);
            let figures = report.figures;
            assert_eq!((figures.moved, figures.error_subpixels), (0, 0.0), "{name}");
            assert_eq!(figures.error_keys, 0.0, "{name}");
        }
    }
}

#[test]
fn rows_that_are_no_fans_are_reported() {
    let (_, scene) = random().swap_remove(1);
    let good = vertex::primitives(&scene, BITS);
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
        let mut bad = good.clone();
        damage(&mut bad);
        let report = compare(&scene, BITS, &bad);
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
    let good = vertex::primitives(&scene, BITS);
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
    let less = compare(&scene, BITS, &less);
    assert_eq!(
        (less.differing, less.malformed),
        (1, None),
        "{:?}",
        less.told
    );
    let more = compare(&scene, BITS, &more);
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
fn where_nothing_is_promised_nothing_is_judged_but_counted() {
    // Twice the largest f32 in clip space: no number has a finite bound.
    let (_, mut scene) = random().swap_remove(0);
    for row in &mut scene.instances[0].rows {
        *row = row.map(|v| v * 1e39);
    }
    let report = compare(&scene, BITS, &vertex::primitives(&scene, BITS));
    assert_eq!(
        report.undecided + report.decisions,
        report.triangles,
        "{report}"
    );
    assert_eq!(report.admitted, report.triangles, "{report}");
    let nothing = Scene {
        triangles: Vec::new(),
        ..scene
    };
    let report = compare(&nothing, BITS, &vertex::primitives(&nothing, BITS));
    assert!(!report.agrees(), "nothing compared is no agreement");
}
