//! What a vote counts, and what a pair is.

use crate::cause::Cause;
use crate::compare::embree::pairs::{Class, Expected};
use crate::compare::embree::{Conflict, DepthPair, Disagreement, EmbreeVote, Pair};

fn missed(pixel: u32) -> Disagreement {
    Disagreement {
        pixel,
        prim: 3,
        conflict: Conflict::Missed,
    }
}

/// Every count another power of two.
fn vote() -> EmbreeVote {
    EmbreeVote {
        rays: 1,
        pairs: 8192,
        edge: 4,
        edge_agreeing: 2,
        unresolved: 16,
        unresolved_agreeing: 8,
        missed: 32,
        invented: 64,
        depths: 128,
        depths_outside: 256,
        error_keys: 3.0,
        error_over_bound: 0.25,
        steps: 1024,
        steps_disordered: 512,
        repeated: 2048,
        first: vec![missed(70)],
    }
}

#[test]
fn votes_add_up() {
    let mut total = EmbreeVote::default();
    total.add(vote());
    assert_eq!(total, vote(), "nothing before it");
    total.add(EmbreeVote {
        error_keys: 2.0,
        error_over_bound: 0.5,
        ..vote()
    });
    assert_eq!((total.rays, total.pairs, total.repeated), (2, 16384, 4096));
    assert_eq!((total.error_keys, total.error_over_bound), (3.0, 0.5));
    assert_eq!(total.first, [missed(70); 2]);
}

#[test]
fn what_disagrees_is_all_that_is_judged_and_differs() {
    let vote = vote();
    assert_eq!(vote.disagreeing(), 32 + 64 + 256 + 512);
    assert_eq!(vote.admitted(), 4 + 16);
    assert_eq!(vote.causes(), [(Cause::OracleDisagreement, 864)].into());
    let words = "4 of 8192 pairs in class edge (2 agree), 16 unresolved (8 agree), 128 depths, \
                 error over bound 0.250; 864 disagree, first: pixel 70 triangle 3: covered, but \
                 Embree does not report it";
    assert_eq!(vote.to_string(), words);
}

#[test]
fn the_first_disagreements_are_kept() {
    let mut vote = EmbreeVote::default();
    (0..20).for_each(|pixel| vote.keep(missed(pixel)));
    let pixels: Vec<u32> = vote.first.iter().map(|d| d.pixel).collect();
    assert_eq!(pixels, [0, 1, 2, 3, 4, 5, 6, 7]);
}

#[test]
fn a_pair_is_what_both_say_of_it() {
    let with = |covered, class, hit| Expected { covered, class }.with(hit, |t| f64::from(t) * 2.0);
    for (covered, hit, agree) in [
        (true, Some(5.0), true),
        (true, None, false),
        (false, Some(5.0), false),
        (false, None, true),
    ] {
        assert_eq!(with(covered, Class::Edge, hit), Pair::Edge { agree });
        let unresolved = with(covered, Class::Unresolved, hit);
        assert_eq!(unresolved, Pair::Unresolved { agree });
    }
    let depth = Some((9, 0.5));
    let pair = DepthPair {
        key: 9,
        embree: 10.0,
        bound: 0.5,
    };
    for (covered, depth, hit, pair) in [
        (true, depth, Some(5.0), Pair::Depth(pair)),
        (true, depth, None, Pair::Missed),
        (true, None, None, Pair::Missed),
        (true, None, Some(5.0), Pair::Invented),
        (false, None, Some(5.0), Pair::Invented),
        (false, None, None, Pair::Neither),
    ] {
        assert_eq!(with(covered, Class::Judged { depth }, hit), pair);
    }
}

#[test]
fn a_depth_at_its_bound_is_inside() {
    let at = |embree| DepthPair {
        key: 10,
        embree,
        bound: 2.0,
    };
    for inside in [8.0, 10.0, 12.0] {
        assert!(!at(inside).is_outside(), "{inside}");
    }
    for outside in [7.5, 12.5, f64::INFINITY, f64::NAN] {
        assert!(at(outside).is_outside(), "{outside}");
    }
    assert_eq!((at(7.0).error(), at(7.0).ratio()), (3.0, 1.5));
}
