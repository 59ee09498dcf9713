//! `triptych bench abuffer`: what it writes, and what it refuses. No time is judged.

use std::collections::BTreeMap;
use std::fs;
use std::path::PathBuf;

use triptych_harness::bench::csv::COLUMNS;

use super::{Place, Ran, deep, repository};

/// A file of results as rows of named values.
pub(super) fn rows(text: &str) -> Vec<BTreeMap<&'static str, &str>> {
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some(COLUMNS.join(",").as_str()), "the header");
    let mut rows = Vec::new();
    for line in lines {
        assert_eq!(line.split(',').count(), COLUMNS.len(), "{line}");
        rows.push(COLUMNS.into_iter().zip(line.split(',')).collect());
    }
    rows
}

#[test]
fn results_are_written_and_sound() {
    let place = Place::new("bench-results");
    place.write("corpus/abuffer/deep/scene.toml", &deep());
    let command = [
        "bench",
        "abuffer",
        "deep",
        "--runs",
        "2",
        "--svg",
        "own/f.svg",
    ];
    let stderr = place.run(&command).expect(0).stderr;
    let plain = stderr.contains("abuffer/deep: measuring\n");
    assert!(plain, "plain lines: {stderr}");
    let out = place.root.join("reports/out/bench");
    let read = |file: PathBuf| {
        fs::read_to_string(&file).unwrap_or_else(|e| panic!("{}: {e}", file.display()))
    };
    let csv = read(out.join("abuffer.csv"));
    let rows = rows(&csv);
    rows.iter().for_each(is_sound);
    let all = ["1", "2", "4", "8", "12"];
    let layers = |leg: &str, method: &str| -> Vec<&str> {
        let own = rows
            .iter()
            .filter(|r| r["leg"].contains(leg) && r["method"] == method);
        own.map(|r| r["layers"]).collect()
    };
    assert_eq!(layers("spec", "insertion"), all);
    assert_eq!(layers("llvmpipe/compute", "insertion"), all);
    assert_eq!(layers("llvmpipe/compute", "sort"), all);
    let own = read(place.root.join("own/f.svg"));
    assert_eq!(read(out.join("abuffer.svg")), own, "the same front");
    let files = fs::read_dir(&out).expect("a folder");
    let files = files.map(|f| f.expect("a file").path());
    let pages: Vec<_> = files
        .filter(|p| p.extension().is_some_and(|e| e == "md"))
        .collect();
    let [page] = &pages[..] else {
        panic!("one page: {pages:?}");
    };
    assert!(page.with_extension("svg").is_file(), "beside its front");
    let text = read(page.clone());
    for part in [
        "| 12 (all) |",
        "at least 2 rounds to warm up",
        "at work for 1 s on each scene",
        "exceed 100 %",
    ] {
        assert!(text.contains(part), "{part} in {text}");
    }
    // The report of a replay shows it.
    place.run(&["replay", "--leg", "spec", "deep"]).expect(0);
    let report = read(place.root.join("reports/out/index.html"));
    assert!(report.contains("class=\"front\""), "the front is shown");
}

/// Figures are finite and positive, and only all layers are right.
fn is_sound(row: &BTreeMap<&'static str, &str>) {
    for name in [
        "time_ms",
        "time_ms_min",
        "time_ms_max",
        "ratio",
        "memory_bytes",
        "fragments_per_second",
        "bound_ms",
        "fraction_of_bound",
    ] {
        let value: f64 = row[name].parse().unwrap_or(f64::NAN);
        assert!(value.is_finite() && value > 0.0, "{name}: {row:?}");
    }
    let exact = row["leg"] == "spec" && row["all"] == "true";
    assert_eq!(row["psnr_db"] == "exact", exact, "{row:?}");
    let psnr = row["psnr_db"].parse().unwrap_or(f64::INFINITY);
    assert_eq!(psnr > 100.0, row["all"] == "true", "{row:?}");
}

