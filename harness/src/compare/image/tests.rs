use triptych_spec::bound::Bounded;

use super::compare;
use crate::cause::Cause;

fn channel(value: f64, bound: f64) -> Bounded {
    Bounded { value, bound }
}

/// Two pixels; the second has a channel that must be met exactly.
fn spec() -> [[Bounded; 3]; 2] {
    let loose = channel(0.5, 0.25);
    [[loose; 3], [loose, channel(1.0, 0.0), loose]]
}

#[test]
fn errors_and_their_share_of_the_bound_are_the_largest() {
    let same = compare(&spec(), &[[0.5; 3], [0.5, 1.0, 0.5]], 2);
    assert_eq!((same.compared, same.differ()), (6, 0));
    assert_eq!((same.error, same.error_over_bound), (Some(0.0), Some(0.0)));
    let near = compare(&spec(), &[[0.5, 0.625, 0.4375], [0.5, 1.0, 0.5]], 2);
    assert_eq!(near.differ(), 0);
    assert_eq!(
        (near.error, near.error_over_bound),
        (Some(0.125), Some(0.5))
    );
    let at_the_end = compare(&spec(), &[[0.25, 0.75, 0.5], [0.5, 1.0, 0.5]], 2);
    assert_eq!(
        (at_the_end.differ(), at_the_end.error_over_bound),
        (0, Some(1.0))
    );
}

#[test]
fn every_channel_outside_differs_where_it_is() {
    let seen = [[0.5; 3], [0.0, 1.5, f32::NAN]];
    let judgement = compare(&spec(), &seen, 1);
    assert_eq!(judgement.causes.get(&Cause::BlendRounding), Some(&3));
    assert_eq!(judgement.marks, [(1, Cause::BlendRounding); 3]);
    // What must be exact has no bound to be a share of.
    assert_eq!(
        (judgement.error, judgement.error_over_bound),
        (Some(0.5), Some(2.0))
    );
    let first = "blend-rounding: pixel (0, 1) is 0, must be 0.5 within 2.5e-1";
    assert_eq!(judgement.described[0], first);
}

#[test]
fn pictures_of_another_size_are_not_compared() {
    let judgement = compare(&spec(), &[[0.5; 3]], 2);
    assert_eq!(judgement.causes.get(&Cause::ReferenceMissing), Some(&1));
    assert_eq!((judgement.compared, judgement.error), (0, None));
}
