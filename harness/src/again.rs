//! Commands that replay again what a run replayed.

use crate::digest::leg_parts;
use crate::row::Row;
use crate::text::shell_word;

/// What a command must repeat of a run to see what it saw. Every word is ready for
/// a shell.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Again {
    /// Which legs took part, such as `--adapter llvmpipe`.
    pub legs: Vec<String>,
    /// What changes results, such as `--seed 7`.
    pub options: Vec<String>,
}

/// An option with its value, ready for a shell.
pub fn option(name: &str, value: &str) -> String {
    // A value that looks like an option would be taken for one.
    let between = if value.starts_with('-') { '=' } else { ' ' };
    format!("{name}{between}{}", shell_word(value))
}

impl Again {
    /// Replays a scene through all legs of the run. `argument` is its name, or its
    /// file outside the corpus. Nothing comes from the cache, as what agrees would.
    pub fn scene(&self, argument: &str) -> String {
        let afresh = vec!["--no-cache".to_owned()];
        command(&[&afresh, &self.legs, &self.options], argument)
    }

    /// Replays a scene through the legs of a row of it, which diverges and therefore
    /// is not in the cache.
    pub fn row(&self, row: &Row, argument: &str) -> String {
        command(&[&legs(row), &self.options], argument)
    }
}

/// What a user types to start the program: `cargo triptych`, or what `TRIPTYCH_AS` says,
/// as the script of a bundle does.
pub fn program() -> String {
    std::env::var("TRIPTYCH_AS").unwrap_or_else(|_| "cargo triptych".to_owned())
}

fn command(options: &[&Vec<String>], argument: &str) -> String {
    let program = program();
    let mut words = vec![program.as_str(), "replay --exact"];
    words.extend(options.iter().copied().flatten().map(String::as_str));
    if argument.starts_with('-') {
        words.push("--");
    }
    let argument = shell_word(argument);
    words.push(&argument);
    words.join(" ")
}

/// The options that choose just the legs of a row.
fn legs(row: &Row) -> Vec<String> {
    let (a, b) = (leg_parts(&row.a), leg_parts(&row.b));
    let mut words = Vec::new();
    // A path may carry options of its own, such as `compute --no-skip`.
    let path = |label: Option<_>| label.and_then(|p: &str| p.split(' ').next());
    let (path_a, path_b) = (path(a.2), path(b.2));
    for ((leg, adapter, _), path) in [(a, path_a), (b, path_b)] {
        // The spec and closed forms always take part.
        let leg = ["gpu", "embree"].contains(&leg).then_some(leg);
        for (name, value) in [("--leg", leg), ("--adapter", adapter), ("--path", path)] {
            let word = value.map(|value| option(name, value));
            words.extend(word.filter(|word| !words.contains(word)));
        }
    }
    words
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::digest::tests::row;

    fn again(options: &[&str]) -> Again {
        Again {
            legs: vec![option("--leg", "gpu"), option("--adapter", "-gl")],
            options: options.iter().map(|&o| o.to_owned()).collect(),
        }
    }

    #[test]
    fn a_row_names_each_of_its_legs_once() {
        let gpu = row(
            "abuffer/fan",
            "build",
            "spec",
            "gpu@llvmpipe (LLVM 15)/compute",
        );
        let expected = "cargo triptych replay --exact --leg gpu \
                        --adapter 'llvmpipe (LLVM 15)' --path compute --seed 7 abuffer/fan";
        assert_eq!(again(&["--seed 7"]).row(&gpu, "abuffer/fan"), expected);
        let plain = |a, b| again(&[]).row(&row("a", "cover", a, b), "a");
        let expected = "cargo triptych replay --exact --leg gpu --adapter x --path compute \
                        --path fragment a";
        let both = plain("gpu@x/compute", "gpu@x/fragment");
        assert_eq!(both, expected, "both paths");
        let expected = "cargo triptych replay --exact --leg gpu --adapter x --path compute a";
        let unskipped = plain("gpu@x/compute", "gpu@x/compute --no-skip");
        assert_eq!(unskipped, expected);
        let closed = plain("spec", "closed form");
        assert_eq!(closed, "cargo triptych replay --exact a");
        let expected = "cargo triptych replay --exact --leg gpu --adapter x --path compute \
                        --leg embree a";
        assert_eq!(plain("gpu@x/compute", "embree"), expected);
    }

    #[test]
    fn a_scene_repeats_all_that_was_asked_for() {
        let expected = "cargo triptych replay --exact --no-cache --leg gpu --adapter=-gl \
                        --gpu-from sort --no-skip 'my meshes/it'\\''s.obj'";
        let again = again(&["--gpu-from sort", "--no-skip"]);
        assert_eq!(again.scene("my meshes/it's.obj"), expected);
        let dash = Again::default().scene("-x.obj");
        assert_eq!(dash, "cargo triptych replay --exact --no-cache -- -x.obj");
    }
}
