//! How fast grids are built and rays go through them: what is measured, and of what.

use std::collections::BTreeMap;

use super::Place;
use super::frames::{WALL, only, rows};

/// 160 triangles that lie on each other: where an axis has one cell, all are in each list, which
/// takes an odd number of passes to be put in order, and the last leaves them elsewhere. Rays are
/// then searched in those, which are compared with the spec's.
#[test]
fn grids_are_measured() {
    let place = Place::new("bench-grid");
    place.write("own/stack.toml", STACK);
    let command = ["bench", "grid", "own/stack.toml", "--rays", "2048"];
    let files = ["--runs", "1", "--out", "t", "--adapter", "swiftshader"];
    let ran = place.run(&[&command[..], &files].concat()).expect(0);
    assert!(
        !ran.stdout.contains("gpu@SwiftShader: own"),
        "{}",
        ran.stdout
    );
    let csv = only(&place.root.join("t"), "csv");
    let own = of_adapter(&csv);
    let own = rows(&own);
    assert_eq!(own.len(), 3 * 7, "grids, builds and rays: {csv}");
    for row in &own {
        let number = |column: &str| row[column].parse::<f64>().expect("a number");
        let build = row["what"] == "build";
        assert_eq!(
            number("items"),
            if build { 160.0 } else { 2048.0 },
            "{row:?}"
        );
        assert!(number("time_ms") > 0.0, "{row:?}");
        assert!(number("memory_bytes") > 160.0 * 48.0, "{row:?}");
        assert!(number("fraction_of_bound") > 0.0, "{row:?}");
        let unlike = if build { ["", ""] } else { ["0", "2048"] };
        assert_eq!(["unlike", "unlike_of"].map(|column| row[column]), unlike);
    }
    for leg in ["spec", "\"embree, one thread\"", "\"obvhs, one thread\""] {
        let of_leg = csv.lines().filter(|line| line.contains(",build,160,"));
        let of_leg = of_leg.filter(|line| line.contains(&format!("160,{leg},")));
        assert_eq!(of_leg.count(), 3, "{leg}: {csv}");
    }
    let page = only(&place.root.join("t"), "md");
    for words in [
        "# Grids and rays",
        "| memory | of bound | unlike the spec |",
        "0 of 2,048",
    ] {
        assert!(page.contains(words), "no {words} in {page}");
    }
    assert!(!page.contains("| demand |"), "nothing is demanded: {page}");
}

/// In a scene of indirect light only some triangles block it.
#[test]
fn only_blockers_block_rays() {
    let place = Place::new("bench-grid-rsm");
    place.write("own/wall.toml", WALL);
    let command = ["bench", "grid", "own/wall.toml", "--rays", "256"];
    let files = ["--runs", "1", "--out", "t", "--adapter", "swiftshader"];
    place.run(&[&command[..], &files].concat()).expect(0);
    let csv = only(&place.root.join("t"), "csv");
    let own = of_adapter(&csv);
    let rows = rows(&own);
    let builds: Vec<&BTreeMap<_, _>> = rows.iter().filter(|row| row["what"] == "build").collect();
    assert!(!builds.is_empty(), "{csv}");
    for row in builds {
        assert_eq!(row["items"], "12", "of the box: {csv}");
    }
}

/// The heading and the rows of an adapter, whose cells have no commas.
fn of_adapter(csv: &str) -> String {
    let lines = csv.lines().enumerate();
    let lines = lines.filter(|(at, line)| *at == 0 || line.contains("gpu@"));
    let lines: Vec<&str> = lines.map(|(_, line)| line).collect();
    lines.join("\n")
}

const STACK: &str = r#"
purpose = "80 quads, each a little above the other"
size = [8, 8]
[[mesh]]
generate.stack = { layers = 80, size = [4, 4], spacing = 0.002 }
[grid]
"#;
