//! Verdicts, and the files that a replay writes.

use std::fs;
use std::path::Path;

use serde_json::Value;
use triptych_harness::registry;

use super::{Place, SCENE, repository};

/// The fields of a row and of the summary that are part of the interface.
const ROW: [&str; 18] = [
    "scene",
    "family",
    "stage",
    "a",
    "b",
    "class",
    "compared",
    "differ",
    "causes",
    "unexplained",
    "skipped",
    "cached",
    "ms_a",
    "ms_b",
    "unit",
    "admitted",
    "note",
    "again",
];
const SUMMARY: [&str; 5] = ["scenes", "compared", "unexplained", "skipped", "seconds"];

pub fn json(path: &Path) -> Vec<Value> {
    let text = fs::read_to_string(path).expect("the file was written");
    assert!(text.ends_with('\n'), "the last line is whole");
    let line = |l: &str| serde_json::from_str(l).unwrap_or_else(|e| panic!("{e}: {l}"));
    text.lines().map(line).collect()
}

pub fn count(value: &Value, field: &str) -> u64 {
    value[field]
        .as_u64()
        .unwrap_or_else(|| panic!("{field} of {value} is no count"))
}

/// All legs agree; the JSON lines say the same as the table.
#[test]
fn json_has_every_comparison_and_the_summary_last() {
    let place = Place::new("json");
    place.write("corpus/raster/quads/scene.toml", SCENE);
    let ran = place
        .run(&["replay", "--no-cache", "--json", "sub/out.json"])
        .expect(0);
    assert_eq!(ran.stderr, "");
    let mut lines = json(&place.root.join("sub/out.json"));
    let summary = lines.pop().expect("there is a summary");
    assert_eq!(summary["type"], "summary");
    for field in SUMMARY {
        assert!(
            summary.get(field).is_some_and(Value::is_number),
            "{field} of {summary}"
        );
    }
    for row in &lines {
        assert_eq!(row["type"], "row");
        for field in ROW {
            assert!(row.get(field).is_some(), "{row} lacks {field}");
        }
        let stage = row["stage"].as_str().expect("a stage is named");
        assert!(registry::names_row(stage), "{stage} is not in the registry");
        assert_ne!(row["a"], row["b"], "a leg is compared with itself");
        let compared = count(row, "compared") > 0;
        assert_ne!(
            compared,
            row["skipped"].is_string(),
            "compared or skipped: {row}"
        );
    }
    let sum = |field| lines.iter().map(|row| count(row, field)).sum::<u64>();
    assert_eq!(count(&summary, "compared"), sum("compared"));
    assert_eq!(count(&summary, "unexplained"), 0);
    assert_eq!(count(&summary, "scenes"), 1);
    let others: Vec<&str> = lines.iter().filter_map(|row| row["b"].as_str()).collect();
    for leg in ["closed form", "embree"] {
        assert!(others.contains(&leg), "{others:?} lacks {leg}");
    }
    // Where there are adapters, they took part.
    assert!(
        others.iter().any(|leg| leg.starts_with("gpu")),
        "{others:?} lacks a GPU"
    );
}

#[test]
fn what_diverges_is_exit_code_1() {
    let place = Place::new("diverge");
    let wrong = SCENE.replace("fragments = 32", "fragments = 33");
    place.write("corpus/raster/wrong/scene.toml", &wrong);
    let arguments = [
        "replay",
        "--no-cache",
        "--leg",
        "spec",
        "--json",
        "out.json",
    ];
    let ran = place.run(&arguments).expect(1);
    for part in ["raster/wrong", "33", "32"] {
        assert!(ran.stdout.contains(part), "{} lacks {part}", ran.stdout);
    }
    let lines = json(&place.root.join("out.json"));
    assert_eq!(count(&lines[0], "unexplained"), 1);
    assert_eq!(count(lines.last().expect("a summary"), "unexplained"), 1);
}

/// One leg alone, one scene by its whole name.
#[test]
fn legs_and_scenes_are_selected() {
    let place = Place::new("select");
    for name in ["quad", "quads"] {
        place.write(&format!("corpus/raster/{name}/scene.toml"), SCENE);
    }
    for (leg, b) in [("spec", "closed form"), ("embree", "embree")] {
        let arguments = [
            "replay",
            "--no-cache",
            "--exact",
            "raster/quad",
            "--leg",
            leg,
            "--json",
            "o",
        ];
        place.run(&arguments).expect(0);
        let mut lines = json(&place.root.join("o"));
        lines.pop();
        assert!(
            lines.iter().all(|row| row["scene"] == "raster/quad"),
            "{lines:?}"
        );
        assert!(lines.iter().any(|row| row["b"] == b), "{lines:?} lack {b}");
        let gpu = |row: &Value| row["b"].as_str().is_some_and(|b| b.starts_with("gpu"));
        assert!(!lines.iter().any(gpu), "{lines:?} have a GPU");
    }
}