#[test]
fn a_wrong_kernel_is_named_and_not_timed() {
    let place = Place::new("bench-wrong");
    place.write("corpus/abuffer/deep/scene.toml", &deep());
    let example = repository().join("harness/examples/first-k/build.wgsl");
    let kernel = format!("build={}", example.display());
    let command = ["bench", "abuffer", "deep", "--runs", "1"];
    let on = |kernel| [&command[..], &["--adapter", "llvmpipe", "--kernel", kernel]].concat();
    let ran = place.run(&on(&kernel)).expect(1);
    let wrong = "triptych: abuffer/deep: gpu@llvmpipe/compute";
    assert!(ran.stderr.contains(wrong), "{}", ran.stderr);
    assert!(
        !ran.stdout.contains("gpu@llvmpipe/compute"),
        "{}",
        ran.stdout
    );
    // A kernel that has all fragments, each behind where it is.
    let text = "//#import abuffer\n";
    place.write("mine.wgsl", text);
    let kernel = "build=mine.wgsl";
    place.run(&on(kernel)).expect(0);
    let dark = fs::read_to_string(repository().join("gpu/src/abuffer.wgsl")).expect("ours");
    let dark = dark.replace("colours[address] = faces", "colours[address] = 0.5 * faces");
    place.write("mine.wgsl", &dark);
    let ran = place.run(&on(kernel)).expect(1);
    let first = ran.stderr.lines().find(|l| l.contains("llvmpipe/compute"));
    let first = first.unwrap_or_else(|| panic!("{}", ran.stderr));
    for part in [
        "abuffer/deep",
        "layers by insertion",
        "channels differ",
        "pixel (",
    ] {
        assert!(first.contains(part), "{part} in {first}");
    }
}

/// All layers have one colour, so that every order gives the same picture.
/// No frame of the scene has anything opaque: the kernel was not measured.
#[test]
fn a_kernel_that_never_ran_is_refused() {
    let place = Place::new("bench-idle");
    place.write("corpus/abuffer/deep/scene.toml", &deep());
    place.write("mine.wgsl", "//#import abuffer\n");
    let ran = place.run(&[
        "bench",
        "abuffer",
        "deep",
        "--runs",
        "1",
        "--adapter",
        "llvmpipe",
        "--kernel",
        "opaque=mine.wgsl",
    ]);
    let line = ran.expect(2).stderr;
    assert!(
        line.contains("no scene that was measured has opaque"),
        "{line}"
    );
}

#[test]
fn a_kernel_that_does_not_sort_is_found() {
    let place = Place::new("bench-sort");
    place.write("corpus/abuffer/deep/scene.toml", &deep());
    let empty = place.run(&["bench", "abuffer", "--kernel", "sort=?"]);
    place.write("empty.wgsl", &empty.expect(0).stdout);
    let command = ["bench", "abuffer", "deep", "--runs", "1", "--adapter"];
    let kernel = ["llvmpipe", "--kernel", "sort=empty.wgsl"];
    let ran = place.run(&[&command[..], &kernel].concat()).expect(1);
    let wrong = "triptych: abuffer/deep: gpu@llvmpipe/compute, sorted lists: 16 fragments differ; \
                 sort-order: pixel (";
    assert!(ran.stderr.contains(wrong), "{}", ran.stderr);
    assert!(!ran.stdout.contains("/compute"), "{}", ran.stdout);
}

/// A frame starts from snapped triangles.
#[test]
fn a_kernel_that_no_frame_runs_is_refused() {
    let place = Place::new("bench-not-run");
    place.write("corpus/abuffer/deep/scene.toml", &deep());
    for (stage, file) in [
        ("transform", "vertex"),
        ("clip", "vertex"),
        ("snap", "vertex"),
        ("cover", "raster"),
        ("peel", "peel"),
    ] {
        place.write("mine.wgsl", &format!("//#import {file}\n"));
        let kernel = format!("{stage}=mine.wgsl");
        let ran = place.run(&["bench", "abuffer", "deep", "--kernel", &kernel]);
        let ran = ran.expect(2);
        let words = format!(
            "triptych: --kernel {kernel}: no frame of bench runs this stage, only opaque, build, \
             sort, resolve, bin, jagged, shade, local, linked\n"
        );
        assert_eq!(ran.stderr, words);
        assert_eq!(ran.stdout, "");
    }
}

