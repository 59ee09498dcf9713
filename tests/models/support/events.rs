//! What is passed through a queue, and what threads saw of it.

use std::sync::atomic::{AtomicUsize, Ordering};

/// A task. Its number says who added it and when: thread times [`EACH`] plus a count. It owns
/// nothing, so that even dropping it twice does no harm but being counted.
#[derive(Debug)]
pub struct Item {
    /// Its number.
    pub id: usize,
    dropped: &'static [AtomicUsize],
}

/// Tasks of one thread, at most.
pub const EACH: usize = 16;

/// How often each task was dropped.
pub struct Lives(Box<[AtomicUsize]>);

impl Lives {
    /// Of that many threads' tasks.
    pub fn new(threads: usize) -> Self {
        Self((0..threads * EACH).map(|_| AtomicUsize::new(0)).collect())
    }

    /// A new task; each number once.
    pub fn item(&'static self, id: usize) -> Item {
        let dropped = &self.0;
        Item { id, dropped }
    }

    /// Nobody's task was forgotten, and nobody's dropped twice.
    pub fn check(&self, ids: impl IntoIterator<Item = usize>) {
        for id in ids {
            let times = self.0[id].load(Ordering::Relaxed);
            assert_eq!(times, 1, "task {id} was dropped {times} times");
        }
    }
}

impl Drop for Item {
    fn drop(&mut self) {
        self.dropped[self.id].fetch_add(1, Ordering::Relaxed);
    }
}

/// What a thread did.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Act {
    /// Added a task.
    Add(usize),
    /// Got a task, or found the queue empty.
    Get(Option<usize>),
}

/// An operation, and when it began and ended; both zero if nobody looked at a clock.
#[derive(Clone, Copy, Debug)]
pub struct Event {
    /// Who.
    pub thread: usize,
    /// What.
    pub act: Act,
    /// The clock before.
    pub from: usize,
    /// The clock after.
    pub to: usize,
}
