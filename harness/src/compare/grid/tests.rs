use std::collections::BTreeMap;

use triptych_gpu::grid::{Entry, Hit, Linked, TRACED};
use triptych_spec::abuffer::{EOL, NOTHING};
use triptych_spec::grid::Blockers;
use triptych_spec::grid::hit::timed;
use triptych_spec::grid::ray::Ray;
use triptych_spec::grid::trace::Closest;

use super::*;
use crate::cause::Cause;
use crate::compare::Judgement;

const SPEC: Runs<'_> = Runs {
    offsets: &[0, 2, 2, 5],
    prims: &[3, 7, 1, 3, 9],
};

/// What a judgement must say: nothing, or one cause as often as this.
fn caused(judgement: &Judgement, expected: &[(Cause, u64)]) {
    let expected: BTreeMap<Cause, u64> = expected.iter().copied().collect();
    assert_eq!(judgement.causes, expected, "{:?}", judgement.described);
    assert_eq!(judgement.unexplained, 0, "every difference has a cause");
}

#[test]
fn numbers_are_equal_or_counted() {
    caused(&counts(&[2, 0, 3], &[2, 0, 3]), &[]);
    let wrong = counts(&[2, 0, 3], &[1, 0, 4]);
    caused(&wrong, &[(Cause::Coverage, 2)]);
    assert_eq!(wrong.compared, 3);
    caused(&offsets(&[0, 2], &[0, 3]), &[(Cause::CorruptLink, 1)]);
    caused(&counts(&[2, 0], &[2]), &[(Cause::ReferenceMissing, 1)]);
}

#[test]
fn entries_tell_why_a_list_differs() {
    let seen = |prims: &[u32]| entries(SPEC, prims);
    caused(&seen(&[3, 7, 1, 3, 9]), &[]);
    caused(&seen(&[7, 3, 1, 3, 9]), &[(Cause::SortOrder, 1)]);
    caused(&seen(&[3, 7, 1, 3, 8]), &[(Cause::Coverage, 1)]);
    caused(&seen(&[3, 3, 1, 3, 9]), &[(Cause::Duplicate, 1)]);
    caused(&seen(&[3, 7]), &[(Cause::LostNode, 1)]);
    assert_eq!(seen(&[]).compared, 5);
}

#[test]
fn lists_in_between_are_admitted() {
    let most = Runs {
        offsets: &[0, 3, 4, 7],
        prims: &[2, 3, 7, 5, 1, 3, 9],
    };
    let seen = |offsets: &[u32], prims: &[u32]| within(SPEC, Runs { offsets, prims }, most);
    let between = seen(&[0, 3, 3, 6], &[2, 3, 7, 1, 3, 9]);
    caused(&between, &[]);
    assert_eq!(between.admitted, 1, "what the spec drops");
    caused(&seen(&[0, 1, 1, 4], &[3, 1, 3, 9]), &[(Cause::LostNode, 1)]);
    let foreign = seen(&[0, 2, 3, 6], &[3, 7, 6, 1, 3, 9]);
    caused(&foreign, &[(Cause::Coverage, 1)]);
    let order = seen(&[0, 2, 2, 5], &[7, 3, 1, 3, 9]);
    caused(&order, &[(Cause::SortOrder, 1)]);

    let counted = |seen: &[u32]| counts_within(&[2, 0, 3], seen, most);
    assert_eq!(counted(&[3, 1, 3]).admitted, 2);
    caused(&counted(&[1, 0, 4]), &[(Cause::Coverage, 2)]);
    caused(&counted(&[3, 1]), &[(Cause::ReferenceMissing, 1)]);
}

#[test]
fn an_attempt_without_room_stores_nothing_foreign() {
    let seen = |prims: &[u32]| overflowed(SPEC, prims);
    caused(&seen(&[7, 3, 9]), &[]);
    assert_eq!(seen(&[7, 3, 9]).compared, 3);
    caused(&seen(&[7, 9, 9]), &[(Cause::Overflow, 1)]);
    caused(&seen(&[7, 7, 9]), &[(Cause::Duplicate, 1)]);
}

/// Lists of `SPEC`, newest first, at the addresses 0 to 4.
fn lists() -> Linked {
    let entry = |prim, next| Entry { prim, next };
    Linked {
        heads: vec![1, EOL, 4],
        entries: vec![
            entry(3, EOL),
            entry(7, 0),
            entry(1, EOL),
            entry(3, 2),
            entry(9, 3),
        ],
        attempts: 5,
    }
}

#[test]
fn linked_lists_are_certified() {
    let judged = |change: fn(&mut Linked)| {
        let mut lists = lists();
        change(&mut lists);
        linked(SPEC, SPEC, &lists)
    };
    caused(&judged(|_| ()), &[]);
    assert_eq!(judged(|_| ()).compared, 5);
    caused(&judged(|l| l.attempts = 6), &[(Cause::Overflow, 1)]);
    caused(&judged(|l| l.heads[0] = 0), &[(Cause::LostNode, 1)]);
    caused(&judged(|l| l.entries[2].next = 4), &[(Cause::Cycle, 1)]);
    caused(&judged(|l| l.heads[1] = 0), &[(Cause::CorruptLink, 1)]);
    caused(&judged(|l| l.heads[1] = 77), &[(Cause::CorruptLink, 1)]);
    caused(&judged(|l| l.entries[0].prim = 4), &[(Cause::Coverage, 1)]);
    caused(&judged(|l| l.entries[0].prim = 7), &[(Cause::Duplicate, 1)]);
    // Without room for all: lists lack some, and heads stay off what has no room.
    let short = |l: &mut Linked| {
        l.entries.truncate(4);
        l.heads[2] = 3;
    };
    caused(&judged(short), &[]);
    let beyond = |l: &mut Linked| {
        l.entries.truncate(4);
    };
    caused(&judged(beyond), &[(Cause::Overflow, 1)]);
}

