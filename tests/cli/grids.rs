//! What a scene with a grid leaves behind: arrays, and pictures in the report.

use std::fs;

use super::Place;
use super::results::npy;

/// A replay on one adapter and path.
const REPLAY: [&str; 5] = ["replay", "--adapter", "swiftshader", "--path", "compute"];

/// A quad that blocks rays: the same arrays of spec and adapter, and the same numbers in all
/// that decides.
#[test]
fn grids_are_dumped_by_every_leg() {
    let place = Place::new("dump-grid");
    place.write("corpus/grid/quads/scene.toml", GRID);
    place
        .run(&[&REPLAY[..], &["--dump", "out"]].concat())
        .expect(0);
    let of = |leg: &str, array: &str| {
        let file = format!("out/grid/quads/{leg}/grid/{array}.npy");
        npy(&place.root.join(file)).1
    };
    let legs = ["spec", "gpu@SwiftShader-compute"];
    for array in [
        "dims",
        "boundaries",
        "lattice",
        "triangles",
        "offsets",
        "prims",
        "rays",
    ] {
        let [spec, gpu] = legs.map(|leg| of(leg, array));
        assert!(!spec.is_empty(), "{array} has numbers");
        assert_eq!(spec, gpu, "{array}");
    }
    // Rays are 7 numbers of 4 bytes, hits 2, times one of 8.
    let rays = of("spec", "rays").len() / 28;
    assert_eq!(rays, 6 * 50);
    let [spec, gpu] = legs.map(|leg| of(leg, "hit"));
    assert_eq!(spec.len(), 8 * rays);
    let met = |hit: &[u8]| [0, 4].map(|at| hit[at..at + 4] != [255; 4]);
    let hits = spec.chunks(8).zip(gpu.chunks(8));
    assert!(hits.clone().all(|(a, b)| met(a) == met(b)), "met by both");
    assert!(hits.clone().any(|(a, _)| met(a) == [true; 2]), "some are");
    let [spec, gpu] = legs.map(|leg| of(leg, "t"));
    let number = |t: &[u8]| f64::from_le_bytes(t.try_into().expect("eight bytes"));
    let times = spec.chunks(8).zip(gpu.chunks(8));
    for ((a, b), (hit, _)) in times.zip(hits) {
        let [a, b] = [a, b].map(number);
        assert_eq!(a.is_nan(), !met(hit)[1], "no time where nothing is met");
        assert!(a.is_nan() == b.is_nan(), "{a} {b}");
        assert!(a.is_nan() || (a >= 0.0 && b >= 0.0), "{a} {b}");
    }
}

/// What every leg sees, the same; what the lists hold; and where rays hit. All of it from the
/// cache as well.
#[test]
fn the_report_shows_a_grid() {
    let place = Place::new("grid-pictures");
    place.write("corpus/grid/quads/scene.toml", GRID);
    for cached in [false, true] {
        let ran = place.run(&REPLAY).expect(0);
        assert_eq!(ran.stdout.contains("✓c"), cached, "{}", ran.stdout);
        let page = place.root.join("reports/out/index.html");
        let page = fs::read_to_string(page).expect("a report");
        for title in [
            "spec",
            "gpu@SwiftShader/compute",
            "embree",
            "entries",
            "longest list",
            "hits",
        ] {
            let figure = format!("<figure data-titles=\"{title}\">");
            assert_eq!(page.matches(&figure).count(), 1, "{title}, {cached}");
        }
        for words in [
            "see through the grid, along −z and without perspective",
            "Of 4 × 4 × 2 cells 0 % are empty; the others list 64 entries for 4 triangles.",
            "The longest of all holds 2 triangles, in cell (",
            "of 300 that all legs are asked ",
        ] {
            assert!(page.contains(words), "{cached}: no {words}");
        }
        assert!(
            page.contains("<h4>Compare pictures</h4>"),
            "there are no lists to look into"
        );
    }
}

/// Rays of a subgroup go through lists of thousands of needles, each at its own pace, and a driver
/// that counts the steps of all of them ends their loops early: that is no list without end.
#[test]
fn rays_that_wait_for_each_other_take_more_dispatches() {
    let place = Place::new("grid-needles");
    let needles = "purpose = 'needles'\nsize = [8, 8]\n[[mesh]]\ngenerate.scatter = { count = 8192, \
                   extent = [0, 2, 2], length = 0.001, width = 0.0001 }\nscale = [1e6, 1, 1]\n[grid]\n\
                   resolution = [16, 1, 1]\nrays = { random = 64, aimed = 0, edge = 0, vertex = 0, \
                   grazing = 0, cell = 0 }\n";
    place.write("corpus/grid/needles/scene.toml", needles);
    let on = |adapter| {
        [
            "replay",
            "--leg",
            "gpu",
            "--path",
            "compute",
            "--adapter",
            adapter,
        ]
    };
    for adapter in ["llvmpipe", "swiftshader"] {
        let ran = place.run(&on(adapter)).expect(0);
        assert!(ran.stdout.contains("All agree: 1 scene"), "{}", ran.stdout);
    }
}

/// Options that only rasterised scenes know are told once, and a vote without rays says so.
#[test]
fn options_without_effect_are_told_once() {
    let place = Place::new("grid-options");
    let unasked = GRID.replace("= 50", "= 0");
    place
        .write("corpus/grid/quads/scene.toml", GRID)
        .write("corpus/grid/twice/scene.toml", GRID)
        .write("corpus/grid/unasked/scene.toml", &unasked);
    let told = "without effect on scenes with [grid], [rsm], [ldm] or [dispatch]: ";
    for (options, said) in [
        (&[][..], None),
        (&["--gpu-from", "sort"], Some("--gpu-from")),
        (&["--vertex", "gpu"], Some("--vertex")),
    ] {
        let arguments = [&["replay", "--leg", "embree"], options].concat();
        let ran = place.run(&arguments).expect(0);
        let all = format!("{}{}", ran.stdout, ran.stderr);
        assert_eq!(all.matches(told).count(), said.iter().len(), "{all}");
        assert!(
            said.is_none_or(|said| all.contains(&format!("{told}{said}\n"))),
            "{all}"
        );
        assert!(all.contains("no ray is asked for"), "{all}");
    }
}

/// Two quads that block rays, as a newcomer writes it: without a budget.
const GRID: &str = r#"
purpose = "two quads across the way of rays"
size = [8, 8]
[[mesh]]
generate.stack = { layers = 2, size = [4, 4], spacing = 1 }
[grid]
resolution = [4, 4, 2]
rays = { random = 50, aimed = 50, edge = 50, vertex = 50, grazing = 50, cell = 50 }
"#;
