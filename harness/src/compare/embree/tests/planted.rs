//! The comparer on planted bugs: each must be reported, and only it.

use super::{embree, large, three, vote};
use crate::cause::Cause;
use crate::compare::embree::Conflict;
use crate::embree::scene::Depth;
use crate::embree::{EmbreeError, EmbreeScene, Hit, RayHits, ScreenHits};

/// Embree's hits after a change: row-major pixel and hits.
struct Changed<F>(EmbreeScene, F);

impl<F: Fn(u32, &mut Vec<Hit>) + Sync> ScreenHits for Changed<F> {
    fn depth(&self) -> Depth {
        self.0.depth()
    }
}

impl<F: Fn(u32, &mut Vec<Hit>) + Sync> RayHits for Changed<F> {
    fn hits(&self, column: u32, row: u32, hits: &mut Vec<Hit>) -> Result<(), EmbreeError> {
        self.0.hits(column, row, hits)?;
        (self.1)(row * 64 + column, hits);
        Ok(())
    }
}

/// The pixel in the middle of the target.
const MIDDLE: u32 = 32 * 64 + 32;

#[test]
fn a_shift_by_one_sub_pixel_is_reported() {
    let spec = large(300);
    let mut shifted = spec.clone();
    for corner in &mut shifted.snapped {
        corner[0] += 1;
    }
    let vote = vote(&spec, &embree(&shifted));
    assert!(vote.missed > 0 && vote.invented > 0, "{vote}");
    assert_eq!(
        vote.causes(),
        [(Cause::OracleDisagreement, vote.disagreeing())].into()
    );
}

#[test]
fn a_lost_hit_is_reported() {
    let spec = large(300);
    let lose = |pixel, hits: &mut Vec<Hit>| {
        if pixel == MIDDLE {
            hits.remove(5);
        }
    };
    let vote = vote(&spec, &Changed(embree(&spec), lose));
    assert_eq!((vote.missed, vote.disagreeing()), (1, 1), "{vote}");
    assert_eq!(vote.first[0].pixel, MIDDLE, "{vote}");
    assert_eq!(vote.first[0].conflict, Conflict::Missed, "{vote}");
}

#[test]
fn every_covered_sample_misses_a_hit_that_is_lost() {
    let spec = large(300);
    let scene = embree(&spec);
    let clean = vote(&spec, &scene);
    let silent = vote(
        &spec,
        &Changed(scene, |_, hits: &mut Vec<Hit>| hits.clear()),
    );
    assert_eq!(silent.missed, clean.depths, "{silent}");
    assert_eq!((silent.depths, silent.invented), (0, 0), "{silent}");
}

#[test]
fn an_invented_hit_is_reported_wherever_the_triangle_lies() {
    let spec = three();
    let clean = vote(&spec, &embree(&spec));
    assert_eq!(clean.disagreeing(), 0, "{clean}");
    for prim in [1, 2] {
        let invent = |pixel, hits: &mut Vec<Hit>| {
            if pixel == MIDDLE - 5 {
                hits.push(Hit { prim, t: 1.0 });
            }
        };
        let vote = vote(&spec, &Changed(embree(&spec), invent));
        assert_eq!((vote.invented, vote.disagreeing()), (1, 1), "{vote}");
        assert_eq!(vote.first[0].prim, prim, "{vote}");
    }
}

#[test]
fn a_hit_that_comes_twice_counts_once() {
    let spec = large(300);
    let repeat = |pixel, hits: &mut Vec<Hit>| {
        if pixel == MIDDLE {
            hits.insert(5, hits[5]);
        }
    };
    let clean = vote(&spec, &embree(&spec));
    let vote = vote(&spec, &Changed(embree(&spec), repeat));
    assert_eq!((vote.repeated, vote.disagreeing()), (1, 0), "{vote}");
    assert_eq!(vote.pairs, clean.pairs, "{vote}");
}

#[test]
fn a_depth_off_by_twice_the_bound_is_reported() {
    let spec = three();
    // One layer of z = 2^20 - 7 + free: t is exact here up to its bound, which is
    // at most 2^-20 t (see `bound`) and one key.
    let off = |_, hits: &mut Vec<Hit>| {
        for hit in hits.iter_mut().filter(|hit| hit.prim == 0) {
            hit.t *= 1.0 + 4.0 / 1_048_576.0;
        }
    };
    let vote = vote(&spec, &Changed(embree(&spec), off));
    assert!(vote.depths > 1000, "{vote}");
    assert_eq!(vote.depths_outside, vote.depths, "{vote}");
}

#[test]
fn a_depth_that_is_not_a_number_is_reported() {
    let spec = three();
    let poison = |pixel, hits: &mut Vec<Hit>| {
        if pixel == 64 * 8 + 8 {
            hits[0].t = f32::NAN;
        }
    };
    let vote = vote(&spec, &Changed(embree(&spec), poison));
    assert_eq!(vote.depths_outside, 1, "{vote}");
}

#[test]
fn depths_in_the_wrong_order_are_reported() {
    let spec = large(300);
    let exchange = |pixel, hits: &mut Vec<Hit>| {
        if pixel == MIDDLE {
            (hits[3].t, hits[4].t) = (hits[4].t, hits[3].t);
        }
    };
    let vote = vote(&spec, &Changed(embree(&spec), exchange));
    assert_eq!(vote.depths_outside, 2, "{vote}");
    assert!(vote.steps_disordered > 0, "{vote}");
    let orders = vote.first.iter().filter(|d| d.conflict == Conflict::Order);
    assert!(orders.count() > 0, "{vote}");
}
