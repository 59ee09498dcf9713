//! What reports count, and what they say.

use super::scenes::random;
use super::*;
use crate::cause::Cause;
use crate::row::Class;

fn crack(triangle: usize) -> Difference {
    let kind = Kind::Crack {
        corner: 2,
        neighbour: 3,
    };
    Difference { triangle, kind }
}

/// Every count another power of two.
fn report() -> VertexReport {
    VertexReport {
        triangles: 1024,
        corners: 2,
        outside: 4,
        cracks: 8,
        differing: 16,
        told: vec![crack(7)],
        malformed: None,
        decisions: 32,
        undecided: 64,
        admitted: 128,
        figures: Figures {
            unbounded: 256,
            moved: 512,
            error: 3.0,
            error_over_bound: 0.25,
            error_subpixels: 0.5,
            bound_subpixels: 0.75,
            error_keys: 1.5,
        },
    }
}

#[test]
fn reports_add_up() {
    let mut total = VertexReport::default();
    total.add(report());
    assert_eq!(total, report(), "nothing before it");
    for _ in 0..9 {
        total.add(report());
    }
    assert_eq!((total.triangles, total.cracks), (10240, 80));
    assert_eq!((total.figures.moved, total.figures.error), (5120, 3.0));
    assert_eq!(total.told, vec![crack(7); TOLD_MAX]);
}

#[test]
fn what_is_uncertain_or_unbounded_is_admitted() {
    let mut report = VertexReport::default();
    report.agree(&Figures::default(), false);
    assert_eq!(report, VertexReport::default());
    report.agree(&Figures::default(), true);
    assert_eq!((report.decisions, report.admitted), (1, 1));
    let unbounded = Figures {
        unbounded: 1,
        ..Figures::default()
    };
    report.agree(&unbounded, false);
    assert_eq!((report.decisions, report.admitted), (1, 2));
    assert_eq!(report.figures, unbounded);
}

#[test]
fn what_agrees_was_judged_and_does_not_differ() {
    let with = |triangles, undecided, differing, malformed: Option<&str>| VertexReport {
        triangles,
        undecided,
        differing,
        malformed: malformed.map(str::to_owned),
        ..VertexReport::default()
    };
    assert!(with(3, 0, 0, None).agrees());
    assert!(with(3, 2, 0, None).agrees(), "one is judged");
    assert!(!with(3, 3, 0, None).agrees(), "none is judged");
    assert!(!with(3, 0, 1, None).agrees());
    assert!(!with(3, 0, 0, Some("no fans")).agrees());
}

#[test]
fn a_judgement_has_all_differences_and_tells_the_first() {
    let mut report = VertexReport {
        triangles: 20,
        admitted: 5,
        figures: report().figures,
        ..VertexReport::default()
    };
    let judgement = report.judgement();
    assert_eq!(
        (judgement.class, judgement.unit),
        (Class::Interval, "triangles")
    );
    assert_eq!((judgement.compared, judgement.admitted), (20, 5));
    assert_eq!(
        (judgement.error, judgement.error_over_bound),
        (Some(3.0), Some(0.25))
    );
    assert_eq!(judgement.causes, [].into(), "none");
    report.add_cracks((0..10).map(crack).collect());
    assert_eq!((report.cracks, report.differing), (10, 10));
    let first: Vec<Difference> = (0..TOLD_MAX).map(crack).collect();
    assert_eq!(report.told, first);
    assert_eq!(report.judgement().causes, [(Cause::Vertex, 10)].into());
    let malformed = VertexReport::malformed("no fans".into()).judgement();
    assert_eq!(malformed.causes, [(Cause::Vertex, 1)].into());
    assert_eq!(malformed.described, ["vertex: no fans"]);
}

#[test]
fn differences_say_what_differs() {
    let words = |kind| Difference { triangle: 7, kind }.to_string();
    let count = Kind::Count {
        expected: 3,
        observed: 4,
    };
    assert_eq!(words(count), "triangle 7: 4 corners after clipping, not 3");
    let corner = Kind::Corner {
        corner: 1,
        axis: 3,
        value: 2.0,
        bound: 0.5,
        observed: 3.0,
    };
    assert_eq!(
        words(corner),
        "triangle 7: corner 1: w is 3, not 2 within 5.000e-1"
    );
    let text = "triangle 7: corner 2 is not where its neighbour 3 has it";
    assert_eq!(crack(7).to_string(), text);
    let none = Kind::NoOutcome {
        outcomes: 2,
        observed: 5,
    };
    assert_eq!(
        words(none),
        "triangle 7: its 5 corners match none of 2 ways to clip it"
    );
}

#[test]
fn a_report_says_how_far_corners_are_off() {
    let snap = "2 corners, 512 moved, off by up to 0.500 of at most 0.750 sub-pixels and 2 keys \
                (0.25 of the bound), 32 triangles with an uncertain branch, 64 triangles \
                undecided, 256 corners unbounded, 8 triangles that do not meet a neighbour";
    assert_eq!(report().to_string(), snap);
    let clip = VertexReport {
        corners: 9,
        ..VertexReport::default()
    };
    assert_eq!(
        clip.to_string(),
        "9 corners, off by up to 0.00 of the bound"
    );
}

/// Ten vertices of a scene, and what a device makes of them.
fn ten() -> (Scene, Vec<Position<f32>>) {
    let (_, mut scene) = random().swap_remove(1);
    scene.vertices.truncate(10);
    scene.triangles.clear();
    let positions = in_f32(&scene, BITS).positions;
    (scene, positions)
}

#[test]
fn every_vertex_that_strays_is_counted_and_the_first_are_told() {
    let (scene, positions) = ten();
    let sound = compare_transform(&scene, &positions);
    assert_eq!((sound.vertices, sound.outside, sound.unbounded), (10, 0, 0));
    assert!(
        0.0 < sound.error_over_bound && sound.error_over_bound < 1.0,
        "rounded once"
    );
    let judgement = sound.judgement();
    assert_eq!((judgement.compared, judgement.causes), (10, [].into()));

    let mut off = positions.clone();
    off.iter_mut().for_each(|p| p[1] += 64.0);
    let off = compare_transform(&scene, &off);
    assert_eq!((off.outside, off.told.len()), (10, TOLD_MAX));
    let component = |stray: &Stray| (stray.vertex, stray.component);
    let told: Vec<_> = off.told.iter().map(component).collect();
    assert_eq!(told, (0..TOLD_MAX).map(|v| (v, 1)).collect::<Vec<_>>());
    assert!((off.error - 64.0).abs() < 1e-3, "{}", off.error);
    assert_eq!(off.judgement().causes, [(Cause::Vertex, 10)].into());

    let mut one = positions.clone();
    one[3][1] += 64.0;
    let one = compare_transform(&scene, &one);
    let [stray] = one.told[..] else {
        panic!("one strays: {:?}", one.told);
    };
    let error = (f64::from(stray.observed) - stray.expected.value).abs();
    assert_eq!(one.error, error);
    assert_eq!(one.error_over_bound, error / stray.expected.bound);

    let fewer = compare_transform(&scene, &positions[..7]);
    assert_eq!((fewer.outside, fewer.told.len()), (10, 0));
    assert_eq!(fewer.judgement().differ(), 10);
}

#[test]
fn a_stray_says_where_it_should_be() {
    let stray = Stray {
        vertex: 5,
        component: 2,
        expected: Bounded {
            value: 1.0,
            bound: 0.25,
        },
        observed: 1.5,
    };
    assert_eq!(
        stray.to_string(),
        "vertex 5: z is 1.5, not 1 within 2.500e-1"
    );
}
