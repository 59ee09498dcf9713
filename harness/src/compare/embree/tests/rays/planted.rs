//! The comparer of rays on planted bugs: each must be reported, and only it.

use triptych_spec::grid::hit::crossing;
use triptych_spec::grid::ray::Ray;
use triptych_spec::grid::trace::Query;

use super::{QUERIES, anywhere, sheets, soup, straight};
use crate::cause::Cause;
use crate::compare::embree::{RayConflict, RayVote};
use crate::embree::Hit;
use crate::embree::rays::bound::Pair;

/// As Embree would have it.
fn single(t: f64) -> f32 {
    #[expect(clippy::cast_possible_truncation, reason = "far less than the bound")]
    let single = t as f32;
    single
}

/// A bug that the vote must see at so many rays, for nothing else than what it is.
#[track_caller]
fn assert_seen(vote: &RayVote, rays: u64, is: fn(&RayConflict) -> bool) {
    assert_eq!(vote.disagree, rays, "{vote}");
    assert!(vote.first.iter().all(|d| is(&d.conflict)), "{vote}");
    let judgement = vote.judgement(None);
    let causes = [(Cause::OracleDisagreement, rays)];
    assert_eq!(judgement.causes, causes.into(), "{vote}");
}

#[test]
fn a_hit_that_is_dropped_is_seen() {
    let (scene, [through, ..]) = (sheets(), straight());
    for query in QUERIES {
        let drop = scene.changed(|_, _| None);
        let vote = scene.against(&straight(), query, &drop);
        assert_seen(&vote, 1, |c| matches!(c, RayConflict::Missed { .. }));
        assert_eq!(vote.first[0].ray, 0, "{through:?} {vote}");
    }
}

#[test]
fn every_ray_that_meets_something_inside_misses_what_is_dropped() {
    let (scene, rays) = (soup(), anywhere(5_000));
    let nothing = scene.changed(|_, _| None);
    let inside = |ray: &&Ray| (0..200).any(|p| matches!(scene.pair(ray, p), Pair::Inside(_)));
    let met = rays.iter().filter(inside).count() as u64;
    for query in QUERIES {
        let vote = scene.against(&rays, query, &nothing);
        assert_seen(&vote, met, |c| matches!(c, RayConflict::Missed { .. }));
    }
}

#[test]
fn a_hit_where_none_is_is_seen() {
    let scene = sheets();
    let invent = scene.changed(|_, hit| hit.or(Some(Hit { prim: 2, t: 0.5 })));
    let vote = scene.against(&straight(), Query::Any, &invent);
    assert_seen(&vote, 2, |c| *c == RayConflict::Invented);
    let vote = scene.against(&straight(), Query::Closest, &invent);
    assert_seen(&vote, 2, |c| *c == RayConflict::Wrong { prim: 2 });
}

#[test]
fn a_wrong_triangle_is_seen_though_it_does_not_exist() {
    let scene = sheets();
    for prim in [2, 3, u32::MAX] {
        let other = scene.changed(|_, hit| hit.map(|hit| Hit { prim, ..hit }));
        let vote = scene.against(&straight(), Query::Closest, &other);
        assert_seen(&vote, 1, |c| matches!(c, RayConflict::Wrong { .. }));
    }
}

#[test]
fn a_triangle_behind_the_nearest_is_seen() {
    let scene = sheets();
    let behind = scene.changed(|ray, hit| {
        let time = crossing(ray, scene.blockers.corners(1));
        let t = time.map(|time| single(time.value()));
        hit.and(t).map(|t| Hit { prim: 1, t })
    });
    let vote = scene.against(&straight(), Query::Closest, &behind);
    assert_seen(&vote, 1, |c| matches!(c, RayConflict::Late { prim: 1, .. }));
}

#[test]
fn a_time_off_by_twice_the_bound_is_seen() {
    let (scene, rays) = (soup(), anywhere(5_000));
    let clean = scene.vote(&rays, Query::Closest);
    let off = scene.changed(|ray, hit| {
        hit.map(|hit| match scene.pair(ray, hit.prim) {
            Pair::Inside(met) => Hit {
                t: single(met.t - 2.0 * met.bound),
                ..hit
            },
            _ => hit,
        })
    });
    let vote = scene.against(&rays, Query::Closest, &off);
    assert_seen(&vote, clean.times - clean.edge, |c| {
        matches!(c, RayConflict::Time { .. })
    });
    assert!((1.5..2.5).contains(&vote.error_over_bound), "{vote}");
}

#[test]
fn a_time_that_is_no_number_is_seen() {
    let scene = sheets();
    let poison = scene.changed(|_, hit| hit.map(|hit| Hit { t: f32::NAN, ..hit }));
    let vote = scene.against(&straight(), Query::Closest, &poison);
    assert_seen(&vote, 1, |c| matches!(c, RayConflict::Time { .. }));
    assert_eq!(vote.error_over_bound, f64::INFINITY, "{vote}");
}

#[test]
fn a_triangle_that_the_grid_lost_is_seen() {
    let mut scene = sheets();
    scene.grid.prims.fill(2);
    for query in QUERIES {
        let vote = scene.vote(&straight(), query);
        assert_seen(&vote, 1, |c| {
            matches!(c, RayConflict::Unlisted { prim: 0 | 1 })
        });
    }
}
