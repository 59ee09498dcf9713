use super::*;
use crate::compare::Judgement;
use crate::observe::{Gpu, Observed, Spec};
use crate::replay::rows::Rows;
use crate::row::Class;

const LEG: &str = "gpu@llvmpipe/compute";

fn mutant(more: &str) -> Mutant {
    let text = format!("name = \"m\"\ndefect = \"d\"\nscene = \"s\"\n{more}");
    toml::from_str(&text).expect("a mutant")
}

/// Rows of a leg: items compared, then the causes of what differs.
fn rows(stages: &[(u64, &[Cause])]) -> Vec<Row> {
    let mut rows = Rows::new("s", "abuffer");
    let spec = Observed::<Spec, _>::new("spec", ());
    let gpu = Observed::<Gpu, _>::new(LEG, ());
    for (compared, causes) in stages {
        let mut judgement = Judgement::new(Class::Exact, "items");
        judgement.compared = *compared;
        for cause in *causes {
            judgement.differs(*cause, None, || "words".into());
        }
        rows.add("build", &spec, &gpu, judgement);
    }
    rows.skip("sort", "spec", LEG, Class::Tie, "a reason".into());
    rows.rows
}

fn cell(mutant: &Mutant, stages: &[(u64, &[Cause])]) -> Cell {
    Cell::of(mutant, LEG.into(), &rows(stages)).expect("something was compared")
}

#[test]
fn rows_tell_how_a_mutant_dies() {
    let m = mutant("");
    let outcome = |stages: &[(u64, &[Cause])]| cell(&m, stages).outcome;
    assert_eq!(outcome(&[(9, &[])]), Outcome::NotObservable, "agrees");
    let value: &[Cause] = &[Cause::Coverage];
    assert_eq!(outcome(&[(9, value), (9, &[])]), Outcome::Result);
    let both: &[Cause] = &[Cause::Coverage, Cause::LostNode];
    assert_eq!(outcome(&[(9, both)]), Outcome::Structure);
    let counted = cell(&m, &[(9, both), (9, value)]);
    let causes = [(Cause::Coverage, 2), (Cause::LostNode, 1)];
    assert_eq!(counted.causes, causes.into(), "of all rows");
    assert_eq!(
        counted.note, "build: coverage: words",
        "the first difference"
    );
}

#[test]
fn nothing_compared_is_neither_dead_nor_alive() {
    let error = Cell::of(&mutant(""), LEG.into(), &rows(&[])).expect_err("only skips");
    assert_eq!(error, "gpu@llvmpipe/compute: nothing was compared");
}

#[test]
fn what_no_leg_sees_survives() {
    let (strict, racy) = (mutant(""), mutant("racy = true"));
    let hidden = cell(&strict, &[(9, &[])]);
    let dead = cell(&strict, &[(9, &[Cause::TieOrder])]);
    let blank = Cell::blank(&strict, LEG.into(), "no such adapter".into());
    for cells in [vec![], vec![hidden.clone()], vec![blank.clone()]] {
        for m in [&strict, &racy] {
            let wrong = m.judge(&cells).expect_err("nothing killed it");
            assert!(wrong.starts_with("m survives: d"), "{wrong}");
        }
    }
    assert_eq!(racy.judge(&[hidden.clone(), dead.clone()]), Ok(()));
    let wrong = strict
        .judge(&[dead.clone(), hidden])
        .expect_err("one leg hides it");
    assert_eq!(wrong, "gpu@llvmpipe/compute does not see m");
    assert_eq!(
        strict.judge(&[dead, blank]),
        Ok(()),
        "a leg that is not there"
    );
    let absent = mutant("absent = \"no such code\"");
    let cells = [Cell::blank(&absent, String::new(), "no such code".into())];
    assert_eq!(absent.judge(&cells), Ok(()), "nothing ran");
}

#[test]
fn a_mutant_dies_as_the_table_says() {
    let canary = mutant("cause = \"tie-order\"");
    let two: &[Cause] = &[Cause::TieOrder, Cause::SortOrder];
    let wrong = canary.judge(&[cell(&canary, &[(9, two)])]);
    let wrong = wrong.expect_err("two causes");
    assert!(
        wrong.contains("not exactly tie-order: sort-order 1, tie-order 1"),
        "{wrong}"
    );
    let mut unexplained = cell(&canary, &[(9, &[Cause::TieOrder])]);
    assert_eq!(canary.judge(std::slice::from_ref(&unexplained)), Ok(()));
    unexplained.unexplained = 1;
    assert!(canary.judge(&[unexplained]).is_err(), "one without a cause");
    let by = mutant("by = \"structure\"");
    let wrong = by.judge(&[cell(&by, &[(9, two)])]).expect_err("by a value");
    assert!(wrong.contains("killed by result"), "{wrong}");
    assert_eq!(by.judge(&[cell(&by, &[(9, &[Cause::Cycle])])]), Ok(()));
}

#[test]
fn a_matrix_counts_mutants_not_cells() {
    let m = mutant("");
    let dead = cell(&m, &[(9, &[Cause::Cycle])]);
    let renamed = |name: &str, cell: &Cell| Cell {
        mutant: name.into(),
        ..cell.clone()
    };
    let hidden = renamed("hidden", &cell(&m, &[(9, &[])]));
    let absent = renamed("absent", &Cell::blank(&m, String::new(), String::new()));
    let matrix = Matrix::of(
        &[dead.clone(), dead, hidden, absent],
        1.5,
        "2026-01-02".into(),
    );
    let counts = (matrix.mutants, matrix.killed, matrix.absent, matrix.cells);
    assert_eq!(counts, (2, 1, 1, 4));
    let line = "2 mutants, 1 killed, 1 survives, 1 absent, 1.50 s";
    assert_eq!(matrix.headline(), line);
    assert!(matrix.is_current(), "it was just made");
    let other = Matrix {
        kernels: String::new(),
        ..matrix
    };
    assert!(!other.is_current(), "other kernels");
}
