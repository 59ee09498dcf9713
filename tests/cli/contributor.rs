//! `add` and `bundle`: what a contributor brings in, and takes elsewhere.

use std::fs;
use std::path::Path;
use std::process::Command;

use super::{PACKAGED, Place, Ran, SCENE, repository};

/// The tables that every scene has a row in.
const README: &str = "# The corpus\n\n| `raster/` | purpose |\n|---|---|\n\n\
                      | `abuffer/` | purpose |\n|---|---|\n| `deep` | layers |\n| `quads` | quads |\n";

/// A quad with a material of its own, from a library in a folder below.
const MESH: &str =
    "mtllib lib/mine.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nusemtl red\nf 1 2 3 4\n";
const LIBRARY: &str = "newmtl red\nKd 1 0 0\nd 0.5\n";

fn place(name: &str) -> Place {
    let place = Place::new(name);
    place
        .write("corpus/README.md", README)
        .write("mine/Knot No 1.obj", MESH)
        .write("mine/lib/mine.mtl", LIBRARY);
    place
}

#[test]
fn a_mesh_becomes_a_scene_with_a_pending_snapshot() {
    let place = place("add");
    let purpose = "a \"knot\" | a quad";
    let command = ["add", "mine/Knot No 1.obj", "--purpose", purpose];
    let ran = place.run(&command).expect(0);
    let read = |name: &str| {
        fs::read_to_string(place.root.join(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
    };
    let scene = read("corpus/abuffer/knot-no-1/scene.toml");
    assert!(scene.contains("file = \"Knot No 1.obj\""), "{scene}");
    assert_eq!(
        read("corpus/abuffer/knot-no-1/Knot No 1.obj"),
        MESH,
        "as it was"
    );
    assert_eq!(
        read("corpus/abuffer/knot-no-1/lib/mine.mtl"),
        LIBRARY,
        "as it was"
    );
    let row = "| `deep` | layers |\n| `knot-no-1` | a \"knot\" \\| a quad |\n| `quads` | quads |\n";
    assert!(read("corpus/README.md").contains(row), "in order of cases");
    let pending = read("tests/snapshots/abuffer/knot-no-1.snap.new");
    assert!(
        pending.contains("description: \"a \\\"knot\\\" | a quad\"\n"),
        "{pending}"
    );
    assert!(pending.contains("\ntriangles: 2\n"), "{pending}");
    assert!(ran.stdout.contains("All agree: 1 scene,"), "{}", ran.stdout);
    assert!(ran.stdout.contains("cargo insta review"), "{}", ran.stdout);
    // It is a scene like any other, and its name is taken.
    let command = ["replay", "--exact", "abuffer/knot-no-1", "--leg", "embree"];
    place.run(&command).expect(0);
    let again = place
        .run(&["add", "mine/Knot No 1.obj", "--purpose", "x"])
        .expect(2);
    assert!(
        again.stderr.contains("is there already"),
        "{}",
        again.stderr
    );
}

/// The words of a command; what stands between quotes is one.
fn words(command: &str) -> Vec<&str> {
    let parts = command.split('"').enumerate();
    let words = parts.map(|(at, part)| match at % 2 {
        0 => part.split_whitespace().collect(),
        _ => vec![part],
    });
    words.collect::<Vec<Vec<&str>>>().concat()
}

/// The commands under "Adding a scene in three steps" do what stands there.
#[test]
fn the_three_steps_of_the_readme() {
    let place = place("steps");
    place.write("knot.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let page = fs::read_to_string(repository().join("corpus/README.md")).expect("there");
    let steps = page
        .split_once("## Adding a scene in three steps")
        .expect("a section")
        .1;
    let block = steps.split("```").nth(1).expect("a block of commands");
    let commands = block.lines().skip(1).map(|line| {
        let (command, step) = line.rsplit_once('#').expect("each is numbered");
        (step.trim(), command.trim())
    });
    let commands: Vec<_> = commands.collect();
    let [("1", add), ("2", replay), ("3", "cargo insta review")] = commands[..] else {
        panic!("these are no three steps: {commands:?}");
    };
    let run = |command: &str| {
        let command = command.strip_prefix("./x ").expect("a command of ours");
        place.run(&words(command)).expect(0).stdout
    };
    run(add);
    let pending = place.root.join("tests/snapshots/abuffer/knot.snap.new");
    assert!(pending.is_file(), "a snapshot to review");
    let changed = place.root.join("corpus/abuffer/knot/scene.toml");
    let scene = fs::read_to_string(&changed).expect("there");
    fs::write(&changed, scene.replace("[256, 256]", "[64, 32]")).expect("writable");
    assert!(run(replay).contains("pending snapshot: "), "other facts");
    let text = fs::read_to_string(&pending).expect("still pending");
    assert!(text.contains("size: 64 x 32\n"), "{text}");
    fs::rename(&pending, pending.with_extension("")).expect("as the review accepts it");
    assert!(
        !run(replay).contains("pending snapshot"),
        "it says what the spec found"
    );
}

#[test]
fn a_folder_with_a_scene_is_taken_as_it_is() {
    let place = place("add-folder");
    let scene = SCENE.replace("opacity = 0.5", "opacity = 1") + "fragments = 0\n";
    let scene = scene.replace("fragments = 32\nlayers_max = 2\n", "");
    place.write("mine/scene.toml", &scene);
    place
        .run(&["add", "mine", "--to", "raster/walls"])
        .expect(0);
    let copied = place.root.join("corpus/raster/walls/scene.toml");
    assert_eq!(
        fs::read_to_string(copied).expect("copied"),
        scene,
        "as it was"
    );
    let beside = place.root.join("corpus/raster/walls/Knot No 1.obj");
    assert!(
        !beside.exists(),
        "what the scene does not read stays where it is"
    );
    let readme = fs::read_to_string(place.root.join("corpus/README.md")).expect("there");
    let row = "|---|---|\n| `walls` | a quad in front of half of another |\n\n";
    assert!(readme.contains(row), "{readme}");
}

#[test]
fn what_cannot_be_added_leaves_nothing() {
    let place = place("add-mistakes");
    let large = format!("{MESH}{}", "# a long story\n".repeat(20_000));
    place
        .write("large.obj", &large)
        .write("nan.obj", "v 0 0 0\nv 1 nan 0\nv 0 1 0\nf 1 2 3\n")
        .write("packaged/scene.toml", &PACKAGED.replace("bunny", "gone"))
        .write("full/scene.toml", SCENE)
        .write("text.txt", "a\n");
    let mesh = "mine/Knot No 1.obj";
    for (arguments, part) in [
        (&[mesh][..], "say with --purpose, in one sentence"),
        (&["gone.obj", "--purpose", "x"], "gone.obj: does not exist"),
        (
            &["text.txt", "--purpose", "x"],
            "text.txt: is neither a mesh",
        ),
        (&["nan.obj", "--purpose", "x"], "nan.obj:2: "),
        (&["large.obj", "--purpose", "x"], "the limit"),
        (&["full", "--purpose", "x"], "leave out --purpose"),
        (&["packaged"], "is no row of corpus/meshes.lock"),
        (
            &[mesh, "--purpose", "x", "--to", "mine"],
            "FAMILY/CASE is expected",
        ),
        (
            &[mesh, "--purpose", "x", "--to", "vertex/a"],
            "families with scenes are raster, abuffer",
        ),
        (
            &[mesh, "--purpose", "x", "--to", "abuffer/../a"],
            "a case is called by small letters",
        ),
        (
            &[mesh, "--purpose", "x\ny"],
            "say in one line what the scene is for",
        ),
    ] {
        let ran = place.run(&[&["add"], arguments].concat()).expect(2);
        assert_eq!(ran.stderr.lines().count(), 1, "{}", ran.stderr);
        assert!(
            ran.stderr.contains(part),
            "{part:?} is not in {:?}",
            ran.stderr
        );
    }
    let readme = fs::read_to_string(place.root.join("corpus/README.md")).expect("there");
    assert_eq!(readme, README, "no row");
    let families = ["abuffer", "raster"].map(|f| place.root.join("corpus").join(f));
    let left = families
        .iter()
        .filter(|f| fs::read_dir(f).is_ok_and(|d| d.count() > 0));
    assert_eq!(left.count(), 0, "no folder");
}

#[test]
fn a_bundle_runs_without_an_environment() {
    let place = place("bundle");
    place.write("corpus/abuffer/flat/scene.toml", SCENE);
    place.write("corpus/abuffer/other/scene.toml", SCENE);
    place.write("full/a", "");
    place.write("corpus/findings/odd/finding.toml", "");
    let ran = place.run(&["bundle", "out", "flat"]).expect(0);
    assert!(
        ran.stdout.contains("copy it, and start out/run"),
        "{}",
        ran.stdout
    );
    let out = place.root.join("moved");
    fs::rename(place.root.join("out"), &out).expect("it can be moved");
    let finding = out.join("corpus/findings/odd/finding.toml");
    assert!(finding.is_file(), "what drivers do wrong goes along");
    let libraries = fs::read_dir(out.join("lib")).expect("Embree").count();
    assert!(libraries > 0, "Embree is in it");
    let mut command = Command::new(out.join("run"));
    command.args(["replay", "--no-cache", "--leg", "spec", "--leg", "embree"]);
    command
        .current_dir("/")
        .env_clear()
        .env("PATH", "/usr/bin:/bin");
    let ran = Ran::of(&mut command).expect(0);
    assert!(ran.stdout.contains("All agree: 1 scene,"), "{}", ran.stdout);
    let page = fs::read_to_string(out.join("reports/out/index.html"));
    let page = page.expect("the report is beside it");
    let again = format!("{} replay --exact", out.join("run").display());
    assert!(page.contains(&again), "commands that work there");
    place.run(&["bundle", "all"]).expect(0);
    let stand_in = "native/meshes/dragon-res3.ply.gz";
    let has = |bundle: &Path| bundle.join(stand_in).is_file();
    let all = [out.as_path(), &place.root.join("all")].map(has);
    assert_eq!(all, [false, true], "what bench reads goes with all scenes");
    let full = place.run(&["bundle", "full"]).expect(2).stderr;
    assert!(
        full.contains("full: is not empty; name a new folder"),
        "{full}"
    );
    // Nothing there leads back here, and a finding that cannot be read ends nothing.
    fs::remove_dir_all(place.root.join("corpus")).expect("ours");
    let mut command = Command::new(out.join("run"));
    let doctor = Ran::of(command.arg("doctor")).expect(1).stdout;
    let told = "Findings\n  cannot be read: ";
    assert!(
        doctor.contains(told) && doctor.contains("Embree\n"),
        "{doctor}"
    );
}