/// A ray through two parallel triangles, and one past them.
struct Scene {
    blockers: Blockers,
    rays: [Ray; 2],
    answers: [Option<Closest>; 2],
}

impl Scene {
    fn new() -> Self {
        let blockers = Blockers {
            vertices: [10, 20]
                .map(|z| [[0, 0, z], [90, 0, z], [0, 90, z]])
                .concat(),
            triangles: vec![[0, 1, 2], [3, 4, 5]],
        };
        let rays = [0, 99].map(|x| Ray::between([x, 7, 0], [x, 7, 30]));
        let first = triptych_spec::grid::hit::crossing(&rays[0], blockers.corners(0));
        let first = first.map(|time| Closest { prim: 0, time });
        assert!(first.is_some(), "the first ray meets the first triangle");
        Self {
            blockers,
            rays,
            answers: [first, None],
        }
    }

    fn asked(&self) -> Asked<'_> {
        Asked {
            blockers: &self.blockers,
            rays: &self.rays,
            answers: &self.answers,
        }
    }

    fn time(&self, prim: u32) -> f32 {
        let time = timed(&self.rays[0], self.blockers.corners(prim)).expect("it is met");
        single(time.value)
    }
}

fn single(time: f64) -> f32 {
    #[expect(clippy::cast_possible_truncation, reason = "what a kernel would give")]
    let single = time as f32;
    single
}

fn hit(prim: u32, time: f32) -> Hit {
    Hit {
        prim,
        time,
        state: TRACED,
        at: 0,
    }
}

#[test]
fn answers_are_held_against_the_spec() {
    let scene = Scene::new();
    let (first, second) = (scene.time(0), scene.time(1));
    let miss = hit(NOTHING, 0.0);
    let any = |hits: [Hit; 2]| any(scene.asked(), &hits);
    caused(&any([hit(0, 0.0), miss]), &[]);
    caused(&any([hit(1, 0.0), miss]), &[]);
    caused(&any([miss, miss]), &[(Cause::Coverage, 1)]);
    caused(&any([hit(0, 0.0), hit(0, 0.0)]), &[(Cause::Coverage, 1)]);
    caused(&any([hit(2, 0.0), miss]), &[(Cause::Coverage, 1)]);

    let closest = |hits: [Hit; 2]| closest(scene.asked(), &hits);
    caused(&closest([hit(0, first), miss]), &[]);
    caused(&closest([hit(1, second), miss]), &[(Cause::DepthKey, 1)]);
    caused(&closest([miss, miss]), &[(Cause::Coverage, 1)]);
    let bound = timed(&scene.rays[0], scene.blockers.corners(0)).expect("it is met");
    let off = |times: f64| single(bound.value + times * bound.bound);
    caused(&closest([hit(0, off(0.9)), miss]), &[]);
    caused(&closest([hit(0, off(2.0)), miss]), &[(Cause::Interval, 1)]);
    let error = closest([hit(0, off(0.9)), miss]).error_over_bound;
    assert!(error.is_some_and(|e| (0.8..1.0).contains(&e)), "{error:?}");
    caused(
        &super::any(scene.asked(), &[miss]),
        &[(Cause::Coverage, 1), (Cause::ReferenceMissing, 1)],
    );
}

#[test]
fn what_a_grid_leaves_out_is_seen() {
    let scene = Scene::new();
    let nearest = nearest_of_each(&scene.blockers, &scene.rays);
    assert_eq!(nearest, scene.answers);
    let judged = |answers: [Option<Closest>; 2]| {
        let asked = Asked {
            answers: &answers,
            ..scene.asked()
        };
        exhaustive(asked, &nearest)
    };
    let [first, _] = scene.answers;
    caused(&judged([first, None]), &[]);
    caused(&judged([None, None]), &[(Cause::Coverage, 1)]);
    caused(&judged([first, first]), &[(Cause::Coverage, 1)]);
    let other = first.map(|first| Closest { prim: 1, ..first });
    caused(&judged([other, None]), &[(Cause::Coverage, 1)]);
}

#[test]
fn either_may_come_first_where_bounds_overlap() {
    let mut scene = Scene::new();
    scene.blockers.vertices.copy_within(0..3, 3);
    let time = scene.time(1);
    let judged = closest(scene.asked(), &[hit(1, time), hit(NOTHING, 0.0)]);
    caused(&judged, &[]);
    assert_eq!(judged.admitted, 1, "not the spec's");
}

#[test]
fn empty_lists_are_compared_as_lists() {
    let none = Runs {
        offsets: &[0, 0, 0],
        prims: &[],
    };
    let same = entries(none, &[]);
    assert_eq!((same.unit, same.compared), ("lists", 2));
    let lists = Linked {
        heads: vec![EOL; 2],
        entries: Vec::new(),
        attempts: 0,
    };
    let same = linked(none, none, &lists);
    assert_eq!((same.unit, same.compared), ("lists", 2));
    let heads = vec![EOL, 0];
    caused(
        &linked(none, none, &Linked { heads, ..lists }),
        &[(Cause::CorruptLink, 1)],
    );
}
