//! How fast grids are built and rays go through them: what is measured, and of what.

use std::collections::BTreeMap;
use std::fs;

use super::Place;
use super::frames::{WALL, only, rows};

/// 600 triangles that lie on each other: where an axis has one cell, all are in each list, which
/// takes an odd number of passes to be put in order, and the last leaves them elsewhere. Rays are
/// then searched in those, which are compared with the spec's.
#[test]
fn grids_are_measured() {
    let place = Place::new("bench-grid");
    place.write("own/stack.toml", STACK);
    let command = ["bench", "grid", "own/stack.toml", "--rays", "512"];
    let files = ["--runs", "1", "--out", "t", "--adapter", "llvmpipe"];
    let ran = place.run(&[&command[..], &files].concat()).expect(0);
    assert!(!ran.stdout.contains("gpu@llvmpipe: own"), "{}", ran.stdout);
    let csv = only(&place.root.join("t"), "csv");
    let own = of_adapter(&csv);
    let own = rows(&own);
    assert_eq!(own.len(), 3 * 7, "grids, builds and rays: {csv}");
    for row in &own {
        let number = |column: &str| row[column].parse::<f64>().expect("a number");
        let build = row["what"] == "build";
        assert_eq!(
            number("items"),
            if build { 600.0 } else { 512.0 },
            "{row:?}"
        );
        assert!(number("time_ms") > 0.0, "{row:?}");
        assert!(number("memory_bytes") > 600.0 * 48.0, "{row:?}");
        assert!(number("fraction_of_bound") > 0.0, "{row:?}");
        let unlike = if build { ["", ""] } else { ["0", "512"] };
        assert_eq!(["unlike", "unlike_of"].map(|column| row[column]), unlike);
    }
    for leg in ["spec", "\"embree, one thread\"", "\"obvhs, one thread\""] {
        let of_leg = csv.lines().filter(|line| line.contains(",build,600,"));
        let of_leg = of_leg.filter(|line| line.contains(&format!("600,{leg},")));
        assert_eq!(of_leg.count(), 3, "{leg}: {csv}");
    }
    let page = only(&place.root.join("t"), "md");
    for words in [
        "# Grids and rays",
        "| memory | of bound | unlike the spec |",
        "0 of 512",
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

/// Maps over directions and resolutions; finer ones are nearer to rays in the same directions.
#[test]
fn maps_are_measured() {
    let place = Place::new("bench-ldm");
    place.write("own/room.toml", ROOM);
    let command = ["bench", "ldm", "own/room.toml", "--cuts", "1"];
    let files = ["--runs", "1", "--out", "t", "--adapter", "llvmpipe"];
    place.run(&[&command[..], &files].concat()).expect(0);
    let csv = only(&place.root.join("t"), "csv").replace("\"room, each triangle as 4\"", "cut");
    let csv = csv.replace("\"gpu@llvmpipe, native\"", "gpu@llvmpipe");
    let rows = rows(&csv);
    let parts = ["frame", "build", "count", "scan", "fill", "sort", "ask"];
    let (runs, chains): (Vec<_>, Vec<_>) = rows.iter().partition(|row| row["layout"] == "runs");
    assert_eq!(runs.len(), 2 * 12 * parts.len(), "{csv}");
    let number = |row: &BTreeMap<&str, &str>, column: &str| row[column].parse::<f64>();
    are_of_chains(&chains);
    let frames = rows.iter().filter(|row| row["part"] == "frame");
    let error = |scene: &str, resolution: &str| {
        let mut own = frames.clone();
        let own = own.find(|row| {
            row["scene"].contains(scene)
                && row["directions"] == "8"
                && row["resolution"] == resolution
        });
        number(own.expect("it is measured"), "rmse_same").expect("a number")
    };
    let looks = |directions: &str| {
        let own = rows.iter().find(|row| row["directions"] == directions);
        number(own.expect("it is measured"), "flip").expect("a number")
    };
    let [few, many] = ["16", "1024"].map(looks);
    assert!(
        0.0 < many && many < few && few < 0.5,
        "{few} and {many}: {csv}"
    );
    let png = fs::read_dir(place.root.join("t")).expect("a folder");
    let png = png.filter(|f| {
        f.as_ref()
            .is_ok_and(|f| f.path().extension().is_some_and(|e| e == "png"))
    });
    assert_eq!(png.count(), 2, "a picture of each scene");
    for scene in ["room", "cut"] {
        let [coarse, fine] = ["25", "400"].map(|resolution| error(scene, resolution));
        assert!(fine < coarse / 2.0, "{coarse} and {fine}: {csv}");
    }
    for row in frames {
        let number = |column| number(row, column).expect("a number");
        let lists = 4.0 * (number("pixels") + number("keys"));
        assert!(
            number("lists_bytes").to_bits() == lists.to_bits(),
            "{row:?}"
        );
        assert!(
            number("keys") > 0.0 && number("memory_bytes") > lists,
            "{row:?}"
        );
    }
    let page = only(&place.root.join("t"), "md");
    assert!(page.contains("| keys a pixel |"), "{page}");
}

/// Builds at the scene's own setting and at 50 pixels, twice, with entries of 8 bytes.
fn are_of_chains(rows: &[&BTreeMap<&str, &str>]) {
    let of_chains = rows.iter().map(|row| (row["resolution"], row["part"]));
    let must = ["20", "50"].map(|r| ["build", "link", "sort"].map(|part| (r, part)));
    assert_eq!(
        of_chains.collect::<Vec<_>>(),
        [must, must].concat().concat(),
        "resolution and part"
    );
    for row in rows {
        let number = |column: &str| row[column].parse::<f64>().expect("a number");
        let lists = 4.0 * number("pixels") + 8.0 * number("keys");
        assert!(
            number("lists_bytes").to_bits() == lists.to_bits() && number("time_ms") > 0.0,
            "{row:?}"
        );
        let asked = ["frame_ms", "rmse_same", "flip"].map(|column| row[column]);
        assert_eq!(asked, [""; 3], "nothing is asked");
    }
}

/// The floor's normal leaves out what grazes it; a sun leaves most maps dark.
#[test]
fn what_is_left_out_is_measured() {
    let place = Place::new("bench-ldm-skips");
    place.write("own/sun.toml", SUN);
    let sky = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../corpus/ldm/sky-image/sky.hdr"
    );
    fs::copy(sky, place.root.join("own/sun.hdr")).expect("a copy of a sky");
    let command = ["bench", "ldm", "own/sun.toml", "--skips"];
    let files = ["--runs", "1", "--out", "t", "--adapter", "swiftshader"];
    place.run(&[&command[..], &files].concat()).expect(0);
    let csv = only(&place.root.join("t"), "csv").replace("one, ", "one ");
    let csv = csv.replace('"', "");
    let rows = rows(&csv);
    let of = |what: &str| {
        let what = what.to_owned();
        let own = rows.iter().find(|row| row["left_out"] == what);
        let own = own.unwrap_or_else(|| panic!("no {what}: {csv}"));
        move |column: &str| {
            own[column]
                .parse::<f64>()
                .unwrap_or_else(|e| panic!("{what} {column}: {e}"))
        }
    };
    for (what, fewer) in [
        ("directions", "maps"),
        ("cropping", "pixels"),
        ("dark directions", "maps"),
        ("lists of one runs", "pixels"),
        ("lists of one chains", "keys"),
    ] {
        let of = of(what);
        let full = of(&format!("full_{fewer}"));
        assert!(0.0 < of(fewer) && of(fewer) < full, "{what}: {csv}");
        assert!(
            of("time_ms") > 0.0 && of("full_time_ms") > 0.0,
            "{what}: {csv}"
        );
    }
    let [one, more] = ["1", "2 to 32"].map(|length| of(&format!("lists of {length}"))("keys"));
    let listed = of("directions")("keys");
    assert!(one > 0.0 && (one + more - listed).abs() < 0.5, "{csv}");
    let page = only(&place.root.join("t"), "md");
    assert!(page.contains("| left out |"), "{page}");
}

/// Both techniques, at each of six distances, with all their settings.
#[test]
fn maps_have_a_rival() {
    let place = Place::new("bench-ldm-rival");
    place.write("own/room.toml", ROOM);
    let command = ["bench", "ldm", "own/room.toml", "--rival"];
    let files = ["--runs", "1", "--out", "t", "--adapter", "llvmpipe"];
    let ran = place.run(&[&command[..], &files].concat()).expect(0);
    let csv = only(&place.root.join("t"), "csv");
    let of = |technique| csv.matches(technique).count();
    assert_eq!([of(",maps,"), of(",horizons,")], [6 * 5, 6 * 6], "{csv}");
    let verdicts = ran
        .stdout
        .matches("the least error of maps and of horizons");
    assert_eq!(verdicts.count(), 6, "{}", ran.stdout);
}

/// The heading and the rows of an adapter, whose cells have no commas.
fn of_adapter(csv: &str) -> String {
    let lines = csv.lines().enumerate();
    let lines = lines.filter(|(at, line)| *at == 0 || line.contains("gpu@"));
    let lines: Vec<&str> = lines.map(|(_, line)| line).collect();
    lines.join("\n")
}

const STACK: &str = r#"
purpose = "300 quads, each a little above the other"
size = [8, 8]
[[mesh]]
generate.stack = { layers = 300, size = [4, 4], spacing = 0.002 }
[grid]
"#;

const ROOM: &str = r#"
purpose = "a box on a floor"
size = [24, 16]
[camera]
eye = [3, 3, 5]
target = [0, 0.5, 0]
fov = 40
near = 0.5
far = 20
[[mesh]]
generate.box = { size = [1, 1, 1] }
translate = [0, 0.5, 0]
[[mesh]]
generate.faces = { vertices = [[-2, 0, -2], [2, 0, -2], [2, 0, 2], [-2, 0, 2]], faces = [[0, 1, 2, 3]] }
[ldm]
directions = 8
resolution = 20
"#;

/// A floor beside which a box floats that is not seen, under a sky of one bright texel.
const SUN: &str = r#"
purpose = "a box over a floor in the sun"
size = [24, 16]
[camera]
eye = [3, 3, 5]
target = [0, 0, 0]
fov = 30
near = 0.5
far = 20
up = [0, 0, 1]
[[mesh]]
generate.faces = { vertices = [[-2, -2, 0], [2, -2, 0], [2, 2, 0], [-2, 2, 0]], faces = [[0, 1, 2, 3]] }
[[mesh]]
generate.box = { size = [1, 1, 1] }
translate = [0, 0, 4]
seen = false
[ldm]
directions = 62
resolution = 20
sky.image = { file = "sun.hdr", filter = "nearest", front = [1, 0, 0] }
"#;
