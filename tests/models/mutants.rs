//! Defects planted in the sources of the queues, and the models that see them.
//!
//! Each must make its model fail, in the way that is stated; the model of the sources as
//! they are must pass. `build.rs` plants them.

#![expect(clippy::duplicate_mod, reason = "one text, under several checkers")]

#[macro_use]
mod support;
#[path = "trees/loom.rs"]
mod all;
#[path = "trees/shuttle.rs"]
mod some;
#[path = "mutants/table.rs"]
#[expect(dead_code, reason = "build.rs reads the rest")]
mod table;

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use support::how::{Count, How};
use support::kind::{self, Kind};
use support::script::Script;
use support::verdict::verdict;
use table::{MUTANTS, Model, Mutant};

type Run = fn(Kind, Script, How, &Count);

mod planted {
    //! The sources with a defect each.
    #![allow(warnings, reason = "defects are no style")]
    use super::Run;
    include!(concat!(env!("OUT_DIR"), "/mutants.rs"));
}

/// Schedules that shuttle tries.
const TRIES: usize = 5_000;

fn explored(run: Run, (kind, dealt, threads, timed): Model, how: How) -> (usize, Option<String>) {
    let script = Script {
        dealt,
        threads,
        timed,
        ..Script::PLAIN
    };
    verdict(move |count| run(kind, script, how, count))
}

/// What is wrong with one checker's verdict on a mutant, if anything.
fn judged(number: usize, checker: &str, how: How, dies: &str) -> Result<String, String> {
    let Mutant { name, model, .. } = &MUTANTS[number];
    let plain: Run = if checker == "loom" {
        all::run::run
    } else {
        some::run::run
    };
    let (schedules, said) = explored(plain, *model, how);
    if let Some(said) = said {
        return Err(format!("{name}: {checker} fails without it: {said}"));
    }
    assert!(schedules > 1, "{name}: a single schedule checks nothing");
    let (after, said) = explored(planted::run(number, checker), *model, how);
    let said = said.ok_or_else(|| format!("{name}: {checker} does not see it in {after}"))?;
    let first = said.lines().find(|line| line.contains(dies));
    let first = first.ok_or_else(|| format!("{name}: {checker}, after {after}: {said}"))?;
    Ok(format!(
        "{name} | {model:?} | {checker} after {after} of {schedules} | {first}"
    ))
}

fn both(number: usize) -> Vec<Result<String, String>> {
    let mutant = &MUTANTS[number];
    let loom = mutant.loom.map(|(bound, dies)| {
        let how = if bound == 0 {
            How::All
        } else {
            How::Bounded(bound)
        };
        judged(number, "loom", how, dies)
    });
    let shuttle = mutant.shuttle;
    let shuttle = shuttle.map(|dies| judged(number, "shuttle", How::Random(TRIES), dies));
    loom.into_iter().chain(shuttle).collect()
}

#[test]
fn every_mutant_is_seen() {
    let next = AtomicUsize::new(0);
    let lines = Mutex::new(Vec::new());
    thread::scope(|scope| {
        for _ in 0..thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(|| {
                loop {
                    let number = next.fetch_add(1, Ordering::Relaxed);
                    if number >= MUTANTS.len() {
                        break;
                    }
                    let judged = both(number);
                    assert!(!judged.is_empty(), "a mutant needs a model");
                    let mut lines = lines.lock().expect("nobody panics here");
                    lines.extend(judged.into_iter().map(|line| (number, line)));
                }
            });
        }
    });
    let mut lines = lines.into_inner().expect("nobody panics here");
    lines.sort_by_key(|(number, _)| *number);
    let mut wrong = Vec::new();
    for (_, line) in lines {
        match line {
            Ok(line) => println!("{line}"),
            Err(line) => wrong.push(line),
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
