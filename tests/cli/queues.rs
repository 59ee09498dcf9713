//! Work queues as a user meets them: `bench dispatch`, `bench share`, and scenes that are refused.

use std::fs;

use super::Place;

/// Two mirrors and a lamp.
const MIRRORS: &str = r#"
purpose = "two mirrors"
size = [16, 16]
background = [0.1, 0.2, 0.3]

[camera]
eye = [0, 0.4, 2]
target = [0, 0, 0]
fov = 60
near = 0.1
far = 10

[[material]]
name = "mirror"
colour = [0.5, 0.4, 0.3]
opacity = 1
mirror = [0.9, 0.8, 0.7]

[[mesh]]
generate.box = { size = [1, 1, 0.1] }
instances = [{}, { translate = [0, 0, 3] }]
material = "mirror"

[dispatch]
depth = 5
[[dispatch.lamp]]
position = [0.5, 1, 1]
strength = [1, 1, 1]
"#;

/// Every queue with one thread and with three, the wavefront of an adapter, tables and figures.
#[test]
fn queues_are_measured() {
    let place = Place::new("bench-dispatch");
    place.write("own/mirrors.toml", MIRRORS);
    let command = [
        "bench",
        "dispatch",
        "own/mirrors.toml",
        "--frames",
        "2",
        "--runs",
        "1",
    ];
    let more = [
        "--threads",
        "1",
        "--threads",
        "3",
        "--side",
        "12",
        "--out",
        "t",
    ];
    let adapter = ["--adapter", "swiftshader"];
    let ran = place
        .run(&[&command[..], &more, &adapter].concat())
        .expect(0);
    let names = [
        "LOCK",
        "LFREE",
        "LOCAL",
        "stealing",
        "rayon",
        "Embree LOCAL",
        "gpu@SwiftShader",
    ];
    for name in names {
        assert!(ran.stdout.contains(name), "{name}: {}", ran.stdout);
    }
    let read = |end: &str| {
        let files = fs::read_dir(place.root.join("t")).expect("a folder");
        let paths = files.map(|f| f.expect("a file").path());
        let found: Vec<_> = paths
            .filter(|p| p.to_string_lossy().ends_with(end))
            .collect();
        assert_eq!(found.len(), 1, "{end}: {found:?}");
        fs::read_to_string(&found[0]).expect("text")
    };
    let csv = read(".csv");
    // The sequential version, ten methods with two numbers of threads, and an adapter.
    assert_eq!(csv.lines().count(), 1 + 1 + 10 * 2 + 1, "{csv}");
    let (page, speed) = (read(".md"), read("-speed.svg"));
    assert!(page.contains("N27: LOCAL suffers"), "{page}");
    assert!(speed.contains("</svg>"), "{speed}");
    read("-idle.svg");
    read("-access.svg");
}

#[test]
fn pictures_are_held_against_the_specs() {
    let place = Place::new("bench-identical");
    place.write("own/mirrors.toml", MIRRORS);
    let command = ["bench", "dispatch", "--identical=2", "own/mirrors.toml"];
    let ran = place.run(&command).expect(0);
    // Five queues with five numbers of threads and two endings, and rayon with one.
    assert!(
        ran.stdout.contains("110 pictures, 0 unlike"),
        "{}",
        ran.stdout
    );
}

#[test]
fn the_specs_share_is_measured() {
    let place = Place::new("bench-share");
    place.write("own/mirrors.toml", MIRRORS);
    let command = [
        "bench",
        "share",
        "own/mirrors.toml",
        "--threads",
        "2",
        "--runs",
        "1",
    ];
    let ran = place.run(&command).expect(0);
    assert!(ran.stdout.contains("   2 threads: "), "{}", ran.stdout);
    assert!(ran.stdout.contains("mirrors"), "{}", ran.stdout);
}

/// By name, with the line to change.
#[test]
fn what_cannot_be_traced_is_refused() {
    let place = Place::new("dispatch-mistakes");
    let lamp = "[[dispatch.lamp]]\nposition = [0.5, 1, 1]\nstrength = [1, 1, 1]\n";
    let section = format!("[dispatch]\ndepth = 5\n{lamp}");
    let cases = [
        ("depth = 5", "depth = 65", ":25: 65 is outside 0 to 64"),
        (
            "mirror = [0.9",
            "mirror = [1.9",
            ":17: 1.9 is outside 0 to 1",
        ),
        (
            "size = [16, 16]",
            "size = [1400, 1400]",
            ":3: size: pixels, lamps and mirrors may ask for 23520000 rays, and 8388608 are the limit",
        ),
        (
            "strength = [1",
            "strength = [9e5",
            ":26: dispatch.lamp: its light may reach 2.304e8",
        ),
        (
            "[dispatch]",
            "[grid]\n[dispatch]",
            ":25: [grid] has no effect on a scene with [dispatch]",
        ),
        (
            &section,
            "",
            ":14: `mirror` of a material is for scenes with [dispatch]",
        ),
    ];
    for (number, (from, to, told)) in cases.into_iter().enumerate() {
        assert!(MIRRORS.contains(from), "{from}");
        let name = format!("own/{number}.toml");
        place.write(&name, &MIRRORS.replace(from, to));
        let ran = place.run(&["replay", "--leg", "spec", &name]).expect(2);
        assert!(ran.stderr.contains(told), "{number}: {}", ran.stderr);
        assert_eq!(ran.stderr.trim().lines().count(), 1, "{}", ran.stderr);
    }
}

/// A stage that a scene leaves nothing to do has nothing to be compared, and says so.
#[test]
fn scenes_with_nothing_for_a_stage_agree() {
    let place = Place::new("dispatch-idle");
    let cases = [
        (
            "nothing in sight",
            "target = [0, 0, 0]",
            "target = [0, 0.4, 9]",
        ),
        (
            "lamps behind all that is seen",
            "position = [0.5, 1, 1]",
            "position = [0, 0, -9]",
        ),
        ("nothing that mirrors", "mirror = [0.9, 0.8, 0.7]\n", ""),
    ];
    for (number, (what, from, to)) in cases.into_iter().enumerate() {
        assert!(MIRRORS.contains(from), "{from}");
        let name = format!("own/{number}.toml");
        let scene = MIRRORS
            .replace(from, to)
            .replace(", { translate = [0, 0, 3] }", "");
        place.write(&name, &scene);
        let command = [
            "replay",
            "--no-skip",
            "--leg",
            "spec",
            "--leg",
            "gpu",
            &name,
        ];
        let ran = place.run(&command).expect(0);
        let said = "the spec has no such ray, and neither has the leg";
        assert!(ran.stdout.contains(said), "{what}: {}", ran.stdout);
    }
}
