//! A queue of each thread's own that others steal from: crossbeam's, for comparison. It is what
//! [`Local`](super::local::Local) lacks: threads without work take some of those that have.
//!
//! Tasks are dealt to one shared queue, from which threads help themselves by batches. In the
//! order of one thread's own queue the oldest come first, for the thread and for thieves;
//! over all threads there is no order.

use std::iter;

use crossbeam_deque::{Injector, Steal, Stealer, Worker as Deque};

use super::sync::Mutex;
use super::traits::{Queue, Worker};

/// Why a lock is never found poisoned.
const SOUND: &str = "nothing panics under the lock";

/// A queue per thread, and one of what was dealt.
pub struct Stealing<T> {
    dealt: Injector<T>,
    /// Each thread's own, while no thread works with it.
    slots: Box<[Mutex<Option<Deque<T>>>]>,
    stealers: Box<[Stealer<T>]>,
}

impl<T> Stealing<T> {
    /// Empty queues of so many threads.
    pub fn new(threads: usize) -> Self {
        assert!(threads > 0, "tasks need a thread");
        let own: Vec<Deque<T>> = iter::repeat_with(Deque::new_fifo).take(threads).collect();
        Self {
            dealt: Injector::new(),
            stealers: own.iter().map(Deque::stealer).collect(),
            slots: own.into_iter().map(|own| Mutex::new(Some(own))).collect(),
        }
    }
}

impl<T: Send> Queue<T> for Stealing<T> {
    type Worker<'q>
        = Thief<'q, T>
    where
        Self: 'q;

    fn deal(&self, tasks: impl IntoIterator<Item = T>) {
        tasks.into_iter().for_each(|task| self.dealt.push(task));
    }

    fn worker(&self, thread: usize) -> Thief<'_, T> {
        let own = self.slots[thread].lock().expect(SOUND).take();
        Thief {
            own: Some(own.expect("a thread asks once a frame")),
            queue: self,
            thread,
        }
    }
}

/// A thread's queue, out of its slot for as long as the thread works with it.
pub struct Thief<'q, T> {
    /// There until it is dropped.
    own: Option<Deque<T>>,
    queue: &'q Stealing<T>,
    thread: usize,
}

impl<T> Thief<'_, T> {
    fn own(&self) -> &Deque<T> {
        self.own.as_ref().expect("it is there until it is dropped")
    }

    /// What was dealt first, then from the others, beginning with the neighbour, so that
    /// not all fall upon the same one.
    fn steal(&self) -> Steal<T> {
        let (before, after) = self.queue.stealers.split_at(self.thread);
        let others = after.iter().skip(1).chain(before);
        let dealt = self.queue.dealt.steal_batch_and_pop(self.own());
        dealt.or_else(|| {
            others
                .map(|other| other.steal_batch_and_pop(self.own()))
                .collect()
        })
    }
}

impl<T> Worker<T> for Thief<'_, T> {
    fn add(&mut self, task: T) {
        self.own().push(task);
    }

    fn get(&mut self) -> Option<T> {
        let own = self.own().pop();
        // A theft that another one came between is tried again.
        own.or_else(|| {
            iter::repeat_with(|| self.steal())
                .find(|stolen| !stolen.is_retry())
                .and_then(Steal::success)
        })
    }
}

impl<T> Drop for Thief<'_, T> {
    /// Back into the slot, with what was not done.
    fn drop(&mut self) {
        if let Ok(mut slot) = self.queue.slots[self.thread].lock() {
            *slot = self.own.take();
        }
    }
}
