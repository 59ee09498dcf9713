//! Which schedules are tried.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Which schedules are tried.
#[derive(Clone, Copy, Debug)]
pub enum How {
    /// All of them.
    All,
    /// All of them in which threads are interrupted that often at most.
    Bounded(usize),
    /// So many at random.
    Random(usize),
    /// So many, in which threads have priorities that change so often less one.
    Priorities(usize, usize),
}

/// How many schedules were begun; it outlives a panic in one.
#[derive(Clone, Default)]
pub struct Count(Arc<AtomicUsize>);

impl Count {
    /// One more.
    pub fn one(&self) {
        self.0.fetch_add(1, Ordering::Relaxed);
    }

    /// So far.
    pub fn get(&self) -> usize {
        self.0.load(Ordering::Relaxed)
    }
}

/// A model checker.
pub trait Checker: 'static {
    /// A thread of the model.
    type Thread<T>;
    /// Time, that the model's threads agree on.
    type Clock: Send + Sync + 'static;

    /// Runs a closure under each of the schedules; panics if it does.
    fn explore(how: How, count: &Count, model: impl Fn() + Send + Sync + 'static);
    /// Begins a thread.
    fn spawn<T: Send + 'static>(run: impl FnOnce() -> T + Send + 'static) -> Self::Thread<T>;
    /// Waits for its end.
    fn join<T>(thread: Self::Thread<T>) -> T;
    /// Lets others go first.
    fn pause();
    /// At zero.
    fn clock() -> Self::Clock;
    /// A moment, different from all others.
    fn now(clock: &Self::Clock) -> usize;
}
