//! A thread that stops for good inside an operation, before each of its accesses to what is
//! shared, and whether others still come to an end.

#[path = "trees/stopped.rs"]
mod tree;

use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::mpsc::channel;

use tree::lfree::Lfree;
use tree::lock::Lock;
use tree::sync::{Waits, doomed};
use tree::traits::{Queue, Worker};

/// Tasks that are there before.
const DEALT: usize = 3;
/// The stopped thread's.
const ITS: usize = 1000;
/// What another thread adds and gets after.
const AFTER: usize = 100;

/// What the stopped thread was about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Act {
    Add,
    Get,
}

/// Whether it ends; false if it would wait for ever.
fn ends(run: impl FnOnce()) -> bool {
    match catch_unwind(AssertUnwindSafe(run)) {
        Ok(()) => true,
        Err(panic) if panic.is::<Waits>() => false,
        Err(panic) => resume_unwind(panic),
    }
}

/// What others could do after a thread was stopped.
struct After {
    adds: bool,
    gets: bool,
    got: Vec<usize>,
}

/// Stops a thread before one of its accesses; `None` if it has not so many.
fn after(queue: impl Queue<usize> + 'static, act: Act, access: usize) -> Option<After> {
    // The stopped thread has it for ever.
    let queue = &*Box::leak(Box::new(queue));
    queue.deal(0..DEALT);
    let (stops, stopped) = channel();
    doomed(access, stops, move || {
        let mut worker = queue.worker(0);
        match act {
            Act::Add => worker.add(ITS),
            Act::Get => drop(worker.get()),
        }
    });
    if !stopped.recv().expect("it stops or ends") {
        return None;
    }
    let mut worker = queue.worker(1);
    let mut got = Vec::new();
    let adds = ends(|| (0..AFTER).for_each(|task| worker.add(DEALT + task)));
    let gets = ends(|| got.extend(std::iter::from_fn(|| worker.get())));
    Some(After { adds, gets, got })
}

#[test]
fn without_locks_all_others_go_on() {
    for act in [Act::Add, Act::Get] {
        let mut accesses = 0;
        while let Some(After { adds, gets, got }) = after(Lfree::new(), act, accesses) {
            assert!(adds && gets, "{act:?} stopped after {accesses} accesses");
            // Everything that was completed, in order; of what was not, all or nothing.
            let mut rest = got.clone();
            rest.retain(|task| *task != ITS);
            let missing = usize::from(rest.first() == Some(&1));
            let all: Vec<usize> = (missing..DEALT + AFTER).collect();
            assert_eq!(rest, all, "{act:?} stopped after {accesses} accesses");
            assert!(missing == 0 || act == Act::Get, "adding took a task away");
            let its = got.iter().position(|task| *task == ITS);
            assert!(
                its.is_none_or(|at| at == DEALT && act == Act::Add),
                "its task came {its:?}, not after those that were there"
            );
            println!("{act:?} stopped after {accesses}: its task taken {missing}, added {its:?}");
            accesses += 1;
        }
        println!("{act:?} has {accesses} accesses");
        assert!(accesses > 4, "{act:?} has only {accesses} accesses");
    }
}

#[test]
fn with_locks_one_stops_all() {
    for act in [Act::Add, Act::Get] {
        let mut accesses = 0;
        let mut waits = 0;
        while let Some(after) = after(Lock::new(), act, accesses) {
            println!(
                "{act:?} stopped after {accesses}: others add {}, get {}",
                after.adds, after.gets
            );
            // From when the lock is had until it is given back.
            let (own, other) = match act {
                Act::Add => (after.adds, after.gets),
                Act::Get => (after.gets, after.adds),
            };
            assert_eq!(own, accesses == 0, "{act:?} stopped after {accesses}");
            assert!(other, "the other lock is not concerned");
            waits += usize::from(!own);
            accesses += 1;
        }
        println!("{act:?} has {accesses} accesses, others wait for ever after {waits}");
        assert!(waits > 0, "nobody ever waits");
    }
}
