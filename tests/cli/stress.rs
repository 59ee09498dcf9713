//! `triptych bench --stress`, and those of families.

use std::fs;

use super::Place;
use super::results::{count, json};

#[test]
fn a_sweep_is_printed_and_written() {
    let place = Place::new("stress");
    let arguments = ["bench", "--stress", "offset", "--adapter", "swiftshader"];
    let files = ["--json", "o.jsonl", "--csv", "o.csv", "--out", "out"];
    let ran = place.run(&[&arguments[..], &files].concat()).expect(0);
    assert_eq!(ran.stderr, "");
    let lines = ran.stdout.lines().map(str::trim_start);
    let steps = lines.filter(|line| line.starts_with("2^")).count();
    assert_eq!(steps, 13, "a line for each step:\n{}", ran.stdout);
    // What a leg refuses has its reason.
    assert!(ran.stdout.contains("(gpu@SwiftShader"), "{}", ran.stdout);

    let mut rows = json(&place.root.join("o.jsonl"));
    let summary = rows.pop().expect("a summary");
    assert_eq!(count(&summary, "diverging"), 0);
    assert_eq!(count(&summary, "scenes"), 13);
    let bounded = rows.iter().filter(|r| r["error_over_bound"].is_number());
    assert!(bounded.clone().all(|r| r["error"].is_number()), "both");
    assert!(
        bounded.count() >= 13 * 4,
        "transform, clip, resolve, Embree"
    );

    let table = fs::read_to_string(place.root.join("o.csv")).expect("a table");
    assert_eq!(
        table.lines().count(),
        rows.len() + 1,
        "a line each, and names"
    );
    let names = table.lines().next().expect("names");
    for line in table.lines().filter(|line| !line.contains('"')) {
        assert_eq!(line.split(',').count(), names.split(',').count(), "{line}");
    }
    let page = ran.stdout.lines().last().expect("where the page lies");
    let page = page.strip_prefix("Report: ").expect("where the page lies");
    let page = fs::read_to_string(place.root.join(page)).expect("a page");
    for part in [
        "# Stability, ",
        "| 2^24 |",
        "SwiftShader: device ",
        "13 steps, ",
    ] {
        assert!(page.contains(part), "{page} lacks {part}");
    }
    // Every step can be replayed by itself.
    let scene = "out/scenes/offset/2^4/scene.toml";
    let replay = ["replay", scene, "--leg", "embree", "--no-cache"];
    place.run(&replay).expect(0);
    let again = rows[0]["again"].as_str().expect("a command");
    assert!(again.contains("scenes/offset/2^0/scene.toml"), "{again}");
}

/// What a sweep of a family said, on one adapter.
struct Driven {
    place: Place,
    shown: String,
    rows: Vec<serde_json::Value>,
    lines: usize,
    page: String,
}

/// Runs a sweep that must hold; each of its legs must be heard of so often.
fn driven(family: &str, sweep: &str, (legs, steps): (&[&str], usize)) -> Driven {
    let place = Place::new(&format!("stress-{family}"));
    let arguments = ["bench", family, "--stress", sweep];
    let files = ["--json", "o.jsonl", "--csv", "o.csv", "--out", "out"];
    let adapter = ["--adapter", "swiftshader"];
    let ran = place
        .run(&[&arguments[..], &adapter, &files].concat())
        .expect(0);
    assert_eq!(ran.stderr, "", "nothing is wrong");
    let mut rows = json(&place.root.join("o.jsonl"));
    let summary = rows.pop().expect("a summary");
    assert_eq!(count(&summary, "diverging"), 0, "{summary}");
    for leg in legs {
        let of_leg = rows.iter().filter(|r| r["b"] == *leg);
        assert!(
            of_leg.count() >= steps,
            "{leg}: each step that is not refused"
        );
    }
    let table = fs::read_to_string(place.root.join("o.csv")).expect("a table");
    let page = ran.stdout.lines().last().expect("where the page lies");
    let page = page.strip_prefix("Report: ").expect("where the page lies");
    let page = fs::read_to_string(place.root.join(page)).expect("a page");
    Driven {
        lines: table.lines().count(),
        shown: ran.stdout,
        place,
        rows,
        page,
    }
}

impl Driven {
    /// How many lines start with one of these.
    fn starting(&self, with: &[&str]) -> usize {
        let lines = self.shown.lines().map(str::trim_start);
        let starts = |line: &&str| with.iter().any(|n| line.starts_with(n));
        lines.filter(starts).count()
    }

    fn page_has(&self, parts: &[&str]) {
        for part in parts {
            assert!(self.page.contains(part), "{} lacks {part}", self.page);
        }
    }

