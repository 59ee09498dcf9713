//! `stress` under Miri, which sees undefined behaviour, and ThreadSanitizer, which sees races.
//!
//! Both need a nightly compiler and build everything anew, so they run when asked for, by
//! `TRIPTYCH_SANITIZERS=1` or `--include-ignored`; else they are ignored, and it is said why.

use std::env;
use std::path::Path;
use std::process::{Command, ExitCode};

use libtest_mimic::{Arguments, Failed, Trial};

/// A run of `stress`.
struct Run {
    name: &'static str,
    /// What must be installed, as a command that then succeeds.
    needs: &'static [&'static str],
    /// Cargo's, before the target.
    cargo: &'static [&'static str],
    /// An environment variable and its value.
    flags: (&'static str, &'static str),
    /// Tests that are left out.
    skip: &'static [&'static str],
}

const MIRI: &[&str] = &["cargo", "miri", "--version"];

const RUNS: [Run; 3] = [
    // Everything is given back at the end, and aliasing is judged by the stricter rules.
    Run {
        name: "miri/without-epochs",
        needs: MIRI,
        cargo: &["miri", "test"],
        flags: ("MIRIFLAGS", ""),
        skip: &["lfree", "stealing", "what_is_left", "tasks_may_borrow"],
    },
    // crossbeam-epoch goes from an entry of its list to what holds it, which Stacked Borrows
    // forbid and Tree Borrows do not; and what was retired last waits for an epoch that does
    // not come before the process ends, which is no leak of ours.
    Run {
        name: "miri/with-epochs",
        needs: MIRI,
        cargo: &["miri", "test"],
        flags: ("MIRIFLAGS", "-Zmiri-tree-borrows -Zmiri-ignore-leaks"),
        skip: &["lock", "local", "segments"],
    },
    // The standard library is built with it, or its locks order nothing. Thieves of
    // crossbeam-deque read a task that may be overwritten meanwhile, and throw it away then:
    // a race by the letter, theirs, and known to them.
    Run {
        name: "thread-sanitizer",
        needs: &["cargo", "-Z", "help"],
        cargo: &["test", "-Zbuild-std"],
        flags: ("RUSTFLAGS", "-Zsanitizer=thread"),
        skip: &["stealing"],
    },
];

/// A command of the nightly toolchain.
fn nightly(words: &[&str]) -> Command {
    let mut command = Command::new("rustup");
    command.args(["run", "nightly"]).args(words);
    command
}

fn succeeds(words: &[&str]) -> bool {
    nightly(words)
        .output()
        .is_ok_and(|output| output.status.success())
}

/// The target's name, that building the standard library asks for.
fn host() -> Result<String, Failed> {
    let output = nightly(&["rustc", "-vV"])
        .output()
        .map_err(|e| e.to_string())?;
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let host = text.lines().find_map(|line| line.strip_prefix("host: "));
    host.map(str::to_owned)
        .ok_or_else(|| "rustc names no host".into())
}

/// Why a run is not possible.
fn missing(run: &Run) -> Option<&'static str> {
    if !succeeds(&["rustc", "--version"]) {
        return Some("no nightly toolchain");
    }
    if !succeeds(run.needs) {
        return Some("the nightly toolchain lacks what it needs");
    }
    let sysroot = nightly(&["rustc", "--print", "sysroot"]).output().ok()?;
    let sysroot = String::from_utf8_lossy(&sysroot.stdout).trim().to_owned();
    let source = Path::new(&sysroot).join("lib/rustlib/src/rust/library/std");
    (!source.is_dir()).then_some("the nightly toolchain has no rust-src")
}

fn execute(run: &Run) -> Result<(), Failed> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let mut command = nightly(&["cargo"]);
    command
        .current_dir(&root)
        .args(run.cargo)
        .args(["--target", &host()?, "--package", "triptych-models"])
        .args(["--test", "stress", "--"])
        .args(run.skip.iter().flat_map(|name| ["--skip", name]))
        .env(run.flags.0, run.flags.1)
        // Of its own, as flags are part of what is built, and cargo's lock on ours is taken.
        .env("CARGO_TARGET_DIR", root.join("target/sanitizers"));
    let output = command.output().map_err(|e| e.to_string())?;
    let (said, complaints) = (
        String::from_utf8_lossy(&output.stdout),
        String::from_utf8_lossy(&output.stderr),
    );
    // An empty run has not seen anything.
    if output.status.success() && said.contains("test result: ok") && !said.contains(" 0 passed") {
        return Ok(());
    }
    Err(format!("{said}\n{complaints}").into())
}

fn main() -> ExitCode {
    let arguments = Arguments::from_args();
    let asked = env::var_os("TRIPTYCH_SANITIZERS").is_some();
    let trials = RUNS.into_iter().map(|run| {
        let missing = if asked {
            missing(&run)
        } else {
            Some("TRIPTYCH_SANITIZERS is not set")
        };
        if let Some(why) = missing.filter(|_| !arguments.list) {
            eprintln!("{} is ignored: {why}", run.name);
        }
        Trial::test(run.name, move || execute(&run)).with_ignored_flag(missing.is_some())
    });
    let trials = trials.collect();
    libtest_mimic::run(&arguments, trials).exit_code()
}
