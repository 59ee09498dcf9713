//! Mistakes of a user: one line that says where and what, exit code 2.

use super::{PACKAGED, Place, SCENE};

/// Runs what must fail, and gives the line without the program's name.
#[track_caller]
fn mistake(place: &Place, arguments: &[&str]) -> String {
    let ran = place.run(arguments).expect(2);
    let line = ran.stderr.strip_suffix('\n').unwrap_or(&ran.stderr);
    assert!(!line.contains('\n'), "more than one line:\n{}", ran.stderr);
    assert!(!line.contains('\x1b'), "an escape code: {line:?}");
    let message = line.strip_prefix("triptych: ");
    message
        .unwrap_or_else(|| panic!("{line:?} does not say whose it is"))
        .to_owned()
}

/// The same, with nothing on standard output.
#[track_caller]
fn only(place: &Place, arguments: &[&str]) -> String {
    let ran = place.run(arguments);
    assert_eq!(ran.stdout, "", "standard output of {arguments:?}");
    mistake(place, arguments)
}

#[track_caller]
fn assert_parts(line: &str, parts: &[&str]) {
    for part in parts {
        assert!(line.contains(part), "{line:?} lacks {part:?}");
    }
}

/// Each with arguments that start no GPU, so that the table is quick.
#[test]
fn files_with_a_mistake() {
    let place = Place::new("mistakes");
    let scene = |from: &str, to: &str| SCENE.replace(from, to);
    place
        .write("nan.obj", "v 0 0 0\nv 1 nan 0\nv 0 1 0\nf 1 2 3\n")
        .write("range.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n")
        .write("none.obj", "v 0 0 0\n")
        .write(
            "key/scene.toml",
            &scene("size = [8, 8]", "size = [8, 8]\nheigth = 3"),
        )
        .write("zero/scene.toml", &scene("[8, 8]", "[0, 8]"))
        .write("large/scene.toml", &scene("[8, 8]", "[8, 2049]"))
        .write("glass/scene.toml", &scene("opacity = 0.5", "opacity = 1.5"))
        .write(
            "file/scene.toml",
            &scene("generate.stack", "file = \"gone.obj\" #"),
        )
        .write(
            "name/scene.toml",
            &PACKAGED.replace("bunny.obj", "rabbit.obj"),
        )
        .write(
            "surplus/scene.toml",
            &scene("layers = 2, size = [4, 4]", "layers = 2, size = [4, 4, 4]"),
        )
        .write(
            "outside/scene.toml",
            &scene(
                "[expect]",
                "[expect]\nlists = [{ at = [99, 99], prims = [] }]",
            ),
        )
        .write("broken/scene.toml", "purpose = \"\n");
    for (file, parts) in [
        ("nan.obj", &["nan.obj:2: ", "nan"][..]),
        ("range.obj", &["range.obj:4: ", "9"]),
        ("none.obj", &["none.obj", "no triangles"]),
        ("key/scene.toml", &["key/scene.toml:4: ", "heigth"]),
        ("zero/scene.toml", &["zero/scene.toml:3: ", "0", "2048"]),
        (
            "large/scene.toml",
            &["large/scene.toml:3: ", "2049", "2048"],
        ),
        ("glass/scene.toml", &["glass/scene.toml:13: ", "1.5"]),
        ("file/scene.toml", &["gone.obj"]),
        ("name/scene.toml", &["name/scene.toml:5: ", "rabbit.obj"]),
        ("surplus/scene.toml", &["surplus/scene.toml:15: ", "3", "2"]),
        (
            "outside/scene.toml",
            &["outside/scene.toml:20: ", "[99, 99]", "[7, 7]"],
        ),
        ("broken/scene.toml", &["broken/scene.toml:1: "]),
        ("gone.obj", &["gone.obj"]),
        ("gone/scene.toml", &["gone/scene.toml"]),
    ] {
        assert_parts(&only(&place, &["plan", file]), parts);
        assert_parts(&only(&place, &["replay", "--leg", "spec", file]), parts);
    }
}

#[test]
fn names_that_match_nothing() {
    let place = Place::new("names");
    place.write("corpus/raster/quads/scene.toml", SCENE);
    let parts = ["nonsuch", "no scene", "triptych list"];
    for command in ["list", "plan", "replay"] {
        assert_parts(&only(&place, &[command, "nonsuch"]), &parts);
    }
    // A part of a name is no whole name.
    assert_parts(
        &only(&place, &["list", "--exact", "raster/quad"]),
        &["raster/quad"],
    );
    let line = only(&place, &["replay", "quads", "--adapter", "nonsuch"]);
    assert_parts(&line, &["nonsuch", "triptych doctor"]);
    place.write("corpus/raster/empty/note.txt", "");
    assert_parts(
        &only(&place, &["list"]),
        &["raster/empty/scene.toml", "missing"],
    );
}

#[test]
fn options_with_a_mistake() {
    let place = Place::new("options");
    for arguments in [
        &["replay", "--leg", "nonsuch"][..],
        &["replay", "--gpu-from", "nonsuch"],
        &["replay", "--nonsuch"],
        &["nonsuch"],
        &["plan"],
        &[],
    ] {
        let ran = place.run(arguments).expect(2);
        assert_eq!(ran.stdout, "", "standard output of {arguments:?}");
        assert!(ran.stderr.contains("--help"), "{}", ran.stderr);
        assert!(!ran.stderr.contains("panicked"), "{}", ran.stderr);
    }
    // The GPU may take over at every stage of the registry but rivals, which all begin alike.
    let ran = place.run(&["replay", "--gpu-from", "nonsuch"]);
    let stages: Vec<&str> =
        triptych_harness::registry::stages_of(triptych_harness::registry::Chain::Frame)
            .map(|s| s.name)
            .filter(|name| !triptych_harness::registry::RIVALS.contains(name))
            .collect();
    let listed = format!("[possible values: {}]", stages.join(", "));
    assert!(
        ran.stderr.contains(&listed),
        "{} lacks {listed}",
        ran.stderr
    );
}

