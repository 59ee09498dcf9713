//! A scene of indirect light: the arrays that it leaves behind, and how long its frames take.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use super::Place;
use super::results::npy;

/// On one adapter and path.
const ON: [&str; 4] = ["--adapter", "swiftshader", "--path", "compute"];

/// What decides is the same for spec and adapter, what is reported is near; so in each of two
/// frames, between which the blocker moves.
#[test]
fn frames_are_dumped_by_every_leg() {
    let place = Place::new("dump-rsm");
    place.write("corpus/rsm/wall/scene.toml", WALL);
    place
        .run(&[&["replay"], &ON[..], &["--dump", "out"]].concat())
        .expect(0);
    let legs = ["spec", "gpu@SwiftShader-compute"];
    let of = |leg: &str, array: &str| {
        let file = format!("out/rsm/wall/{leg}/rsm{array}.npy");
        npy(&place.root.join(file))
    };
    for frame in ["-1/", "-2/"] {
        for (array, shape) in [
            ("triangles", "(16, 3, 3, )"),
            ("seen_prim", "(16, 24, )"),
            ("map_prim", "(5, 6, )"),
            ("lit", "(16, 24, )"),
            ("bits", "(8, 12, 2, )"),
        ] {
            let [spec, gpu] = legs.map(|leg| of(leg, &format!("{frame}{array}")));
            assert!(spec.0.contains(shape), "{array}: {}", spec.0);
            assert_eq!(spec, gpu, "{frame}{array}");
            assert!(spec.1.iter().any(|byte| *byte != 0), "{frame}{array}");
        }
        // Points may stray by a step, places by a key.
        for (array, shape, size) in [
            ("seen_point", "(16, 24, 4, )", 16 * 24 * 16),
            ("map_point", "(5, 6, 4, )", 5 * 6 * 16),
            ("place", "(16, 24, 2, )", 16 * 24 * 8),
            ("key", "(16, 24, )", 16 * 24 * 4),
        ] {
            for leg in legs {
                let (header, bytes) = of(leg, &format!("{frame}{array}"));
                assert!(header.contains(shape), "{array}: {header}");
                assert_eq!(bytes.len(), size, "{array}");
            }
        }
        for (array, pixels) in [
            ("intensity", 5 * 6),
            ("direct", 16 * 24),
            ("all", 16 * 24),
            ("blocked", 8 * 12),
            ("blurred", 8 * 12),
            ("image", 16 * 24),
        ] {
            let [spec, gpu] = legs.map(|leg| floats(&of(leg, &format!("{frame}{array}")).1));
            assert_eq!(spec.len(), 3 * pixels, "{array}");
            let most = spec.iter().copied().fold(0.0, f32::max);
            assert!(most > 0.0, "{frame}{array} is not dark");
            let near = |(a, b): (&f32, &f32)| (a - b).abs() <= 0.01 * most;
            assert!(spec.iter().zip(&gpu).all(near), "{frame}{array}");
        }
        for leg in legs {
            for end in ["exr", "png"] {
                let image = format!("out/rsm/wall/{leg}/rsm{frame}image.{end}");
                assert!(place.root.join(&image).is_file(), "{image}");
            }
        }
    }
    let [first, second] = ["-1/bits", "-2/bits"].map(|array| of("spec", array).1);
    assert_ne!(first, second, "the blocker moved");
    assert_eq!(of(legs[0], "/lattice"), of(legs[1], "/lattice"));
}

fn floats(bytes: &[u8]) -> Vec<f32> {
    let word = |word: &[u8]| f32::from_le_bytes(word.try_into().expect("four bytes"));
    bytes.chunks_exact(4).map(word).collect()
}

