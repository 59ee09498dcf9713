use super::*;
use crate::row::Class;

/// A row that agrees; tests change what they are about.
pub fn row(scene: &str, stage: &str, a: &str, b: &str) -> Row {
    Row {
        scene: scene.to_owned(),
        family: "abuffer".to_owned(),
        stage: stage.to_owned(),
        a: a.to_owned(),
        b: b.to_owned(),
        class: Class::Exact,
        unit: "fragments".to_owned(),
        compared: 1000,
        differ: 0,
        causes: BTreeMap::new(),
        unexplained: 0,
        admitted: 0,
        admitted_budget: None,
        error: None,
        error_over_bound: None,
        skipped: None,
        cached: false,
        ms_a: None,
        ms_b: None,
        note: String::new(),
        again: String::new(),
    }
}

fn skipped(mut row: Row, reason: &str) -> Row {
    row.compared = 0;
    row.skipped = Some(reason.to_owned());
    row
}

#[test]
fn nothing_compared_is_never_a_pass() {
    assert_eq!(verdict(&[]), Verdict::Diverge, "no rows");
    let silent = Row {
        compared: 0,
        ..row("s", "build", "spec", "embree")
    };
    assert_eq!(verdict(&[silent]), Verdict::Diverge, "no reason given");
    let skip = skipped(row("s", "build", "spec", "embree"), "no Embree");
    assert_eq!(verdict([&skip]), Verdict::Skipped, "a reason given");
    let agree = row("s", "sort", "spec", "embree");
    assert_eq!(verdict([&skip, &agree]), Verdict::Agree, "partly skipped");
}

#[test]
fn pairs_keep_order_and_add_up() {
    let rows = [
        row("s", "cover", "spec", "embree"),
        row("s", "cover", "spec", "gpu@x/compute"),
        Row {
            differ: 2,
            unexplained: 3,
            ..row("s", "build", "spec", "embree")
        },
    ];
    let pairs = pairs(&rows);
    let labels: Vec<_> = pairs.iter().map(|p| (p.b, p.compared())).collect();
    assert_eq!(labels, [("embree", 2000), ("gpu@x/compute", 1000)]);
    assert_eq!(pairs[0].differ(), 3, "unexplained items differ too");
    assert_eq!(pairs[0].verdict(), Verdict::Diverge);
    assert_eq!(pairs[1].verdict(), Verdict::Agree);
}

#[test]
fn scenes_gather_rows_that_came_apart() {
    let rows = [
        row("b", "cover", "spec", "embree"),
        row("a", "cover", "spec", "embree"),
        row("b", "build", "spec", "embree"),
    ];
    let scenes = scenes(&rows);
    let sizes: Vec<_> = scenes.iter().map(|(s, rows)| (*s, rows.len())).collect();
    assert_eq!(sizes, [("b", 2), ("a", 1)]);
}

#[test]
fn a_stage_of_a_leg_is_timed_once() {
    let timed = |stage, b, ms_a, ms_b| Row {
        ms_a,
        ms_b,
        ..row("s", stage, "spec", b)
    };
    let rows = [
        timed("cover", "gpu@x/compute", Some(8.0), None),
        timed("cover", "embree", Some(8.0), Some(3.0)),
        timed("build", "gpu@x/compute", Some(2.0), Some(1.0)),
    ];
    let times = Times::of(&rows);
    assert_eq!(times.legs, ["spec", "embree", "gpu@x/compute"]);
    assert_eq!(times.stages[0], ("cover", vec![Some(8.0), Some(3.0), None]));
    assert_eq!(times.stages[1], ("build", vec![Some(2.0), None, Some(1.0)]));
    let totals = [0, 1, 2].map(|leg| times.total(leg));
    assert_eq!(totals, [Some(10.0), Some(3.0), Some(1.0)]);
}

#[test]
fn rows_that_time_the_same_work_again_do_not_count_twice() {
    let timed = |stage, b| Row {
        ms_b: Some(5.0),
        ..row("s", stage, "gpu@x/compute", b)
    };
    let rows = [
        timed("build", "gpu@x/fragment"),
        timed("overflow", "gpu@x/fragment"),
        timed("end to end", "gpu@x/fragment"),
        timed("plan", "gpu@x/compute --no-skip"),
    ];
    let times = Times::of(&rows);
    assert_eq!(times.legs, ["gpu@x/fragment", "gpu@x/compute --no-skip"]);
    assert_eq!([0, 1].map(|leg| times.total(leg)), [Some(5.0), None]);
    assert_eq!(times.stages.len(), 4, "all are shown");
}

#[test]
fn columns_have_an_order_of_their_own() {
    let mut pairs = [
        ("spec", "closed form"),
        ("gpu@x/compute", "gpu@x/compute --no-skip"),
        ("spec", "gpu@y/compute"),
        ("spec", "embree"),
        ("spec", "gpu@x/fragment"),
        ("spec", "gpu@x/compute"),
    ];
    pairs.sort_by(|x, y| column_order(x.0, x.1).cmp(&column_order(y.0, y.1)));
    let legs = pairs.map(|(_, b)| b);
    let expected = [
        "gpu@x/compute",
        "gpu@x/fragment",
        "gpu@y/compute",
        "embree",
        "gpu@x/compute --no-skip",
        "closed form",
    ];
    assert_eq!(legs, expected);
}

#[test]
fn the_edge_share_is_the_worst_one() {
    let edge = |admitted, budget| Row {
        admitted,
        admitted_budget: budget,
        ..row("s", "cover", "spec", "embree")
    };
    assert_eq!(edge_share(&[edge(5, None)]), None, "not held to a budget");
    let within = [edge(1, Some(0.5)), edge(100, Some(0.5))];
    assert_eq!(edge_share(&within), Some((0.1, false)));
    let over = [edge(100, Some(0.5)), edge(2, Some(0.001))];
    assert_eq!(edge_share(&over), Some((0.1, true)));
}

#[test]
fn skips_are_counted_by_reason() {
    let rows = [
        skipped(row("s", "build", "spec", "embree"), "no Embree"),
        skipped(row("s", "build", "spec", "gpu@x/compute"), "no adapter"),
        skipped(row("t", "build", "spec", "gpu@x/compute"), "no adapter"),
    ];
    assert_eq!(skips(&rows), [("no adapter", 2), ("no Embree", 1)]);
}

#[test]
fn only_the_name_of_a_path_is_one() {
    for (label, adapter, path) in [
        ("gpu@x/compute", "x", Some("compute")),
        (
            "gpu@x/y/compute --no-skip",
            "x/y",
            Some("compute --no-skip"),
        ),
        ("gpu@x", "x", None),
        ("gpu@x/y", "x/y", None),
    ] {
        assert_eq!(leg_parts(label), ("gpu", Some(adapter), path), "{label}");
    }
}
