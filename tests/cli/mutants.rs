//! `triptych mutants`, and how its matrix gets into the report.

use std::fs;

use super::results::{count, json};
use super::{Place, SCENE, repository};

/// A mutant, and its scene.
const MUTANT: &str = "last-of-equals-shows";
const GROUND: &str = "corpus/abuffer/opaque-ties/scene.toml";

fn place(name: &str) -> Place {
    let place = Place::new(name);
    let scene = fs::read_to_string(repository().join(GROUND)).expect("the mutant's scene");
    place.write(GROUND, &scene);
    place
}

#[test]
fn a_mutant_is_killed_and_written() {
    let place = place("mutants");
    let ran = place
        .run(&["mutants", MUTANT, "--json", "m.json"])
        .expect(0);
    assert_eq!(ran.stderr, "");
    for part in [MUTANT, "tie-order", "1 mutant, 1 killed, none survives"] {
        assert!(ran.stdout.contains(part), "{} lacks {part}", ran.stdout);
    }
    let mut lines = json(&place.root.join("m.json"));
    let summary = lines.pop().expect("a summary");
    assert_eq!(summary["type"], "mutants");
    assert_eq!(count(&summary, "cells"), lines.len() as u64);
    assert!(!lines.is_empty(), "there are adapters");
    for line in &lines {
        assert_eq!(line["outcome"], "result", "{line}");
    }
    let kept = place.root.join("reports/out/mutants.json");
    assert!(!kept.exists(), "one mutant is not the matrix");
}

#[test]
fn the_report_shows_the_last_run() {
    let place = place("mutants-report");
    place.write("corpus/raster/quads/scene.toml", SCENE);
    let page = || fs::read_to_string(place.root.join("reports/out/index.html")).expect("a report");
    let replay = ["replay", "--no-cache", "--leg", "spec", "raster/"];
    place.run(&replay).expect(0);
    assert!(page().contains("cargo triptych mutants"), "none was run");
    place
        .run(&["mutants", MUTANT, "--json", "reports/out/mutants.json"])
        .expect(0);
    place.run(&replay).expect(0);
    assert!(page().contains(MUTANT), "the matrix is there");
    place.run(&["report", "reports/out/mutants.json"]).expect(0);
    assert!(page().contains(MUTANT), "also alone");
    // A file that was damaged is worth a remark, not a failure.
    place.write("reports/out/mutants.json", "{}\n");
    let ran = place.run(&replay).expect(0);
    assert!(ran.stdout.contains("mutants.json:1: "), "{}", ran.stdout);
}

#[test]
fn one_path_alone_is_asked_for() {
    let place = place("mutants-path");
    let quads = "corpus/abuffer/quads/scene.toml";
    let scene = fs::read_to_string(repository().join(quads)).expect("the mutant's scene");
    place.write(quads, &scene);
    let of = ["background-left-out", "--json", "m.json"];
    let on = ["--adapter", "llvmpipe", "--path", "fragment"];
    place
        .run(&[&["mutants"], &of[..], &on[..]].concat())
        .expect(0);
    let lines = json(&place.root.join("m.json"));
    let legs: Vec<_> = lines.iter().filter_map(|l| l["leg"].as_str()).collect();
    assert!(
        matches!(legs[..], [leg] if leg.ends_with("/fragment")),
        "{legs:?}"
    );
    // A mutant of another path has not run, and is not said to have died.
    let ran = place.run(&[&["mutants", MUTANT], &on[..]].concat());
    let words = format!(
        "triptych: {MUTANT}: no mutant of these paths has a name, scene or cause like it
"
    );
    assert_eq!(ran.expect(2).stderr, words);
}

/// One that cannot be run keeps no other from it.
#[test]
fn a_mutant_without_its_scene_is_told() {
    let ran = place("mutants-scene").run(&["mutants", "ties"]).expect(2);
    assert!(ran.stdout.contains(MUTANT), "{}", ran.stdout);
    let missing = "abuffer/ties/scene.toml: does not exist";
    assert!(ran.stderr.contains(missing), "{}", ran.stderr);
}

#[test]
fn what_is_no_mutant_is_named() {
    let place = Place::new("mutants-none");
    let ran = place.run(&["mutants", "no-such"]).expect(2);
    assert_eq!(
        ran.stderr,
        "triptych: no-such: no mutant has a name, scene or cause like it\n"
    );
}