#[test]
fn mistakes_are_one_line() {
    let place = Place::new("bench-mistakes");
    place.write("corpus/abuffer/deep/scene.toml", &deep());
    let nosuch = place
        .run(&["bench", "abuffer", "deep", "--adapter", "nosuch"])
        .expect(2);
    let words = "triptych: no adapter is called nosuch; see `triptych doctor`\n";
    assert_eq!(nosuch.stderr, words);
    for wrong in [
        &["bench", "abuffer", "deep", "--runs", "0"][..],
        &["bench", "abuffer", "deep", "--layers", "1,0"],
        &["bench", "abuffer", "deep", "--samples", "3"],
        &["bench", "abuffer", "deep", "--budget", "0"],
        &["bench", "nosuch"],
        &["bench", "abuffer", "nosuch"],
    ] {
        let ran = place.run(wrong).expect(2);
        assert!(!ran.stderr.contains("panicked"), "{}", ran.stderr);
        assert_eq!(ran.stdout, "", "{wrong:?}");
    }
}

#[test]
fn nothing_measured_is_no_success() {
    let place = Place::new("bench-nothing");
    let opaque = deep().replace("opacity = 0.5", "opacity = 1");
    place.write("corpus/abuffer/opaque/scene.toml", &opaque);
    let ran = place
        .run(&["bench", "abuffer", "opaque", "--runs", "1"])
        .expect(2);
    assert!(
        ran.stderr.contains("nothing was measured"),
        "{}",
        ran.stderr
    );
    let why = "not measured: abuffer/opaque: nothing transparent is seen";
    assert!(ran.stdout.contains(why), "{}", ran.stdout);
}

/// Told in one line before anything is measured, and nothing of it is left behind.
#[test]
fn files_that_cannot_be_written_are_told_first() {
    let place = Place::new("bench-files");
    place.write("corpus/abuffer/deep/scene.toml", &deep());
    place.write("blocked", "a file, no folder");
    let (abuffer, legs) = (["bench", "abuffer", "deep"], ["bench", "legs", "deep"]);
    let stress = ["bench", "--stress", "layers"];
    let mutants = ["mutants", "background-left-out"];
    for (command, option) in [
        (&abuffer[..], "--json"),
        (&abuffer, "--csv"),
        (&abuffer, "--svg"),
        (&abuffer, "--out"),
        (&legs, "--out"),
        (&stress, "--json"),
        (&stress, "--csv"),
        (&stress, "--out"),
        (&mutants, "--json"),
    ] {
        let ran = place.run(&[command, &[option, "blocked/o"]].concat());
        let Ran { stderr, stdout, .. } = ran.expect(2);
        let told = stderr.starts_with("triptych: cannot write blocked/o");
        assert!(told && stderr.lines().count() == 1, "{option}: {stderr}");
        assert_eq!(stdout, "", "{command:?} {option}");
    }
    let both = ["--csv", "new/o.csv", "--svg", "blocked/o.svg"];
    place.run(&[&abuffer[..], &both].concat()).expect(2);
    let left = place.root.join("new/o.csv");
    assert!(!left.exists(), "nothing was measured");
}

/// As a bundle may be: it has one of the scenes that are measured without a pattern.
#[test]
fn scenes_that_are_not_here_are_named() {
    let place = Place::new("bench-partial");
    place.write("corpus/abuffer/furball/scene.toml", &deep());
    let command = ["bench", "abuffer", "--runs", "1", "--adapter", "llvmpipe"];
    let mut command = place.command(&command);
    let ran = Ran::of(command.env("TRIPTYCH_NATIVE", place.root.join("native"))).expect(0);
    for name in ["teapot: mesh teapot.obj", "dragon: mesh dragon.ply.gz"] {
        let words = format!("not measured: paper/{name} is not there");
        assert!(ran.stdout.contains(&words), "{}", ran.stdout);
    }
    for name in ["abuffer/sponza", "abuffer/dragon-full"] {
        let words = format!("not measured: {name}: not in this corpus\n");
        assert!(ran.stdout.contains(&words), "{}", ran.stdout);
    }
    assert!(ran.stdout.contains("\nabuffer/furball: "), "{}", ran.stdout);
}
