use super::*;
use crate::bench::Spread;
use crate::report::bench_example;

/// Rows of a scene on the hardware's path and on another: by lists, peeled, by tiles.
fn bench() -> Bench {
    let mut bench = bench_example();
    let example = bench.rows[0].clone();
    let row = |scene: &str, leg: &str, method, layers, ms| Row {
        scene: scene.to_owned(),
        leg: leg.to_owned(),
        method,
        layers,
        longest: 58,
        all: layers == 58,
        // From vertices on it is a millisecond more.
        time: Spread::of([ms]),
        frame: Some(Spread::of([ms + 1.0])),
        ..example.clone()
    };
    let [hardware, compute] = ["gpu@a/fragment", "gpu@a/compute"];
    bench.rows = vec![
        row(DRAGON, hardware, Method::Insertion, 58, 3.0),
        row(DRAGON, hardware, Method::Sort, 58, 7.0),
        row(DRAGON, hardware, Method::Peel, 58, 15.0),
        row(DRAGON, hardware, Method::Precalc, 58, 5.0),
        row(DRAGON, compute, Method::Sort, 58, 1.0),
        row(DRAGON, compute, Method::Tiles, 58, 0.25),
        row(MECHA, hardware, Method::Insertion, 8, 4.0),
        row(MECHA, hardware, Method::Insertion, 0, 1.5),
        row(MECHA, hardware, Method::Sort, 58, 9.0),
        row(MECHA, hardware, Method::Alpha, 58, 1.0),
    ];
    bench.rows.push(Row {
        samples: 4,
        ..row(
            "paper/dragon with 4 samples",
            hardware,
            Method::Sort,
            58,
            9.0,
        )
    });
    bench
}

fn cells<'s, const N: usize>(section: &'s Section, names: [&str; N]) -> Vec<&'s str> {
    let row = section.rows.iter().find(|row| row[..N] == names);
    let row = row.unwrap_or_else(|| panic!("no {names:?} in {:?}", section.rows));
    row[N..].iter().map(String::as_str).collect()
}

#[test]
fn ratios_are_of_whole_frames_over_the_fastest_list() {
    let section = table(&bench());
    let of = |leg: &str, name| cells(&section, [leg, name])[3..].join(" ");
    assert_eq!(of("gpu@a/fragment", "linked list"), "4.00 1.00 1.00");
    assert_eq!(of("gpu@a/fragment", "depth peeling"), "16.00 4.00 7.51");
    assert_eq!(of("gpu@a/fragment", "precalc"), "6.00 1.50 2.36");
    assert_eq!(of("gpu@a/compute", "precalc"), "– – 2.36");
    assert_eq!(of("gpu@a/compute", "lists by tiles"), "1.25 0.62 –");
    assert!(
        section
            .rows
            .iter()
            .all(|row| row.len() == section.columns.len())
    );
}

#[test]
fn layers_are_over_all_of_them() {
    let section = figure(&bench());
    let of = |layers| cells(&section, ["gpu@a/fragment", layers])[..4].join(" ");
    assert_eq!(of("8"), "5.00 200 0.50 0.73");
    assert_eq!(of("0"), "2.50 400 0.25 0.63");
    assert_eq!(of("64, all 58"), "10.00 100 1.00 1.00");
    assert_eq!(of("alpha blending"), "2.00 500 0.20 0.35");
    assert_eq!(section.rows.len(), 4, "what was not measured has no row");
}

#[test]
fn samples_are_over_one() {
    let section = samples(&bench());
    let of = |count| cells(&section, ["gpu@a/fragment", "linked list", count])[..3].join(" ");
    assert_eq!(of("1"), "4.00 1.00 1.00");
    assert_eq!(of("4"), "10.00 2.50 2.22");
}

#[test]
fn frames_are_beside_the_hardwares_lists() {
    let section = frames(&bench());
    let of = |leg, what| cells(&section, [leg, what])[..2].join(" ");
    assert_eq!(
        of("gpu@a/fragment", "paper/dragon, linked list"),
        "4.00 1.00"
    );
    assert_eq!(
        of("gpu@a/compute", "paper/dragon, linked list"),
        "2.00 2.00"
    );
    assert_eq!(of("gpu@a/compute", "paper/dragon, tiles"), "1.25 3.20");
    let parts = section.rows[0][4].as_str();
    assert!(parts.starts_with("vertices 1.00, "), "{parts}");
}

#[test]
fn nothing_of_the_paper_is_no_section() {
    assert!(sections(&bench_example()).is_empty());
}
