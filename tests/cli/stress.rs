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

#[test]
fn grids_are_driven_to_their_extremes() {
    let place = Place::new("stress-grid");
    let arguments = [
        "bench",
        "grid",
        "--stress",
        "offset",
        "--adapter",
        "swiftshader",
    ];
    let files = ["--json", "o.jsonl", "--csv", "o.csv", "--out", "out"];
    let ran = place.run(&[&arguments[..], &files].concat()).expect(0);
    assert_eq!(ran.stderr, "");
    let lines = ran.stdout.lines().map(str::trim_start);
    let steps = lines.filter(|line| line.starts_with("1e")).count();
    assert_eq!(steps, 13, "a line for each step:\n{}", ran.stdout);
    let refusal = "refused: `2.0000000000000002e39` is not finite";
    assert!(ran.stdout.contains(refusal), "{}", ran.stdout);

    let mut rows = json(&place.root.join("o.jsonl"));
    let summary = rows.pop().expect("a summary");
    assert_eq!(count(&summary, "diverging"), 0);
    for leg in ["every triangle", "embree", "gpu@SwiftShader/compute"] {
        let of_leg = rows.iter().filter(|r| r["b"] == leg);
        assert!(of_leg.count() >= 12, "{leg}: each step that is not refused");
    }
    let table = fs::read_to_string(place.root.join("o.csv")).expect("a table");
    let lines = table.lines().count();
    assert_eq!(lines, rows.len() + 2, "a line each, names, and a refusal");
    let page = ran.stdout.lines().last().expect("where the page lies");
    let page = page.strip_prefix("Report: ").expect("where the page lies");
    let page = fs::read_to_string(place.root.join(page)).expect("a page");
    for part in [
        "# Stability of grids and rays, ",
        "| spec |",
        "The longest walk",
        "| 1e6 |",
    ] {
        assert!(page.contains(part), "{page} lacks {part}");
    }
    // Every step can be replayed by itself.
    let scene = "out/scenes-grid/offset/1e4/scene.toml";
    let replay = ["replay", scene, "--leg", "embree", "--no-cache"];
    place.run(&replay).expect(0);
}

#[test]
fn extremes_of_grids_have_their_own_help() {
    let place = Place::new("stress-grid-help");
    let ran = place
        .run(&["bench", "grid", "--stress", "no-such"])
        .expect(2);
    assert_eq!(
        ran.stderr,
        "triptych: no-such: no sweep is called so; there are: aligned, cells, scale, offset, near, \
         length, sliver, tiny, sparse\n"
    );
    let own = ["bench", "grid", "--stress", "--help"];
    for arguments in [&own[..], &["bench", "grid", "--help"]] {
        let help = place.run(arguments).expect(0);
        assert!(help.stdout.contains("Examples:"), "{}", help.stdout);
        assert!(
            help.stdout.contains("bench grid --stress"),
            "{}",
            help.stdout
        );
    }
    place
        .run(&["bench", "grid", "dragon", "--stress"])
        .expect(2);
}

#[test]
fn maps_are_driven_to_their_extremes() {
    let place = Place::new("stress-ldm");
    let arguments = [
        "bench",
        "ldm",
        "--stress",
        "convex",
        "--adapter",
        "swiftshader",
    ];
    let files = ["--json", "o.jsonl", "--csv", "o.csv", "--out", "out"];
    let ran = place.run(&[&arguments[..], &files].concat()).expect(0);
    assert_eq!(ran.stderr, "");
    let lines = ran.stdout.lines().map(str::trim_start);
    let steps = lines.filter(|line| {
        ["8 ", "32 ", "128 ", "512 "]
            .iter()
            .any(|n| line.starts_with(n))
    });
    assert_eq!(steps.count(), 4, "a line for each step:\n{}", ran.stdout);

    let mut rows = json(&place.root.join("o.jsonl"));
    let summary = rows.pop().expect("a summary");
    assert_eq!(count(&summary, "diverging"), 0);
    for leg in ["embree", "gpu@SwiftShader/compute"] {
        let of_leg = rows.iter().filter(|r| r["b"] == leg);
        assert!(of_leg.count() >= 4, "{leg}: each step");
    }
    let table = fs::read_to_string(place.root.join("o.csv")).expect("a table");
    assert_eq!(
        table.lines().count(),
        rows.len() + 1,
        "a line each, and names"
    );
    let page = ran.stdout.lines().last().expect("where the page lies");
    let page = page.strip_prefix("Report: ").expect("where the page lies");
    let page = fs::read_to_string(place.root.join(page)).expect("a page");
    for part in [
        "# Stability of layered depth maps, ",
        "4 steps, ",
        "points find what they must",
        "| key | spec |",
        "| 512 |",
    ] {
        assert!(page.contains(part), "{page} lacks {part}");
    }
    // Every step can be replayed by itself.
    let scene = "out/scenes-ldm/convex/32/scene.toml";
    let replay = ["replay", scene, "--leg", "embree", "--no-cache"];
    place.run(&replay).expect(0);
}

#[test]
fn extremes_of_maps_have_their_own_help() {
    let place = Place::new("stress-ldm-help");
    let ran = place
        .run(&["bench", "ldm", "--stress", "no-such"])
        .expect(2);
    assert_eq!(
        ran.stderr,
        "triptych: no-such: no sweep is called so; there are: grazing, convex, slope, layers, \
         resolution, directions, scale, offset, lattice, sliver, tiny\n"
    );
    let own = ["bench", "ldm", "--stress", "--help"];
    for arguments in [&own[..], &["bench", "ldm", "--help"]] {
        let help = place.run(arguments).expect(0);
        for part in ["Examples:", "bench ldm --stress"] {
            assert!(help.stdout.contains(part), "{}", help.stdout);
        }
    }
    place
        .run(&["bench", "ldm", "ldm/bunny", "--stress"])
        .expect(2);
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
