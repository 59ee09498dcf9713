//! `triptych bench legs`: what it writes. No time is judged.

use std::fs;

use super::{Place, deep};

#[test]
fn they_are_held_against_each_other() {
    let place = Place::new("bench-legs");
    place.write("corpus/abuffer/deep/scene.toml", &deep());
    let command = ["bench", "legs", "deep", "--adapter", "llvmpipe"];
    let files = ["--runs", "2", "--out", "out"];
    // Met or not, a benchmark judges no machine.
    let ran = place.run(&[&command[..], &files].concat()).expect(0);
    assert!(
        ran.stdout.contains(" of 4 demands are met"),
        "{}",
        ran.stdout
    );
    let files = fs::read_dir(place.root.join("out")).expect("a folder");
    let mut files: Vec<_> = files.map(|f| f.expect("a file").path()).collect();
    files.sort();
    let [csv, page] = &files[..] else {
        panic!("values and a page: {files:?}");
    };
    let values = fs::read_to_string(csv).expect("values");
    let has = |start: &str| {
        values
            .lines()
            .filter(|line| line.starts_with(start))
            .count()
    };
    assert_eq!(
        values.lines().count(),
        9,
        "four of stages, four of hits: {values}"
    );
    assert_eq!(has("abuffer/deep,cover,192,"), 2, "{values}");
    assert_eq!(has("abuffer/deep,build,192,spec,2,host,"), 1, "{values}");
    assert_eq!(has("abuffer/deep,hits,"), 4, "{values}");
    let page = fs::read_to_string(page).expect("a page");
    assert!(page.starts_with("# Leg against leg, "), "{page}");
}

#[test]
fn those_without_a_fragment_are_no_success() {
    let place = Place::new("bench-legs-nothing");
    let away = deep().replace("target = [0, 0, 0]", "target = [0, 0, 9]");
    place.write("corpus/abuffer/away/scene.toml", &away);
    let ran = place
        .run(&["bench", "legs", "away", "--runs", "1"])
        .expect(2);
    assert!(
        ran.stderr.contains("nothing was measured"),
        "{}",
        ran.stderr
    );
    assert!(
        ran.stdout.contains("not measured: abuffer/away"),
        "{}",
        ran.stdout
    );
}
