//! `triptych bench abuffer` beyond layers of lists. No time is judged.

use std::collections::BTreeMap;
use std::fs;

use super::bench::rows;
use super::{Place, deep};

/// Techniques beside lists, several samples and bands, each with its figures.
#[test]
fn techniques_samples_and_bands_are_measured() {
    let place = Place::new("bench-techniques");
    place.write("corpus/abuffer/deep/scene.toml", &deep());
    let command = [
        "bench",
        "abuffer",
        "deep",
        "--runs",
        "1",
        "--layers",
        "2",
        "--rivals",
        "--samples",
        "1,4",
        // Less than the lists of one sample take, which are 192 fragments of 32 bytes.
        "--budget",
        "0.000005",
        "--adapter",
        "llvmpipe",
    ];
    let ran = place.run(&command).expect(0);
    let csv = fs::read_to_string(place.root.join("reports/out/bench/abuffer.csv"));
    let csv = csv.expect("rows were written");
    let rows = rows(&csv);
    let of = |leg: &str, method: &str| {
        let is = |r: &&BTreeMap<&str, &str>| r["leg"].ends_with(leg) && r["method"] == method;
        rows.iter().filter(is).collect::<Vec<_>>()
    };
    for (method, on_fragment, on_compute) in [
        ("peel", 1, 1),
        ("dual", 1, 1),
        ("alpha", 1, 0),
        ("weighted", 1, 1),
        ("half", 0, 1),
        ("quarter", 0, 1),
        // Two layers and all with one sample, all with four.
        ("tiles", 0, 3),
        ("sort", 3, 3),
    ] {
        let seen = ["/fragment", "/compute"].map(|leg| of(leg, method).len());
        assert_eq!(seen, [on_fragment, on_compute], "{method}: {csv}");
    }
    for row in rows.iter().filter(|row| row["leg"] != "spec") {
        let number = |name: &str| row[name].parse().unwrap_or(f64::NAN);
        assert!(number("frame_ms") > number("time_ms"), "{row:?}");
        let banded = ["insertion", "sort"].contains(&row["method"]);
        assert_eq!(number("bands") > 1.0, banded, "{row:?}");
        // These may be right by chance, as the quads come in the order of their depths.
        if !["alpha", "weighted", "packed", "half", "quarter"].contains(&row["method"]) {
            let exact = number("psnr_db") > 100.0;
            assert_eq!(exact, row["all"] == "true", "{row:?}");
        }
    }
    let sorted = of("/fragment", "sort");
    let samples: Vec<&str> = sorted.iter().map(|r| r["samples"]).collect();
    assert_eq!(samples, ["1", "1", "4"]);
    assert_eq!(of("/compute", "sort")[0]["bytes_per_fragment"], "32");
    layouts_are_measured(&rows);
    let parts = [
        "abuffer/deep with 4 samples",
        " bands ",
        "\nLayouts and formats of nodes: ",
        "8: met",
    ];
    let shown = parts.iter().all(|part| ran.stdout.contains(part));
    assert!(shown, "{}", ran.stdout);
    let svg = fs::read_to_string(place.root.join("reports/out/bench/abuffer.svg"));
    let bars = svg.is_ok_and(|svg| svg.contains("all layers, lists in several layouts"));
    assert!(bars, "bars of layouts");
}

/// Every layout on both paths, with its bytes, and building apart from what is made of the lists.
fn layouts_are_measured(rows: &[BTreeMap<&str, &str>]) {
    for (method, bytes) in [
        ("regions", "32"),
        ("packed", "16"),
        ("ordered", "12"),
        ("precalc", "8"),
        ("bucket", "8"),
    ] {
        for path in ["/fragment", "/compute"] {
            let is = |r: &&BTreeMap<&str, &str>| r["leg"].ends_with(path) && r["method"] == method;
            let own: Vec<_> = rows.iter().filter(is).collect();
            let [own] = own[..] else {
                panic!("{} rows of {method} on {path}", own.len());
            };
            assert_eq!(own["bytes_per_fragment"], bytes, "{method}");
            for part in ["build_ms", "resolve_ms"] {
                let ms: f64 = own[part].parse().unwrap_or(0.0);
                assert!(ms > 0.0, "{part}: {own:?}");
            }
            // A byte a channel is an approximation, whose error is told.
            let psnr: f64 = own["psnr_db"].parse().unwrap_or(f64::NAN);
            assert_eq!((40.0..100.0).contains(&psnr), method == "packed", "{own:?}");
        }
    }
}
