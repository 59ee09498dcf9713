//! The arithmetic of ratios and demands, and what is written of it.

use super::super::Spread;
use super::{Against, Legs, More, Row, Taken, csv, lines, order, page};

fn taken(leg: &str, items: u64, seconds: &[f64]) -> Taken {
    Taken {
        seconds: seconds.to_vec(),
        ..Taken::new(leg, "host", items)
    }
}

/// Twice as many items in the same, twice, and half the time.
fn row(most: Option<f64>) -> Row {
    let own = taken("spec", 200, &[1.0, 4.0, 1.0]);
    let other = taken("gpu@x, y/fragment", 100, &[1.0, 2.0, 2.0]);
    own.row("a/b", "cover", Some((&other, most)))
}

#[test]
fn ratios_are_of_items_and_within_a_round() {
    let row = row(Some(0.5));
    let against = row.against.as_ref().expect("held against the other");
    let must = Spread {
        median: 0.5,
        min: 0.25,
        max: 1.0,
    };
    assert_eq!(against.ratio, must, "not the ratio of medians, 0.25");
    assert_eq!((row.time.median, row.rate()), (1000.0, 200.0));
}

#[test]
fn a_demand_is_met_up_to_its_limit() {
    let met = |most| row(most).against.as_ref().and_then(Against::met);
    assert_eq!(met(Some(0.5)), Some(true), "no slower");
    assert_eq!(met(Some(0.49)), Some(false), "slower");
    assert_eq!(met(None), None, "nothing is demanded");
}

#[test]
fn rounds_go_there_and_back() {
    assert_eq!(order(0, 3).collect::<Vec<_>>(), [0, 1, 2]);
    assert_eq!(order(1, 3).collect::<Vec<_>>(), [2, 1, 0]);
}

#[test]
fn files_say_what_was_measured() {
    let legs = Legs {
        date: "2000-01-02".into(),
        machine: super::Machine {
            slug: "m".into(),
            ..Default::default()
        },
        runs: 3,
        rows: vec![row(Some(0.5)), row(Some(0.4)), row(None)],
        remarks: vec!["a | remark".into()],
    };
    assert_eq!(legs.stem(), "legs-2000-01-02-m");
    let csv = csv(&legs);
    let line = csv.lines().nth(1).expect("a row");
    let must = "a/b,cover,200,spec,3,host,1000.000000,1000.000000,4000.000000,200,\
                \"gpu@x, y/fragment\",0.500000,0.250000,1.000000,0.5,,,,,";
    assert_eq!(line, must);
    let page = page(&legs);
    for part in [
        "1 of 2 demands are met",
        "at most 0.5: met",
        "at most 0.4: not met",
        "a \\| remark",
    ] {
        assert!(page.contains(part), "{part} in {page}");
    }
    let lines = lines(&legs).join("\n");
    assert!(
        lines.contains("0.50 [0.25, 1.00] of gpu@x, y/fragment"),
        "{lines}"
    );
}

/// Columns that no row fills are left out of tables, and are empty in the file of values.
#[test]
fn what_else_is_known_has_columns() {
    let more = More {
        memory: Some(3 << 20),
        bound: Some(("bytes", 0.25)),
        unlike: Some([7, 2000]),
    };
    let known = Taken {
        more,
        ..taken("obvhs", 100, &[1.0])
    };
    let legs = Legs {
        date: "2000-01-02".into(),
        machine: super::Machine::default(),
        runs: 1,
        rows: vec![known.row("a/b", "build", None), row(None)],
        remarks: Vec::new(),
    };
    let values = csv(&legs);
    assert!(
        values.contains(",,,,,,3145728,bytes,0.250000,7,2000\n"),
        "{values}"
    );
    let text = page(&legs);
    let heading = "| items/s | time an item over | memory | of bound | unlike the spec |";
    assert!(text.contains(heading), "{text}");
    assert!(
        text.contains("|  | 3.0 MiB | 25.0 % bytes | 7 of 2,000 |"),
        "{text}"
    );
    let [first, second] = [0, 1].map(|at| lines(&legs)[at].clone());
    assert!(first.ends_with("unlike the spec") && second.contains("25.0 % bytes"));
    assert!(!first.contains("demand"), "{first}");
}
