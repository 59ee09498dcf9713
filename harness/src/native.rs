//! The environment that set-up wrote down.
//!
//! Cargo passes it on by `.cargo/config.toml`. A binary that is run by hand finds it
//! in `.native/env`, and starts itself again with it: the drivers' loader reads the
//! environment of the process, which a running program cannot change safely.

use std::process::Command;

use crate::corpus;

/// The variable that tells that the environment is set.
const MARK: &str = "TRIPTYCH_NATIVE";

/// Starts the program again with what set-up wrote, if the environment lacks it and
/// there is something to add. Where that is not possible, goes on without.
pub fn enter() {
    if std::env::var_os(MARK).is_some() {
        return;
    }
    let Ok(text) = std::fs::read_to_string(corpus::native().join("env")) else {
        return;
    };
    let Ok(program) = std::env::current_exe() else {
        return;
    };
    let set = parse(&text).filter(|(name, _)| std::env::var_os(name).is_none());
    let mut command = Command::new(program);
    command
        .args(std::env::args_os().skip(1))
        .env(MARK, corpus::native())
        .envs(set);
    replace(&mut command);
}

/// `NAME=VALUE` lines.
fn parse(text: &str) -> impl Iterator<Item = (&str, &str)> {
    text.lines().filter_map(|line| line.split_once('='))
}

#[cfg(unix)]
fn replace(command: &mut Command) {
    use std::os::unix::process::CommandExt;
    // Only returns if it fails; then the drivers' absence is reported later on.
    let _error = command.exec();
}

#[cfg(not(unix))]
fn replace(_: &mut Command) {}

#[cfg(test)]
mod tests {
    #[test]
    fn values_may_hold_equal_signs() {
        let pairs: Vec<_> = super::parse("A=1\n\nB=x=y z\n").collect();
        assert_eq!(pairs, [("A", "1"), ("B", "x=y z")], "split at the first");
    }
}
