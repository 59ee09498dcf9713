//! What is printed where: no escape codes without a terminal, no noise from a pipe
//! that closes.

use std::process::Stdio;

use super::{Place, Ran, SCENE};

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

#[test]
fn a_closed_pipe_is_quiet() {
    let place = Place::new("pipe");
    place.write("corpus/raster/quads/scene.toml", SCENE);
    for arguments in [
        &["list"][..],
        &["plan", "quads"],
        &["replay", "--leg", "spec"],
        &["--help"],
    ] {
        let mut command = place.command(arguments);
        command.stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().expect("the command can be run");
        // Closed before anything is written.
        drop(child.stdout.take());
        let output = child.wait_with_output().expect("it ends");
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert_eq!(stderr, "", "{arguments:?}");
        assert!(
            output.status.code().is_some(),
            "{arguments:?}: {}",
            output.status
        );
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