/// A second run takes agreeing results from the cache, and says so.
#[test]
fn cached_results_say_so() {
    let place = Place::new("cache");
    place.write("corpus/raster/quads/scene.toml", SCENE);
    for cached in [false, true] {
        place
            .run(&["replay", "--leg", "embree", "--json", "out.json"])
            .expect(0);
        let mut lines = json(&place.root.join("out.json"));
        lines.pop();
        assert!(
            lines.iter().all(|row| row["cached"] == cached),
            "{cached}: {lines:?}"
        );
    }
}

/// A report is there to be shared: it says which Embree, and not where it lies.
#[test]
fn the_report_tells_no_place_of_this_machine() {
    let place = Place::new("places");
    place.write("corpus/raster/quads/scene.toml", SCENE);
    place.run(&["replay", "--leg", "embree"]).expect(0);
    let page = place.root.join("reports/out/index.html");
    let page = fs::read_to_string(page).expect("a report");
    assert!(page.contains("(libembree4"), "the library's file");
    let native = repository().join(".native");
    for folder in [native.as_path(), &place.root, Path::new("/usr/lib")] {
        let folder = folder.display().to_string();
        assert!(!page.contains(&folder), "{folder} is in the report");
    }
    assert!(!page.contains("/libembree4"), "a folder of Embree's");
}

/// Shape and bytes of a NumPy array.
pub(super) fn npy(path: &Path) -> (String, Vec<u8>) {
    let bytes = fs::read(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    assert_eq!(&bytes[..8], b"\x93NUMPY\x01\0", "{}", path.display());
    let end = 10 + usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
    let header = String::from_utf8_lossy(&bytes[10..end]).into_owned();
    (header, bytes[end..].to_vec())
}

/// The documented files, of the documented types and shapes.
#[test]
fn dump_writes_what_it_documents() {
    let place = Place::new("dump");
    place.write("corpus/raster/quads/scene.toml", SCENE);
    place
        .run(&["replay", "--leg", "spec", "--dump", "out"])
        .expect(0);
    let leg = place.root.join("out/raster/quads/spec");
    let meta: Value = serde_json::from_str(
        &fs::read_to_string(leg.join("meta.json")).expect("there is a meta.json"),
    )
    .expect("it is JSON");
    for (field, value) in [("width", 8), ("height", 8), ("subpixel_bits", 8)] {
        assert_eq!(count(&meta, field), value, "{field}");
    }
    for (array, kind, shape, bytes) in [
        ("vertex/snapped", "<i4", &[12, 3][..], 144),
        ("vertex/prims", "<u4", &[4, 3][..], 48),
        ("vertex/source", "<u4", &[4, 2][..], 32),
        ("abuffer/offsets", "<u4", &[65][..], 260),
        ("abuffer/depth", "<u4", &[32][..], 128),
        ("abuffer/prim", "<u4", &[32][..], 128),
        ("abuffer/mask", "<u4", &[32][..], 128),
        ("abuffer/rgba", "<f4", &[32, 4][..], 512),
        ("resolve/image", "<f4", &[8, 8, 3][..], 768),
    ] {
        let (header, data) = npy(&leg.join(array).with_extension("npy"));
        assert!(header.contains(kind), "{array}: {header} lacks {kind}");
        let (_, tuple) = header.split_once("'shape': (").expect("a shape");
        let numbers = tuple.split(')').next().expect("a tuple").split(',');
        let found: Vec<usize> = numbers.filter_map(|n| n.trim().parse().ok()).collect();
        assert_eq!(found, shape, "{array}");
        assert_eq!(data.len(), bytes, "{array}");
    }
    for picture in ["exr", "png"] {
        let path = leg.join("resolve/image").with_extension(picture);
        assert!(path.is_file(), "{} is missing", path.display());
    }
    let (_, offsets) = npy(&leg.join("abuffer/offsets.npy"));
    assert_eq!(
        offsets[256..],
        32_u32.to_le_bytes(),
        "the lists hold all fragments"
    );
}