#[test]
fn files_that_cannot_be_written_or_read() {
    let place = Place::new("writing");
    place
        .write("corpus/raster/quads/scene.toml", SCENE)
        .write("file", "")
        .write("bad.json", "{\n");
    let spec = |option: &str, value: &str| {
        mistake(
            &place,
            &["replay", "--no-cache", "--leg", "spec", option, value],
        )
    };
    assert_parts(&spec("--json", "file/out.json"), &["--json"]);
    assert_parts(&spec("--dump", "file/dump"), &["file/dump"]);
    assert_parts(&only(&place, &["report", "gone.json"]), &["gone.json"]);
    assert_parts(&only(&place, &["report", "bad.json"]), &["bad.json:1: "]);
}

/// What only a scene's geometry brings out has its key and line as well.
#[test]
fn scenes_beyond_a_limit_of_their_family() {
    let place = Place::new("beyond");
    let start = "purpose = 'x'\nsize = [8, 8]\n";
    let quads = "[[mesh]]\ngenerate.stack = { layers = 2, size = [4, 4], spacing = 1 }\n";
    let lamp = "rsm.lamp = { eye = [0, 0, 3], target = [0, 0, 0], fov = 40, near = 1, far = 9 }\n";
    let of = |keys: &str| format!("{start}{lamp}{keys}{quads}");
    let rays = ["random", "aimed", "edge", "vertex", "grazing", "cell"];
    let rays = rays.map(|kind| format!("{kind} = 2097152")).join(", ");
    let long = quads
        .replace("layers = 2", "layers = 4096")
        .replace("spacing = 1", "spacing = 0.0001");
    let grid = format!("{start}{long}[grid]\nresolution = [1, 1, 1]\nrays = {{ {rays} }}\n");
    place
        .write("clamp/scene.toml", &of("rsm.clamp = 1e300\n"))
        .write("far/scene.toml", &of("rsm.reference = 1e300\n"))
        .write("rays/scene.toml", &grid)
        .write(
            "short/scene.toml",
            &format!("{start}[ldm]\nfar = 1e-9\n{quads}"),
        );
    for (scene, parts) in [
        (
            "clamp",
            [
                "clamp/scene.toml:4: rsm.clamp: 1e300 is outside 0 to ",
                "the lattice's diagonal",
            ],
        ),
        (
            "far",
            [
                "far/scene.toml:4: rsm.reference: a strength of ",
                "a smaller strength, is right",
            ],
        ),
        (
            "rays",
            [
                "rays/scene.toml:7: grid.rays: 12582912 rays pass more than ",
                "ask for fewer rays",
            ],
        ),
        (
            "short",
            [
                "short/scene.toml:4: ldm.far: 1e-9 is less than half a step",
                "or more is right",
            ],
        ),
    ] {
        let path = format!("{scene}/scene.toml");
        assert_parts(
            &mistake(&place, &["replay", "--leg", "spec", &path]),
            &parts,
        );
    }
}

/// Counting what is not judged is no comparison, and neither is a leg that does not run.
#[test]
fn nothing_judged_is_no_success() {
    let place = Place::new("unjudged");
    // A triangle whose only sample lies on its edge: its pair is in class edge.
    let edge = SCENE
        .replace("size = [8, 8]", "size = [1, 1]")
        .replace("height = 8", "height = 1");
    let (edge, _) = edge.split_once("[[mesh]]").expect("a mesh");
    let mesh = "[[mesh]]\ngenerate.faces = { vertices = [[-1, -1, 0], [1, 1, 0], [-1, 1, 0]], \
                faces = [[0, 1, 2]] }\n[budget]\nedge = 1\n";
    place.write("edge/scene.toml", &format!("{edge}{mesh}"));
    let arguments = [
        "replay",
        "--leg",
        "embree",
        "--json",
        "out.json",
        "edge/scene.toml",
    ];
    assert_parts(&mistake(&place, &arguments), &["nothing was compared"]);
    let json = std::fs::read_to_string(place.root.join("out.json")).expect("written");
    assert_parts(&json, &["class edge", "\"compared\":0", "\"admitted\":1"]);
    // Nor does a report make one of it.
    let line = mistake(&place, &["report", "out.json"]);
    assert_parts(&line, &["nothing was compared"]);
}

#[test]
fn reports_of_what_is_no_run() {
    let place = Place::new("no-run");
    let pipe = place.root.join("pipe");
    let made = std::process::Command::new("mkfifo").arg(&pipe).status();
    assert!(
        made.is_ok_and(|m| m.success()),
        "mkfifo is part of every Unix"
    );
    // Opening it would wait for a writer.
    assert_parts(
        &only(&place, &["report", "pipe"]),
        &["pipe: is not a regular file"],
    );
    place.write("corpus/raster/quads/scene.toml", SCENE);
    place
        .run(&["replay", "--leg", "spec", "--json", "a.json"])
        .expect(0);
    let twice = only(&place, &["report", "a.json", "a.json"]);
    assert_parts(&twice, &["a.json: is named twice"]);
}
