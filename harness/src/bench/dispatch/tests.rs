//! What is made of rows, and how they are come by.

use super::claims::claims;
use super::{Measured, Method, Options, Row, Spent, csv, lines, page, plots};
use crate::bench::{Machine, Spread};

/// Rows of two scenes with 1, 2 and 4 threads, in which LOCAL is the best but for the uneven one.
fn example() -> Measured {
    let one = |value: f64| Spread::of([value]);
    let mut rows = Vec::new();
    for scene in ["dispatch/bunny", "dispatch/uneven"] {
        for (method, rate, idle, access) in [
            (Method::Lock, 0.8, 1.0, 2.0),
            (Method::Lfree, 0.82, 0.9, 0.9),
            (Method::Local, 0.95, 1.2, 0.01),
        ] {
            for threads in [1, 2, 4] {
                let lost = scene == "dispatch/uneven" && method == Method::Local && threads > 1;
                let rate = if lost { 1.0 } else { rate * threads as f64 };
                rows.push(Row {
                    scene: scene.to_owned(),
                    size: [300, 300],
                    triangles: 12,
                    rays: 1000,
                    method,
                    threads,
                    fps: one(10.0 * rate),
                    speed_up: one(rate),
                    spent: Some(Spent {
                        idle,
                        access: access * f64::from(u32::try_from(threads).expect("few")).powi(2),
                    }),
                });
            }
        }
    }
    Measured {
        date: "2026-01-01".to_owned(),
        machine: Machine {
            cores: 4,
            cpu: "<four> cores".to_owned(),
            ..Machine::default()
        },
        frames: 20,
        runs: 3,
        boards: Vec::new(),
        rows,
        remarks: vec!["not measured: nothing".to_owned()],
    }
}

#[test]
fn threads_go_to_twice_the_cores() {
    assert_eq!(Options::threads(1), [1, 2], "one core");
    assert_eq!(Options::threads(2), [1, 2, 3, 4], "two");
    let many = [1, 2, 3, 4, 6, 8, 12, 16, 24, 32];
    assert_eq!(Options::threads(16), many, "sixteen");
    let odd = [1, 2, 3, 4, 5, 6, 8, 10];
    assert_eq!(
        Options::threads(5),
        odd,
        "cores and twice as many are among them"
    );
}

#[test]
fn claims_are_judged_by_rows() {
    let mut measured = example();
    let holds = |measured: &Measured| -> Vec<Option<bool>> {
        claims(measured).iter().map(|claim| claim.holds).collect()
    };
    // LFREE's access time grows with the square here; 4 threads say nothing of 24, nor 4 cores.
    let expected = [
        Some(true),
        Some(true),
        Some(true),
        None,
        Some(false),
        None,
        Some(true),
    ];
    assert_eq!(holds(&measured), expected, "of the example");
    for row in &mut measured.rows {
        row.fps = Spread::of([10.0 * row.threads as f64]);
    }
    let alike = holds(&measured);
    assert_eq!(alike[0], None, "LOCAL is no better, nor behind");
    assert_eq!(alike[6], None, "nor worse where work is uneven");
    for row in &mut measured.rows {
        if row.method == Method::Lfree {
            let fps = row.fps.median;
            row.fps = Spread::of([1.2 * fps, 1.3 * fps, 1.1 * fps]);
        }
    }
    let faster = holds(&measured);
    assert_eq!(faster[0], Some(false), "LOCAL is behind");
    assert_eq!(faster[2], Some(false), "LFREE is ahead");
    for row in &mut measured.rows {
        let fps = row.fps.median;
        row.fps = Spread::of([0.5 * fps, fps, 2.0 * fps]);
    }
    let unsteady = holds(&measured);
    assert_eq!(unsteady[0], None, "runs overlap");
    assert_eq!(unsteady[2], Some(true), "runs overlap");
    for row in &mut measured.rows {
        row.spent = row.spent.map(|spent| Spent {
            access: 1.0,
            ..spent
        });
    }
    let slow = holds(&measured);
    assert_eq!(slow[1], Some(false), "LOCAL's access is not negligible");
    measured.rows.retain(|row| row.threads == 4);
    assert_eq!(holds(&measured)[4], None, "one number of threads");
    measured.rows.clear();
    assert_eq!(holds(&measured), [None; 7], "nothing is told of nothing");
    let all = claims(&measured);
    let silent = |seen: &str| seen.ends_with("not measured");
    assert!(
        all.iter().all(|claim| silent(&claim.seen)),
        "nor seen in it"
    );
}

/// What the paper says of 24 cores is judged where there are as many, by the rows of 24 threads.
#[test]
fn claims_of_many_cores_need_them() {
    let mut measured = example();
    for row in &mut measured.rows {
        row.threads *= 6;
    }
    let judged = |measured: &Measured| {
        let claims = claims(measured);
        [3, 5].map(|at| claims[at].holds)
    };
    measured.machine.cores = 16;
    assert_eq!(judged(&measured), [None; 2]);
    measured.machine.cores = 24;
    assert_eq!(judged(&measured), [Some(false), Some(true)]);
    for row in measured
        .rows
        .iter_mut()
        .filter(|r| r.method == Method::Lfree)
    {
        row.fps = Spread::of([100.0]);
    }
    assert_eq!(judged(&measured), [Some(true), Some(true)]);
    measured.machine.cores = 12;
    assert_eq!(judged(&measured), [None; 2]);
}

#[test]
fn every_row_is_in_table_and_values() {
    let measured = example();
    assert_eq!(
        csv(&measured).lines().count(),
        1 + 18,
        "a line for each row"
    );
    let page = page(&measured);
    let rows = page
        .lines()
        .filter(|line| line.starts_with("| LOCAL |"))
        .count();
    assert_eq!(rows, 1 + 6, "explained once, and a row for each");
    assert_eq!(
        lines(&measured).len(),
        2 * (2 + 3),
        "two headings and three methods a scene"
    );
}

#[test]
fn endings_are_held_against_each_other() {
    let mut measured = example();
    assert!(
        !page(&measured).contains("When a frame is over"),
        "one ending"
    );
    let counted = measured
        .rows
        .iter()
        .filter(|row| row.method == Method::Lfree);
    let counted: Vec<Row> = counted
        .map(|row| Row {
            method: Method::LfreeCounted,
            fps: Spread::of([row.fps.median / 2.0]),
            spent: row.spent.map(|spent| Spent {
                idle: 3.0 * spent.idle,
                ..spent
            }),
            ..row.clone()
        })
        .collect();
    measured.rows.extend(counted);
    let page = page(&measured);
    assert!(
        page.contains("| dispatch/bunny | LFREE | 4 | 0.50 | 0.900 | 2.700 |"),
        "{page}"
    );
    assert!(
        !page.contains("| dispatch/bunny | LOCK | 4 | "),
        "it has one ending"
    );
}

#[test]
fn plots_are_sound() {
    for (name, text) in plots(&example()) {
        assert!(
            !text.contains("NaN") && !text.contains("inf"),
            "{name}: {text}"
        );
        assert_eq!(
            text.matches("<g ").count(),
            2,
            "{name}: a panel for each scene"
        );
        assert!(!text.contains("<four>"), "{name}: names are escaped");
    }
}
