use triptych_spec::raster::{Fragment, cover};
use triptych_spec::scene::Size;
use triptych_spec::vertex::Primitives;

use super::{Rule, compare};
use crate::cause::Cause;
use crate::compare::Judgement;
use crate::row::Class;

const SIZE: Size = Size {
    width: 4,
    height: 4,
};

fn fragment(pixel: u32, prim: u32) -> Fragment {
    Fragment {
        pixel,
        prim,
        key: 10 + prim,
        mask: 1,
    }
}

/// Pixels 5 and 6, the first twice covered.
fn spec() -> Vec<Fragment> {
    vec![fragment(5, 0), fragment(5, 1), fragment(6, 0)]
}

/// Judges the spec's fragments after a change.
fn judge(change: impl FnOnce(&mut Vec<Fragment>)) -> Judgement {
    let mut other = spec();
    change(&mut other);
    compare(&spec(), &other, SIZE, &Rule::Exact)
}

fn only(judgement: &Judgement, cause: Cause, compared: u64, described: &str) {
    let causes: Vec<(Cause, u64)> = judgement.causes.iter().map(|(c, n)| (*c, *n)).collect();
    assert_eq!(causes, [(cause, 1)], "{:?}", judgement.described);
    assert_eq!((judgement.compared, judgement.admitted), (compared, 0));
    assert_eq!(judgement.described, [described]);
}

#[test]
fn the_same_in_another_order_agrees() {
    let judgement = judge(|other| other.reverse());
    assert_eq!(
        (judgement.compared, judgement.differ(), judgement.admitted),
        (3, 0, 0)
    );
    assert_eq!(
        (judgement.class, judgement.unit),
        (Class::Exact, "fragments")
    );
    assert_eq!(
        (judgement.note.as_str(), judgement.admitted_budget),
        ("", None)
    );
}

#[test]
fn every_difference_has_its_cause_and_place() {
    let lacks = judge(|other| other.retain(|f| f.prim != 1));
    let text = "coverage: pixel (1, 1) must be covered by triangle row 1, is not";
    only(&lacks, Cause::Coverage, 3, text);
    let more = judge(|other| other.push(fragment(15, 2)));
    let text = "coverage: pixel (3, 3) must not be covered by triangle row 2, is";
    only(&more, Cause::Coverage, 4, text);
    let twice = judge(|other| other.push(fragment(6, 0)));
    let text = "duplicate: pixel (2, 1) holds triangle row 0 more than once";
    only(&twice, Cause::Duplicate, 4, text);
    let nearer = judge(|other| other[2].key = 9);
    let text = "depth-key: pixel (2, 1) triangle row 0 has key 9, must be 10";
    only(&nearer, Cause::DepthKey, 3, text);
    let masked = judge(|other| other[2].mask = 3);
    let text = "sample-mask: pixel (2, 1) triangle row 0 has mask 0x3, must be 0x1";
    only(&masked, Cause::SampleMask, 3, text);
}

#[test]
fn without_fragments_the_pixels_are_what_is_empty() {
    let judgement = compare(&[], &[], SIZE, &Rule::Exact);
    assert_eq!((judgement.compared, judgement.unit), (16, "empty pixels"));
}

/// A triangle over the whole target, with one edge beside the samples of a column.
fn beside_a_column() -> (Primitives, Vec<Fragment>) {
    let edge = 2 * 256 + 128 + 1; // one sub-pixel right of the samples of column 2
    let primitives = Primitives {
        samples: triptych_spec::raster::Samples::ONE,
        size: SIZE,
        bits: 8,
        snapped: vec![[edge, -8192, 5], [edge, 8192, 5], [-16384, 0, 5]],
        prims: vec![[0, 1, 2]],
        source: vec![0],
    };
    let mut fragments = Vec::new();
    cover(&primitives, |f| fragments.push(f));
    (primitives, fragments)
}

#[test]
fn in_a_band_what_is_near_an_edge_may_go_either_way() {
    let (primitives, spec) = beside_a_column();
    assert_eq!(spec.len(), 12, "three columns");
    let rule = Rule::Band(&primitives);
    let same = compare(&spec, &spec, SIZE, &rule);
    assert_eq!((same.compared, same.differ(), same.admitted), (12, 0, 4));
    assert_eq!((same.class, same.admitted_budget), (Class::Band, Some(1.0)));
    let words = "MAY: 4 of 12 fragments (33.33 %) lie within a sub-pixel of an edge, \
                 0 of these went the other way";
    assert_eq!(same.note, words);

    // Two of the column are not there, one of another column, and one that nothing covers is.
    let gone = [2, 6, 1];
    let mut other: Vec<Fragment> = spec.clone();
    other.retain(|f| !gone.contains(&f.pixel));
    other.push(Fragment {
        pixel: 3,
        ..spec[0]
    });
    let changed = compare(&spec, &other, SIZE, &rule);
    assert_eq!(
        (changed.compared, changed.admitted),
        (13, 4),
        "{}",
        changed.note
    );
    assert_eq!(
        changed.causes.get(&Cause::Coverage),
        Some(&2),
        "columns 1 and 3"
    );
    assert!(
        changed.note.contains("2 of these went the other way"),
        "{}",
        changed.note
    );
}

#[test]
fn in_a_band_one_more_near_an_edge_went_the_other_way() {
    let (primitives, all) = beside_a_column();
    let fewer: Vec<Fragment> = all.iter().filter(|f| f.pixel != 2).copied().collect();
    let judgement = compare(&fewer, &all, SIZE, &Rule::Band(&primitives));
    assert_eq!(
        (judgement.compared, judgement.differ(), judgement.admitted),
        (12, 0, 4)
    );
    assert!(
        judgement.note.contains("1 of these went the other way"),
        "{}",
        judgement.note
    );
}
