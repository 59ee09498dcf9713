//! What a judgement counts, alone and summed up.

use super::*;

#[test]
fn an_exact_judgement_is_its_counts() {
    let judgement = Judgement::exact("pixels", 9, 2);
    let must = Judgement {
        compared: 9,
        unexplained: 2,
        ..Judgement::new(Class::Exact, "pixels")
    };
    assert_eq!(judgement, must);
    assert_eq!(judgement.differ(), 2, "without a cause");
}

#[test]
fn every_difference_is_counted_and_the_first_are_described() {
    let mut judgement = Judgement::new(Class::Decision, "fragments");
    judgement.differs(Cause::Duplicate, None, || "nowhere".into());
    for pixel in 0..5 {
        judgement.differs(Cause::Coverage, Some(pixel), || format!("at {pixel}"));
    }
    let causes = [(Cause::Duplicate, 1), (Cause::Coverage, 5)];
    assert_eq!(judgement.causes, causes.into());
    assert_eq!(judgement.differ(), 6);
    let marks: Vec<_> = (0..5).map(|pixel| (pixel, Cause::Coverage)).collect();
    assert_eq!(judgement.marks, marks, "those that have a pixel");
    let described = [
        "duplicate: nowhere",
        "coverage: at 0",
        "coverage: at 1",
        "coverage: at 2",
    ];
    assert_eq!(judgement.described, described);
}

#[test]
fn a_sum_has_all_counts_and_the_largest_errors() {
    let part = |pixel: u32, errors: [Option<f64>; 2]| {
        let mut part = Judgement::new(Class::Band, "pairs");
        (part.compared, part.unexplained, part.admitted) = (10, 2, 3);
        [part.error, part.error_over_bound] = errors;
        for _ in 0..3 {
            part.differs(Cause::Coverage, Some(pixel), || format!("at {pixel}"));
        }
        part
    };
    let mut other = part(8, [Some(1.0), Some(0.5)]);
    other.differs(Cause::Duplicate, None, || "twice".into());
    let sum = Judgement::sum([part(7, [Some(2.0), None]), other, part(9, [None; 2])]);
    assert_eq!((sum.class, sum.unit), (Class::Band, "pairs"));
    assert_eq!((sum.compared, sum.unexplained, sum.admitted), (30, 6, 9));
    assert_eq!(
        sum.causes,
        [(Cause::Coverage, 9), (Cause::Duplicate, 1)].into()
    );
    assert_eq!((sum.error, sum.error_over_bound), (Some(2.0), Some(0.5)));
    let marks = [[7; 3], [8; 3], [9; 3]].concat();
    assert_eq!(
        sum.marks,
        marks
            .into_iter()
            .map(|p| (p, Cause::Coverage))
            .collect::<Vec<_>>()
    );
    let described = [
        "coverage: at 7",
        "coverage: at 7",
        "coverage: at 7",
        "coverage: at 8",
    ];
    assert_eq!(sum.described, described);
    let nothing = Judgement::sum([]);
    assert_eq!((nothing.class, nothing.compared), (Class::Exact, 0));
}