/// A scene that somebody names is measured with its own and other settings, by the spec and on
/// adapters, each against the same reference.
#[test]
fn frames_are_measured() {
    let place = Place::new("bench-rsm");
    // Its own setting is that of the reference.
    let fine = WALL.replace("[rsm]\n", "[rsm]\ndivisor = 1\nblur = 0\n");
    place.write("own/wall.toml", &fine);
    let command = ["bench", "rsm", "own/wall.toml", "--runs", "2", "--out", "t"];
    let ran = place
        .run(&[&command[..], &["--adapter", "swiftshader"]].concat())
        .expect(0);
    assert!(ran.stdout.contains("Results: t"), "{}", ran.stdout);
    let csv = only(&place.root.join("t"), "csv");
    let rows = rows(&csv);
    for leg in ["spec", "gpu@SwiftShader"] {
        let own = rows.iter().filter(|row| row["leg"] == leg);
        let frames: Vec<_> = own.filter(|row| row["part"] == "frame").collect();
        let setting = |row: &&BTreeMap<&str, &str>| {
            ["kernel", "stride", "divisor", "blur"].map(|c| row[c].parse::<u32>().expect("whole"))
        };
        let settings: Vec<[u32; 4]> = frames.iter().map(setting).collect();
        assert!(settings.contains(&[7, 1, 1, 0]), "its own: {settings:?}");
        assert!(settings.iter().any(|s| s[1] == 2), "coarser: {settings:?}");
        for row in &frames {
            let number = |column: &str| row[column].parse::<f64>().expect("a number");
            assert!(number("time_ms") > 0.0, "{row:?}");
            assert!(number("time_ms_min") <= number("time_ms"), "{row:?}");
            assert!(number("rmse") <= number("largest"), "{row:?}");
        }
        // Every pixel's own rays and no blur are the reference, but for rounding.
        let fine = frames.iter().find(|row| setting(row) == [7, 1, 1, 0]);
        let rmse = fine.expect("above")["rmse"].parse::<f64>();
        assert!(rmse.expect("a number") < 1e-6, "{fine:?}");
    }
    let parts = rows.iter().filter(|row| row["leg"] != "spec");
    let parts: Vec<&str> = parts.take(8).map(|row| row["part"]).collect();
    let all = [
        "frame", "eye", "map", "cells", "direct", "A", "B", "compose",
    ];
    assert_eq!(parts, all);
    for row in rows.iter().filter(|row| row["part"] == "frame") {
        let of_adapter = row["leg"] != "spec";
        let number = |column: &str| row[column].parse::<f64>().ok();
        // 384 pixels have points of 16 bytes at least.
        let memory = number("memory_bytes").map(|bytes| bytes > 16.0 * 384.0);
        assert_eq!(memory, of_adapter.then_some(true), "{row:?}");
        let elsewhere = number("largest_elsewhere");
        assert_eq!(elsewhere.is_some(), of_adapter, "{row:?}");
        assert!(elsewhere <= number("largest"), "{row:?}");
    }
    let page = only(&place.root.join("t"), "md");
    for words in ["# Indirect light", "| 7x7 | 1/1 | 0 |", "*RMSE*", ".svg)"] {
        assert!(page.contains(words), "no {words} in {page}");
    }
    let front = only(&place.root.join("t"), "svg");
    for words in ["gpu@SwiftShader: buffer B", ">own<"] {
        assert!(front.contains(words), "no {words} in {front}");
    }
}

/// What has no frames is named, and what cannot be measured is said before anything runs.
#[test]
fn what_is_not_measured_is_said() {
    let place = Place::new("bench-rsm-not");
    place.write("own/bare.toml", BARE);
    let command = ["bench", "rsm", "own/bare.toml", "--adapter", "swiftshader"];
    let ran = place.run(&command).expect(2);
    for words in [
        "not measured: ",
        "bare",
        "has no [rsm]",
        "nothing was measured",
    ] {
        let said = format!("{}{}", ran.stdout, ran.stderr);
        assert!(said.contains(words), "no {words} in {said}");
    }
    let ran = place.run(&["bench", "rsm", "--runs", "0"]).expect(2);
    assert!(ran.stderr.contains("--runs"), "{}", ran.stderr);
}

