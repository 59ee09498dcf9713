//! Sweeps of a family, run and written down.

use std::io::Write;
use std::path::Path;
use std::time::Instant;

use super::super::Verdict;
use super::super::paths::OnPaths;
use super::super::run_info::run_info;
use super::files::{Files, legs};
use crate::bench::Machine;
use crate::embree;
use crate::output::stdout;
use crate::replay::Options;
use crate::replay::gpu::Adapter;
use crate::stress::{Extremes, Lines, Sweep, Wrong, select, write};

/// Runs the sweeps that the patterns select, all of them without one.
pub(super) fn run<E: Extremes>(
    patterns: &[String],
    on: &OnPaths,
    files: &Files,
) -> anyhow::Result<Verdict> {
    let start = Instant::now();
    let sweeps = select(E::sweeps(), patterns).map_err(anyhow::Error::msg)?;
    let name = format!("stress{}", E::ENDING);
    let folder = files.ready(&name)?;
    let library = embree::library()?;
    let found = on.usable()?;
    let adapters = found.open;
    let options = Options {
        broken: found.broken,
        paths: on.paths(),
        ..Options::default()
    };
    let scenes = folder.join(format!("scenes{}", E::ENDING));
    let (all, mut wrong) = each::<E>(&sweeps, &scenes, &adapters, &options)?;
    wrong.extend(together::<E>(&all, patterns.is_empty()));
    let seconds = start.elapsed().as_secs_f64();
    let info = run_info(&adapters, &options.broken, Some(&library), seconds);
    let machine = Machine::here(&adapters).slug;
    let stem = folder.join(format!("{name}-{}-{machine}", info.date));
    let written = write(&stem, &E::pages(&info, &sweeps, &all, &wrong));
    files.json(on.again(), all.iter().map(E::rows), seconds)?;
    files.end(written, &folder, &wrong)
}

/// Every step of every sweep, printed as it is done.
fn each<E: Extremes>(
    sweeps: &[Sweep<E::Shot>],
    scenes: &Path,
    adapters: &[Adapter],
    options: &Options,
) -> anyhow::Result<(Vec<E::Measured>, Vec<Wrong>)> {
    let mut out = stdout();
    let mut legs = legs(adapters, options);
    legs.extend(E::more_legs());
    let (mut all, mut wrong) = (Vec::new(), Vec::new());
    for sweep in sweeps {
        writeln!(out, "\n{}: {}", sweep.name, sweep.axis)?;
        writeln!(out, "{}", E::Table::line(&E::Table::names()))?;
        let mut table = E::Table::default();
        for step in sweep.steps() {
            let measured = E::run(sweep, &step, scenes, adapters, options)?;
            writeln!(out, "{}", E::Table::line(&table.cells(&measured)))?;
            wrong.extend(E::judge(&measured, &legs));
            all.push(measured);
        }
        for note in table.notes() {
            writeln!(out, "  {note}")?;
        }
    }
    Ok((all, wrong))
}

/// What does not hold of all steps; how near they come to bounds is asked of all sweeps alone.
fn together<E: Extremes>(all: &[E::Measured], is_whole: bool) -> Vec<Wrong> {
    let mut wrong = E::unlike(all);
    if is_whole {
        wrong.extend(E::useless(all));
    }
    wrong
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::InputError;
    use crate::report::RunInfo;
    use crate::row::Row;
    use crate::stress::{Pages, Step};

    /// A family of which nothing holds.
    struct Wrongs;

    #[derive(Default)]
    struct Numbers;

    impl Lines for Numbers {
        type Measured = f64;
        const COLUMNS: &'static [(&'static str, usize)] = &[("step", 4)];
        const ABOVE: &'static str = "numbers";

        fn cells(&mut self, measured: &f64) -> Vec<String> {
            vec![measured.to_string()]
        }

        fn notes(&self) -> Vec<String> {
            Vec::new()
        }
    }

    fn wrong(what: &str) -> Vec<Wrong> {
        let name = String::new;
        vec![Wrong {
            sweep: name(),
            step: name(),
            stage: name(),
            leg: name(),
            what: what.to_owned(),
        }]
    }

    fn two() -> Vec<Step<()>> {
        let step = |value: f64| Step {
            label: value.to_string(),
            value,
            shot: (),
        };
        vec![step(1.0), step(2.0)]
    }

    impl Extremes for Wrongs {
        type Shot = ();
        type Measured = f64;
        type Table = Numbers;
        const ENDING: &'static str = "-wrongs";

        fn sweeps() -> Vec<Sweep<()>> {
            vec![Sweep::new("one", "a number", two)]
        }

        fn more_legs() -> Vec<String> {
            vec!["more".to_owned()]
        }

        fn run(
            _: &Sweep<()>,
            step: &Step<()>,
            _: &Path,
            _: &[Adapter],
            _: &Options,
        ) -> Result<f64, InputError> {
            Ok(step.value)
        }

        fn judge(measured: &f64, legs: &[String]) -> Vec<Wrong> {
            wrong(&format!("{measured}: {}", legs.join(" ")))
        }

        fn unlike(all: &[f64]) -> Vec<Wrong> {
            wrong(&format!("{} are unlike", all.len()))
        }

        fn useless(all: &[f64]) -> Vec<Wrong> {
            wrong(&format!("{} are useless", all.len()))
        }

        fn rows(_: &f64) -> (&Path, &[Row]) {
            (Path::new(""), &[])
        }

        fn pages(_: &RunInfo, _: &[Sweep<()>], _: &[f64], _: &[Wrong]) -> Pages {
            Pages {
                page: String::new(),
                table: String::new(),
            }
        }
    }

    #[test]
    fn what_does_not_hold_is_told_of_each_step_and_of_all() {
        let run = each::<Wrongs>(&Wrongs::sweeps(), Path::new(""), &[], &Options::default());
        let (all, judged) = run.expect("nothing is written");
        assert_eq!(all, [1.0, 2.0]);
        let words = |wrong: Vec<Wrong>| wrong.into_iter().map(|w| w.what).collect::<Vec<_>>();
        assert_eq!(words(judged), ["1: embree more", "2: embree more"]);
        assert_eq!(words(together::<Wrongs>(&all, false)), ["2 are unlike"]);
        let whole = ["2 are unlike", "2 are useless"];
        assert_eq!(words(together::<Wrongs>(&all, true)), whole);
    }
}
