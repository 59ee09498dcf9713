//! The report in a browser: real clicks and keys in a headless Chromium, on the report
//! of a run whose kernel has a planted defect.
//!
//! Without a Chromium on `PATH` every test is ignored, and says so; asked for all the
//! same (`--include-ignored`), it fails.

mod browser;
mod place;
mod tests;

use std::process::ExitCode;
use std::sync::{Arc, OnceLock};

use browser::{Browser, installed};
use libtest_mimic::{Arguments, Failed, Trial};
use place::Place;

/// What a test does with a browser and the report.
type Test = fn(&mut Browser, &Place);

fn main() -> ExitCode {
    let arguments = Arguments::from_args();
    let program = installed();
    if program.is_none() && !arguments.list {
        eprintln!("the tests of the report's page are ignored: no chromium is on PATH");
    }
    let place = Arc::new(OnceLock::new());
    let trials = tests::ALL
        .into_iter()
        .map(|(name, test): (&'static str, Test)| {
            let (place, program) = (place.clone(), program.clone());
            let missing = program.is_none();
            let run = move || {
                let program = program.ok_or_else(|| Failed::from("no chromium is on PATH"))?;
                let place = place.get_or_init(Place::new);
                let mut browser = Browser::start(&program, name);
                test(&mut browser, place);
                match browser.complaints.is_empty() {
                    true => Ok(()),
                    false => Err(browser.complaints.join("\n").into()),
                }
            };
            Trial::test(name, run).with_ignored_flag(missing)
        });
    let outcome = libtest_mimic::run(&arguments, trials.collect());
    if let Some(place) = place.get() {
        place.remove();
    }
    outcome.exit_code()
}
