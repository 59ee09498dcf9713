//! What is printed where: no escape codes without a terminal, no noise from a pipe
//! that closes.

use std::io::PipeWriter;
use std::process::Stdio;

use super::{Place, Ran, SCENE};
use crate::results::json;

#[test]
fn no_escape_codes_without_a_terminal() {
    let place = Place::new("plain");
    place.write("corpus/raster/quads/scene.toml", SCENE);
    for no_colour in ["", "1"] {
        let mut command = place.command(&["replay", "--no-cache", "--leg", "spec"]);
        let ran = Ran::of(command.env("NO_COLOR", no_colour)).expect(0);
        assert!(ran.stdout.contains("raster/quads"), "{}", ran.stdout);
        assert!(!ran.stdout.contains('\x1b'), "{:?}", ran.stdout);
        assert_eq!(ran.stderr, "", "no progress bar without a terminal");
        let trailing = |line: &&str| line.ends_with(' ');
        assert_eq!(ran.stdout.lines().find(trailing), None, "trailing spaces");
    }
}

/// A pipe that nobody reads from.
fn unread() -> PipeWriter {
    let (reader, writer) = std::io::pipe().expect("a pipe");
    drop(reader);
    writer
}

/// A reader that leaves hears no complaint, and changes nothing about what a run came
/// to: neither the exit code nor what is written to files.
#[test]
fn a_reader_that_leaves_does_not_end_a_run() {
    let place = Place::new("pipe");
    let wrong = SCENE.replace("fragments = 32", "fragments = 33");
    place
        .write("corpus/raster/quads/scene.toml", SCENE)
        .write("corpus/raster/wrong/scene.toml", &wrong);
    let replay = [
        "replay",
        "--no-cache",
        "--leg",
        "embree",
        "--json",
        "out.json",
    ];
    let replay = |pattern| [&replay[..], &[pattern]].concat();
    for (arguments, code) in [
        (vec!["list"], 0),
        (vec!["plan", "quads"], 0),
        (vec!["--help"], 0),
        (replay("quads"), 0),
        (vec!["report", "out.json"], 0),
        (replay("raster/"), 1),
        (vec!["report", "out.json"], 1),
    ] {
        let page = place.root.join("reports/out/index.html");
        let _ = std::fs::remove_file(&page);
        let mut command = place.command(&arguments);
        command.stdout(unread()).stderr(Stdio::piped());
        let output = command.output().expect("the command can be run");
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert_eq!(stderr, "", "{arguments:?}");
        assert_eq!(output.status.code(), Some(code), "{arguments:?}");
        let writes = ["replay", "report"].contains(&arguments[0]);
        assert_eq!(page.is_file(), writes, "the report of {arguments:?}");
    }
    let lines = json(&place.root.join("out.json"));
    assert_eq!(lines.last().expect("a summary")["scenes"], 2, "{lines:?}");
}

/// What could not be done is no success, whoever listens.
#[test]
fn mistakes_keep_their_exit_code_when_nobody_reads_them() {
    let place = Place::new("unread");
    place.write("corpus/raster/quads/scene.toml", SCENE);
    let replay = ["replay", "--leg", "embree", "--json", "/dev/stdout"];
    for arguments in [&["list", "nonsuch"][..], &["report", "gone.json"], &replay] {
        let mut command = place.command(arguments);
        let status = command.stdout(unread()).stderr(unread()).status();
        let code = status.expect("the command can be run").code();
        assert_eq!(code, Some(2), "{arguments:?}");
    }
}

#[test]
fn help_and_version_are_results() {
    let place = Place::new("help");
    for arguments in [
        &["--help"][..],
        &["--version"],
        &["replay", "--help"],
        &["list", "-h"],
    ] {
        let ran = place.run(arguments).expect(0);
        assert!(!ran.stdout.is_empty(), "{arguments:?} says nothing");
        assert_eq!(ran.stderr, "", "{arguments:?}");
    }
    let doctor = place.run(&["doctor", "--help"]).expect(0).stdout;
    assert!(doctor.contains("corpus/findings"), "{doctor}");
}

/// What loading left out of a mesh is told in one line, by every command that loads it
/// and whether or not the results come from the cache.
#[test]
fn what_a_mesh_lacks_is_told_once() {
    let place = Place::new("notes");
    let triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n";
    let scene = |mesh: &str| format!("purpose = 'x'\nsize = [8, 8]\n{mesh}");
    let twice = "[[mesh]]\nfile = 'lp.obj'\n[[mesh]]\nfile = 'lp.obj'\n";
    let placed = "[[mesh]]\nfile = 'nomtl.obj'\nmaterial = 'glass'\n\
        [[material]]\nname = 'glass'\ncolour = [1, 1, 1]\nopacity = 0.5\n";
    place
        .write(
            "lp.obj",
            &format!("{triangle}l 1 2\nl 2 3\nl 1 3\np 1\nf 1\nnonsense\n"),
        )
        .write("nomtl.obj", &format!("mtllib x.mtl\n{triangle}"))
        .write("many.obj", &format!("mtllib a b c d e\n{triangle}"))
        .write("twice.toml", &scene(twice))
        .write("placed.toml", &scene(placed));
    let undefined = "1 of 1 materials not defined, so their faces take the default";
    let lp = format!(
        "lp.obj: 3 lines and 2 points ignored; \
        1 unknown statement ignored, the first on line 11: `nonsense`; {undefined}"
    );
    let missing = |name: &str| format!("material library `{name}` is not there");
    let many = ["a", "b", "c"].map(missing).join("; ");
    for (file, note) in [
        ("lp.obj", lp.clone()),
        ("twice.toml", lp),
        (
            "nomtl.obj",
            format!("nomtl.obj: {}; {undefined}", missing("x.mtl")),
        ),
        // The scene gives all faces a material, so no default is taken.
        ("placed.toml", format!("nomtl.obj: {}", missing("x.mtl"))),
        ("many.obj", format!("many.obj: {many}; 3 more warnings")),
    ] {
        let planned = place.run(&["plan", file]).expect(0);
        let told = |text: &str, line: &str| text.lines().filter(|l| *l == line).count();
        let line = format!("  note  {note}");
        assert_eq!(
            told(&planned.stdout, &line),
            1,
            "{line:?} in\n{}",
            planned.stdout
        );
        let replay = ["replay", "--leg", "embree", file];
        for cached in [false, true] {
            let replayed = place.run(&replay).expect(0);
            let from_cache = replayed.stdout.contains("From the cache: ");
            assert_eq!(from_cache, cached, "{}", replayed.stdout);
            assert_eq!(told(&replayed.stdout, &note), 1, "{}", replayed.stdout);
        }
    }
}
