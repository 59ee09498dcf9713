//! Scenes outside the corpus: meshes and scene files of the user's own.

use std::collections::BTreeSet;

use super::{Place, SCENE};
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
