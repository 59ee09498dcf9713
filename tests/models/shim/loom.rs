//! The queues' atomics, locks, cells and memory, as loom has them.

pub use loom::sync::Mutex;
pub use loom::sync::atomic::{AtomicUsize, Ordering};

pub use crate::support::heap::{create, free};
use crate::support::how::{Checker, Count, How};

checked!(loom::sync::atomic::AtomicPtr, loom::cell::UnsafeCell);

/// Loom: all schedules that differ, and what weak memory can show in each.
pub struct Shim;

impl Checker for Shim {
    type Thread<T> = loom::thread::JoinHandle<T>;
    type Clock = AtomicUsize;

    fn explore(how: How, count: &Count, model: impl Fn() + Send + Sync + 'static) {
        let mut builder = loom::model::Builder::new();
        builder.preemption_bound = match how {
            How::All => None,
            How::Bounded(bound) => Some(bound),
            How::Random(_) | How::Priorities(..) => unreachable!("loom tries all"),
        };
        builder.log = false;
        let count = count.clone();
        builder.check(move || {
            count.one();
            model();
        });
    }

    fn spawn<T: Send + 'static>(run: impl FnOnce() -> T + Send + 'static) -> Self::Thread<T> {
        loom::thread::spawn(run)
    }

    fn join<T>(thread: Self::Thread<T>) -> T {
        thread.join().expect("a panic ends the model")
    }

    fn pause() {
        loom::thread::yield_now();
    }

    fn clock() -> AtomicUsize {
        AtomicUsize::new(0)
    }

    fn now(clock: &AtomicUsize) -> usize {
        clock.fetch_add(1, Ordering::AcqRel)
    }
}