    /// Every step can be replayed by itself.
    fn replays(&self, scene: &str) {
        let replay = ["replay", scene, "--leg", "embree", "--no-cache"];
        self.place.run(&replay).expect(0);
    }
}

#[test]
fn grids_are_driven_to_their_extremes() {
    let legs = ["every triangle", "embree", "gpu@SwiftShader/compute"];
    let driven = driven("grid", "offset", (&legs, 12));
    assert_eq!(
        driven.starting(&["1e"]),
        13,
        "a line for each step:\n{}",
        driven.shown
    );
    let refusal = "refused: `2.0000000000000002e39` is not finite";
    assert!(driven.shown.contains(refusal), "{}", driven.shown);
    assert_eq!(
        driven.lines,
        driven.rows.len() + 2,
        "a line each, names, and a refusal"
    );
    driven.page_has(&[
        "# Stability of grids and rays, ",
        "| spec |",
        "The longest walk",
        "| 1e6 |",
    ]);
    driven.replays("out/scenes-grid/offset/1e4/scene.toml");
}

#[test]
fn maps_are_driven_to_their_extremes() {
    let driven = driven("ldm", "convex", (&["embree", "gpu@SwiftShader/compute"], 4));
    let steps = driven.starting(&["8 ", "32 ", "128 ", "512 "]);
    assert_eq!(steps, 4, "a line for each step:\n{}", driven.shown);
    assert_eq!(
        driven.lines,
        driven.rows.len() + 1,
        "a line each, and names"
    );
    driven.page_has(&[
        "# Stability of layered depth maps, ",
        "4 steps, ",
        "points find what they must",
        "| key | spec |",
        "| 512 |",
    ]);
    driven.replays("out/scenes-ldm/convex/32/scene.toml");
}

/// Extremes of a family have their own help, name their sweeps, and take no scene.
fn has_own_help(family: &str, sweeps: &str, scene: &str) {
    let place = Place::new(&format!("stress-{family}-help"));
    let own = ["bench", family, "--stress"];
    let ran = place.run(&[&own[..], &["no-such"]].concat()).expect(2);
    assert_eq!(
        ran.stderr,
        format!("triptych: no-such: no sweep is called so; there are: {sweeps}\n"),
        "{family}"
    );
    for arguments in [
        &[&own[..], &["--help"]].concat()[..],
        &["bench", family, "--help"],
    ] {
        let help = place.run(arguments).expect(0);
        for part in ["Examples:", &format!("bench {family} --stress")] {
            assert!(help.stdout.contains(part), "{}", help.stdout);
        }
    }
    place.run(&["bench", family, scene, "--stress"]).expect(2);
}

#[test]
fn extremes_of_grids_have_their_own_help() {
    let sweeps = "aligned, cells, scale, offset, near, length, sliver, tiny, sparse";
    has_own_help("grid", sweeps, "dragon");
}

#[test]
fn extremes_of_maps_have_their_own_help() {
    let sweeps = "grazing, convex, slope, layers, resolution, directions, scale, offset, lattice, \
                  sliver, tiny";
    has_own_help("ldm", sweeps, "ldm/bunny");
}

#[test]
fn one_path_alone_is_asked_for() {
    let place = Place::new("stress-path");
    let arguments = ["bench", "--stress", "sliver", "--adapter", "llvmpipe"];
    let own = ["--path", "compute", "--json", "o.jsonl", "--out", "out"];
    place.run(&[&arguments[..], &own].concat()).expect(0);
    let mut rows = json(&place.root.join("o.jsonl"));
    rows.pop().expect("a summary");
    let of_gpu = |row: &&serde_json::Value| row["b"].as_str().is_some_and(|b| b.contains("gpu@"));
    let rows: Vec<_> = rows.iter().filter(of_gpu).collect();
    assert!(!rows.is_empty(), "a leg takes part");
    for row in rows {
        for (field, part) in [("b", "/compute"), ("again", "--path compute")] {
            let text = row[field].as_str().expect("text");
            assert!(text.contains(part), "{row}");
        }
    }
}

#[test]
fn what_is_no_sweep_is_told() {
    let place = Place::new("stress-none");
    let ran = place.run(&["bench", "--stress", "no-such"]).expect(2);
    assert_eq!(
        ran.stderr,
        "triptych: no-such: no sweep is called so; there are: scale, offset, sliver, depth, \
         edge-on, layers\n"
    );
    assert_eq!(ran.stdout, "");
    let help = place.run(&["bench", "--stress", "--help"]).expect(0);
    assert!(help.stdout.contains("Examples:"), "{}", help.stdout);
}
