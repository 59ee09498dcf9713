//! Commands about the corpus, and scenes outside it.

use super::{PACKAGED, Place, Ran, SCENE, repository};

#[test]
fn list_names_every_scene_with_its_purpose() {
    let place = Place::new("list");
    place
        .write("corpus/raster/quads/scene.toml", SCENE)
        .write("corpus/abuffer/bunny/scene.toml", PACKAGED);
    let all = place.run(&["list"]).expect(0);
    let expected = "abuffer/bunny  a mesh that set-up brings\n\
                    raster/quads   a quad in front of half of another\n";
    assert_eq!(all.stdout, expected);
    let one = place.run(&["list", "quads"]).expect(0);
    assert_eq!(
        one.stdout,
        "raster/quads  a quad in front of half of another\n"
    );
    let exact = place.run(&["list", "--exact", "raster/quads"]).expect(0);
    assert_eq!(exact.stdout, one.stdout);
    place.write("shape.obj", "v 0 0 0\n");
    let mesh = place.run(&["list", "shape.obj"]).expect(0);
    assert_eq!(mesh.stdout, "shape  a mesh by itself, seen whole\n");
}

#[test]
fn plan_says_what_runs_and_why() {
    let place = Place::new("plan");
    place.write("corpus/raster/quads/scene.toml", SCENE);
    let ran = place.run(&["plan", "quads"]).expect(0);
    let mut lines = ran.stdout.lines();
    assert_eq!(lines.next(), Some("raster/quads: 4 triangles"));
    let passes: Vec<Vec<&str>> = lines.map(|l| l.split_whitespace().collect()).collect();
    let stages = triptych_harness::registry::stages_of(triptych_harness::registry::Chain::Frame);
    let layouts = triptych_harness::registry::FAMILIES
        .iter()
        .filter(|f| f.name == "layouts");
    let layouts: Vec<&str> = layouts
        .flat_map(|f| f.stages)
        .map(|stage| stage.name)
        .collect();
    for (pass, stage) in passes.iter().zip(stages) {
        let verb = match stage.name {
            "cover" | "opaque" => "skip",
            // Scenes of raster are about coverage.
            rival if triptych_harness::registry::RIVALS.contains(&rival) => "skip",
            layout if layouts.contains(&layout) => "skip",
            _ => "run",
        };
        assert_eq!(pass[..2], [verb, stage.name], "{}", ran.stdout);
        assert!(pass.len() > 2, "{} gives no reason", stage.name);
    }
}

/// Whatever is missing, the doctor says so and fails in order.
#[test]
fn doctor_looks_at_everything() {
    let place = Place::new("doctor");
    let native = repository().join(".native");
    for (folder, code) in [(native.as_path(), None), (place.root.as_path(), Some(1))] {
        let ran = Ran::of(place.command(&["doctor"]).env("TRIPTYCH_NATIVE", folder));
        assert!(
            matches!(ran.code, Some(0 | 1)),
            "{:?}: {}",
            ran.code,
            ran.stderr
        );
        assert!(
            code.is_none_or(|code| ran.code == Some(code)),
            "{}",
            ran.stdout
        );
        for heading in ["Adapters\n", "Embree\n", "Meshes in "] {
            assert!(
                ran.stdout.contains(heading),
                "{} lacks {heading}",
                ran.stdout
            );
        }
        let last = ran.stdout.lines().last().unwrap_or_default();
        let expected = match ran.code {
            Some(0) => "All legs can run.",
            _ => "Something is missing; `./x setup` installs it.",
        };
        assert_eq!(last, expected, "{}", ran.stdout);
    }
}

/// A mesh by itself, from another folder, through every leg.
#[test]
fn a_bare_mesh_is_replayed_from_anywhere() {
    let place = Place::new("bare");
    place.write(
        "elsewhere/shape.obj",
        "v 0 0 0\nv 1 0 0\nv 0 1 0.5\nf 1 2 3\n",
    );
    let folder = place.root.join("elsewhere");
    let mut command = place.command(&["replay", "--no-cache", "shape.obj"]);
    // Relative to the folder where the user is, whatever the corpus.
    command.current_dir(folder).env_remove("TRIPTYCH_CORPUS");
    command.env("TRIPTYCH_CORPUS", place.root.join("corpus"));
    let ran = Ran::of(&mut command).expect(0);
    assert!(
        ran.stdout.contains("All agree: 1 scene, "),
        "{}",
        ran.stdout
    );
    for leg in ["embree", "shape"] {
        assert!(ran.stdout.contains(leg), "{} lacks {leg}", ran.stdout);
    }
}

/// A mesh that is not there skips its scene, which is said and counted; a run in
/// which nothing was compared is no success.
#[test]
fn a_missing_mesh_is_skipped_and_never_passes() {
    let place = Place::new("missing");
    place
        .write("corpus/raster/quads/scene.toml", SCENE)
        .write("corpus/abuffer/bunny/scene.toml", PACKAGED)
        .write("nothing/here", "");
    let run = |pattern: &str| {
        let arguments = [
            "replay",
            "--no-cache",
            "--leg",
            "embree",
            "--json",
            "out.json",
            pattern,
        ];
        let mut command = place.command(&arguments);
        Ran::of(command.env("TRIPTYCH_NATIVE", place.root.join("nothing")))
    };
    let alone = run("bunny").expect(2);
    let parts = [
        (&alone.stdout, "bunny.obj"),
        (&alone.stdout, "./x setup"),
        (&alone.stderr, "nothing was compared"),
    ];
    for (text, part) in parts {
        assert!(text.contains(part), "{text} lacks {part}");
    }
    let both = run("/").expect(0);
    assert!(both.stdout.contains("Skipped: "), "{}", both.stdout);
    assert!(both.stdout.contains("bunny.obj"), "{}", both.stdout);
    let lines = std::fs::read_to_string(place.root.join("out.json")).expect("it was written");
    let skipped = r#""skipped":"mesh bunny.obj is not there"#;
    assert!(lines.contains(skipped), "{lines}");
}