/// The one file with this end.
pub(super) fn only(folder: &Path, end: &str) -> String {
    let files = fs::read_dir(folder).expect("a folder");
    let files = files.map(|file| file.expect("a file").path());
    let own: Vec<_> = files
        .filter(|path| path.extension().is_some_and(|e| e == end))
        .collect();
    let [file] = &own[..] else {
        panic!("one {end}: {own:?}");
    };
    fs::read_to_string(file).expect("text")
}

pub(super) fn rows(csv: &str) -> Vec<BTreeMap<&str, &str>> {
    let mut lines = csv.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let header = lines.next().expect("a header");
    let row = |line: Vec<_>| {
        assert_eq!(line.len(), header.len(), "{line:?}");
        header.iter().copied().zip(line).collect()
    };
    lines.map(row).collect()
}

/// A lamp on a wall, a floor that the wall lights, and a box before it that moves.
pub(super) const WALL: &str = r#"
purpose = "a wall lights a floor past a box that moves"
size = [24, 16]
[camera]
eye = [2.4, 2.6, 4.6]
target = [-0.2, 0.55, 0]
fov = 36
near = 0.5
far = 20
[[mesh]]
generate.faces = { vertices = [[-1.5, 0, -2], [-1.5, 0, 2], [-1.5, 2.4, 2], [-1.5, 2.4, -2]], faces = [[0, 1, 2, 3]] }
[[mesh]]
generate.faces = { vertices = [[-1.5, 0, -2], [2, 0, -2], [2, 0, 2], [-1.5, 0, 2]], faces = [[0, 1, 2, 3]] }
[[mesh]]
generate.box = { size = [0.8, 0.8, 0.8] }
translate = [-0.6, 0.5, 0]
moves = { translate = [0, 0, 0.3] }
blocks = true
[rsm]
frames = 2
map = [6, 5]
radius = 3
stride = 1
strength = [6, 6, 6]
[rsm.lamp]
eye = [3, 2.2, 0]
target = [-1.5, 1.5, 0]
height = 1.5
near = 0.5
far = 10
"#;

/// A scene without light.
const BARE: &str = r#"
purpose = "two quads"
size = [8, 8]
[[mesh]]
generate.stack = { layers = 2, size = [4, 4], spacing = 1 }
"#;

/// What only a device's own run has, its cells among it, is judged there.
#[test]
fn what_is_wrong_in_a_legs_own_run_diverges() {
    let place = Place::new("rsm-own");
    place.write("own/wall.toml", WALL);
    let idle = "@compute @workgroup_size(64) fn";
    let kernels = format!("{idle} count() {{}}\n{idle} count_chunks() {{}}\n");
    place.write("count.wgsl", &kernels);
    let command = ["replay", "own/wall.toml", "--leg", "gpu"];
    place.run(&[&command[..], &ON[..]].concat()).expect(0);
    let kernel = ["--kernel", "count=count.wgsl"];
    let ran = place.run(&[&command[..], &ON[..], &kernel[..]].concat());
    let stdout = ran.expect(1).stdout;
    assert!(
        stdout.contains(", end to end: 27 of 28 offsets differ; corrupt-link 27"),
        "{stdout}"
    );
}

/// A lamp so bright that `f32` may not hold it is nothing to agree on.
#[test]
fn light_beyond_f32_is_no_agreement() {
    let place = Place::new("rsm-bright");
    let told = "strength = [1e6, 1e6, 1e6]\nreference = 1e12";
    let bright = WALL.replace("strength = [6, 6, 6]", told);
    // A spot light, which alone has a reference distance.
    let bright = bright.replace("height = 1.5", "fov = 30");
    place.write("own/bright.toml", &bright);
    let command = ["replay", "own/bright.toml", "--leg", "gpu"];
    let ran = place.run(&[&command[..], &ON[..]].concat()).expect(1);
    let said = ran.stdout;
    assert!(said.contains("intensities may be beyond f32"), "{said}");
    assert!(said.contains("no finite number"), "{said}");
}
