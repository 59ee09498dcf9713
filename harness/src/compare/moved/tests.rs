//! Two triangles at one pixel, of which one, both or none moved.

use triptych_spec::abuffer::{NOTHING, Opaque, Sorted};
use triptych_spec::raster::Fragment;
use triptych_spec::scene::Size;
use triptych_spec::vertex::Primitives;

use super::{Side, compare};
use crate::cause::Cause;
use crate::compare::Judgement;

struct Run {
    primitives: Primitives,
    opaque: Opaque,
    sorted: Sorted,
}

/// Triangle 0 in the list of the only pixel at this key, if any; triangle 1 is an opaque
/// surface there. `moved` moves a corner of each.
fn run(moved: [i32; 2], key: Option<u32>, opaque: u32) -> Run {
    let triangle = |by: i32, z: i32| [[by, 0, z], [256, 0, z], [0, 256, z]];
    let fragment = |key| Fragment {
        pixel: 0,
        prim: 0,
        key,
        mask: 1,
    };
    let fragments: Vec<Fragment> = key.map(fragment).into_iter().collect();
    Run {
        primitives: Primitives {
            samples: triptych_spec::raster::Samples::ONE,
            size: Size {
                width: 1,
                height: 1,
            },
            bits: 8,
            snapped: [triangle(moved[0], 5), triangle(moved[1], 9)].concat(),
            prims: vec![[0, 1, 2], [3, 4, 5]],
            source: vec![0, 1],
        },
        opaque: Opaque {
            key: vec![opaque],
            prim: vec![if opaque == NOTHING { NOTHING } else { 1 }],
        },
        sorted: Sorted {
            offsets: vec![0, u32::from(key.is_some())],
            fragments,
        },
    }
}

fn side(run: &Run) -> Side<'_> {
    Side {
        primitives: &run.primitives,
        opaque: &run.opaque,
        sorted: &run.sorted,
    }
}

fn judge(spec: &Run, own: &Run) -> Judgement {
    compare(side(spec), side(own))
}

#[test]
fn what_a_moved_triangle_changes_is_counted() {
    let spec = run([0, 0], Some(5), 9);
    let own = run([1, 0], Some(6), 9);
    let judgement = judge(&spec, &own);
    assert_eq!((judgement.differ(), judgement.admitted), (0, 1));
    assert_eq!(judgement.compared, 2, "the list's fragment, the surface");
    let words = "of 2 fragments 0 come or go, 1 have another key";
    assert!(judgement.note.contains(words), "{}", judgement.note);
}

#[test]
fn what_a_moved_surface_hides_is_counted() {
    let spec = run([0, 0], Some(5), 9);
    let judgement = judge(&spec, &run([0, 1], None, 4));
    assert_eq!((judgement.differ(), judgement.admitted), (0, 2));
    assert!(judgement.skipped.is_some(), "nothing is left to judge");
    let words = "1 come or go, 1 have another key";
    assert!(judgement.note.contains(words), "{}", judgement.note);
}

#[test]
fn a_moved_surface_that_comes_or_goes_is_counted() {
    let (there, gone) = (run([0, 0], Some(5), 9), run([0, 1], Some(5), NOTHING));
    for (spec, own) in [(&there, &gone), (&gone, &there)] {
        let judgement = judge(spec, own);
        assert_eq!((judgement.differ(), judgement.admitted), (0, 1));
        assert_eq!(judgement.compared, 2, "the list's fragment, the surface");
        assert_eq!(judgement.skipped, None, "the fragment is judged");
        let words = "1 come or go, 0 have another key";
        assert!(judgement.note.contains(words), "{}", judgement.note);
    }
}

#[test]
fn what_did_not_move_must_be_the_same() {
    let spec = run([0, 0], Some(5), 9);
    let cases = [
        (run([0, 0], None, 9), Cause::LostNode),
        (run([0, 1], Some(6), 9), Cause::DepthKey),
        (run([1, 0], Some(5), 8), Cause::DepthKey),
        (run([1, 0], Some(5), NOTHING), Cause::Coverage),
    ];
    for (own, cause) in cases {
        let judgement = judge(&spec, &own);
        let causes: Vec<_> = judgement.causes.into_iter().collect();
        assert_eq!(causes, [(cause, 1)], "{:?}", judgement.described);
    }
    let mut twice = run([0, 0], Some(5), 9);
    twice.sorted.fragments.push(twice.sorted.fragments[0]);
    assert_eq!(judge(&spec, &twice).causes, [(Cause::Duplicate, 1)].into());
    assert_eq!(judge(&twice, &twice).differ(), 0);
    let none = run([0, 0], None, 9);
    assert_eq!(judge(&none, &spec).causes, [(Cause::Coverage, 1)].into());
    // A fragment of the other triangle, too.
    let mut both = run([0, 0], Some(5), 9);
    both.sorted.fragments.push(Fragment {
        prim: 1,
        ..both.sorted.fragments[0]
    });
    assert_eq!(judge(&both, &spec).causes, [(Cause::LostNode, 1)].into());
}
