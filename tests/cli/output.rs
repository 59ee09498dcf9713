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
}
