//! All schedules of few threads, and in each all that weak memory can show (loom).
//!
//! Two threads are tried without a bound wherever that is a matter of seconds; else threads
//! are interrupted so often at most as is said. A model is run without a clock, so that nothing
//! orders memory but the queue, and with one, against a plain queue's answers.

#[macro_use]
mod support;
#[path = "trees/loom.rs"]
mod tree;

use support::how::{Count, How};
use support::kind::Kind;
use support::script::Script;
use tree::frame::{self, Rule};

/// Tasks dealt, what threads do, and the bounds: without a clock, and with one. Zero: none.
type Row = (usize, &'static [&'static str], usize, usize);

/// Two threads: one adds and one gets, both add, both get, each does both.
const PAIRS: [Row; 7] = [
    (0, &["a", "a"], 0, 0),
    (0, &["aa", "gg"], 0, 4),
    (2, &["g", "g"], 0, 0),
    (3, &["gg", "g"], 0, 0),
    (1, &["ag", "ga"], 0, 4),
    (0, &["ag", "ag"], 0, 3),
    (0, &["aa", "aa"], 4, 3),
];

/// Two that do little, so that all can be tried where nodes are freed, too.
const SHORT: [Row; 5] = [
    (0, &["a", "a"], 0, 0),
    (0, &["a", "g"], 0, 0),
    (1, &["a", "g"], 0, 0),
    (2, &["g", "g"], 0, 0),
    (0, &["a", "ga"], 0, 4),
];

/// Three.
const TRIOS: [Row; 6] = [
    (0, &["a", "a", "a"], 2, 2),
    (1, &["a", "a", "g"], 2, 2),
    (1, &["a", "g", "g"], 2, 2),
    (2, &["g", "g", "g"], 3, 2),
    (0, &["aa", "g", "g"], 2, 2),
    (0, &["ag", "a", "g"], 2, 2),
];

fn how(bound: usize) -> How {
    match bound {
        0 => How::All,
        bound => How::Bounded(bound),
    }
}

/// Runs a table for one queue; `cap` bounds what is not bounded, where nodes being freed
/// make more of everything.
fn explore(kind: Kind, rows: &[Row], cap: Option<usize>) {
    for (dealt, threads, raw, timed) in rows {
        for (timed, bound) in [(false, *raw), (true, *timed)] {
            let bound = match cap {
                Some(cap) if bound == 0 || bound > cap => cap,
                _ => bound,
            };
            let script = Script {
                dealt: *dealt,
                threads,
                timed,
                ..Script::PLAIN
            };
            let count = Count::default();
            tree::run::run(kind, script, how(bound), &count);
            let schedules = count.get();
            let clock = if timed { "clock" } else { "no clock" };
            println!(
                "{kind:?} {dealt} {threads:?} {clock} {:?}: {schedules}",
                how(bound)
            );
            assert!(
                schedules > 1 || kind == Kind::Local,
                "a single schedule checks nothing"
            );
        }
    }
}

#[test]
fn lock_of_two() {
    explore(Kind::Lock, &PAIRS, None);
}

#[test]
fn lock_of_three() {
    explore(Kind::Lock, &TRIOS, None);
}

#[test]
fn lfree_of_two() {
    explore(Kind::Held, &PAIRS, None);
}

#[test]
fn lfree_of_three() {
    explore(Kind::Held, &TRIOS, None);
}

#[test]
fn lfree_that_frees_early_of_two() {
    explore(Kind::Tracked, &SHORT, None);
    explore(Kind::Tracked, &PAIRS, Some(3));
}

#[test]
fn lfree_that_frees_early_of_three() {
    explore(Kind::Tracked, &TRIOS, Some(2));
}

/// As it is shipped; when epochs free is not the checker's to decide.
#[test]
fn lfree_of_epochs() {
    explore(Kind::Epochs, &PAIRS, Some(2));
}

/// Threads meet at the locks of their slots alone.
#[test]
fn local() {
    explore(Kind::Local, &PAIRS, None);
    explore(Kind::Local, &TRIOS, None);
}

/// Of two threads: waiting for each other's tasks, three have a hundred times the schedules.
#[test]
fn a_frame_of_counted_tasks_is_done_when_it_is_over() {
    let count = Count::default();
    let early = frame::run(Rule::Counted, 2, How::Bounded(2), &count);
    println!("frame, counted: {}", count.get());
    assert!(count.get() > 1, "a single schedule checks nothing");
    assert_eq!(early, 0, "a thread left early");
}

/// Listing 2's rule: the tasks are done, but not by all.
#[test]
fn a_frame_that_ends_when_empty_loses_threads() {
    let count = Count::default();
    let early = frame::run(Rule::Empty, 2, How::Bounded(2), &count);
    println!(
        "frame, empty: a thread left early in {early} of {}",
        count.get()
    );
    assert!(early > 0, "no thread left early");
}
