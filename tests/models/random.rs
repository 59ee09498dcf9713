//! Random schedules of three to eight threads, always the same ones (shuttle), against a
//! plain queue's answers.

#[macro_use]
mod support;
#[path = "trees/shuttle.rs"]
mod tree;

use support::how::{Count, How};
use support::kind::Kind;
use support::script::Script;

/// Tasks dealt, and what threads do.
const SCRIPTS: [(usize, &[&str]); 5] = [
    (1, &["aag", "gga", "aga"]),
    (0, &["aaa", "aaa", "ggg", "ggg"]),
    (4, &["ga", "ga", "ga", "ga", "ga"]),
    (2, &["aaaaaaaa", "gggggggg", "agagagag", "gagagaga", "aagg"]),
    (3, &["aag", "aag", "agg", "agg", "gag", "gag", "gga", "gga"]),
];

const TRIES: usize = 2_000;

fn explore(kind: Kind) {
    for (dealt, threads) in SCRIPTS {
        let script = Script {
            dealt,
            threads,
            timed: true,
            ..Script::PLAIN
        };
        let count = Count::default();
        for how in [How::Random(TRIES), How::Priorities(TRIES, 3)] {
            tree::run::run(kind, script, how, &count);
        }
        println!("{kind:?} {dealt} {threads:?}: {}", count.get());
        assert_eq!(count.get(), 2 * TRIES, "not all were tried");
    }
}

#[test]
fn lock() {
    explore(Kind::Lock);
}

#[test]
fn lfree() {
    explore(Kind::Held);
}

#[test]
fn lfree_that_frees_early() {
    explore(Kind::Tracked);
}

#[test]
fn lfree_of_epochs() {
    explore(Kind::Epochs);
}

#[test]
fn local() {
    explore(Kind::Local);
}

#[test]
fn frames() {
    for threads in [3, 8] {
        let script = Script {
            threads: &[""; 8][..threads],
            ..Script::PLAIN
        };
        let count = Count::default();
        tree::run::run(Kind::Frame, script, How::Random(TRIES), &count);
        println!("frame, counted, {threads} threads: {}", count.get());
        assert_eq!(count.get(), TRIES, "not all were tried");
    }
}
