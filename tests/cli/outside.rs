//! Scenes outside the corpus: meshes and scene files of the user's own.

use std::collections::BTreeSet;
use std::process::Command;

use super::{Place, Ran, SCENE};
use crate::results::{count, json};

/// A triangle, and one of half the height.
const SHAPES: [(&str, &str); 2] = [
    ("a/shape.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0.5\nf 1 2 3\n"),
    ("b/shape.obj", "v 0 0 0\nv 1 0 0\nv 0 0.5 0.5\nf 1 2 3\n"),
];

/// Two meshes of one stem are two scenes, in the table, the JSON lines, the dump and
/// the report; a mesh given twice is one.
#[test]
fn equal_stems_are_different_scenes() {
    let place = Place::new("stems");
    place.write("corpus/raster/shape.obj/scene.toml", SCENE);
    for (name, text) in SHAPES {
        place.write(name, text);
    }
    let arguments = [
        "replay",
        "--leg",
        "embree",
        "--json",
        "out.json",
        "--dump",
        "dump",
        "a/shape.obj",
        "b/shape.obj",
        "b/../a/shape.obj",
        "raster/",
    ];
    let ran = place.run(&arguments).expect(0);
    let names = ["a/shape.obj", "b/shape.obj", "raster/shape.obj"];
    let mut lines = json(&place.root.join("out.json"));
    let summary = lines.pop().expect("a summary");
    assert_eq!(count(&summary, "scenes"), 3, "{summary}");
    let key = |field: &str, row: &serde_json::Value| row[field].to_string();
    let mut keys = BTreeSet::new();
    for row in &lines {
        let new = keys.insert(["scene", "stage", "a", "b"].map(|field| key(field, row)));
        assert!(new, "two rows of one key: {row}");
    }
    let report = place.root.join("reports/out/index.html");
    let report = std::fs::read_to_string(report).expect("a report");
    for name in names {
        assert!(ran.stdout.contains(name), "{} lacks {name}", ran.stdout);
        let quoted = format!("\"{name}\"");
        let rows = lines.iter().filter(|row| key("scene", row) == quoted);
        assert!(rows.count() > 0, "no row of {name}");
        let meta = place.root.join("dump").join(name).join("spec/meta.json");
        assert!(meta.is_file(), "no {}", meta.display());
        let section = format!("data-name=\"{name}\"");
        assert_eq!(report.matches(&section).count(), 2, "index and section");
    }
    let dumped = |name: &str| {
        let array = "spec/vertex/snapped.npy";
        std::fs::read(place.root.join("dump").join(name).join(array)).expect("it is there")
    };
    assert_ne!(dumped(names[0]), dumped(names[1]), "each has its own mesh");
}

/// The command that terminal, JSON lines and reports give runs the same scene, with
/// the same options, and comes to the same.
#[test]
fn the_command_that_replays_a_scene_can_be_run() {
    let place = Place::new("again");
    let wrong = SCENE.replace("fragments = 32", "fragments = 33");
    place.write("my scenes/odd/scene.toml", &wrong);
    let options =
        "--leg embree --adapter nonsuch --path compute --seed 7 --gpu-from sort --no-skip";
    let mut arguments = vec!["replay", "--json", "out.json", "my scenes/odd"];
    arguments.extend(options.split(' '));
    let first = place.run(&arguments).expect(1);
    let file = "'my scenes/odd/scene.toml'";
    let command = format!("cargo triptych replay --exact --no-cache {options} {file}");
    let hint = "cargo triptych replay --exact --seed 7 --gpu-from sort --no-skip";
    let hint = format!("again: {hint} {file}\n");
    assert!(
        first.stdout.contains(&hint),
        "{} lacks {hint}",
        first.stdout
    );
    let lines = json(&place.root.join("out.json"));
    assert_eq!(lines[0]["again"], command.as_str());
    place
        .run(&["report", "out.json", "--output", "merged.html"])
        .expect(1);
    for page in ["reports/out/index.html", "merged.html"] {
        let text = std::fs::read_to_string(place.root.join(page)).expect("a report");
        let shown = format!("<code>{command}</code>");
        assert_eq!(text.matches(&shown).count(), 1, "{page} lacks {command}");
    }
    // Run as it stands, by a shell.
    let line = command.replace("cargo triptych", "\"$TRIPTYCH\"");
    let mut shell = Command::new("sh");
    shell
        .args(["-c", &line])
        .current_dir(&place.root)
        .env("TRIPTYCH", place.command(&[]).get_program())
        .env("TRIPTYCH_CORPUS", place.root.join("corpus"));
    let second = Ran::of(&mut shell).expect(1);
    assert!(
        second.stdout.contains(&hint),
        "{} lacks {hint}",
        second.stdout
    );
}
