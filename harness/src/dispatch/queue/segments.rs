//! One queue of all threads, in blocks of tasks: crossbeam's, for comparison. Adding is one
//! addition on a shared counter where listing 5 needs two compare-and-swaps and a node.

use crossbeam_queue::SegQueue;

use super::traits::{Queue, Worker};

/// An unbounded queue without locks, of blocks.
pub struct Segments<T>(SegQueue<T>);

impl<T> Segments<T> {
    /// An empty queue.
    pub const fn new() -> Self {
        Self(SegQueue::new())
    }
}

impl<T> Default for Segments<T> {
    fn default() -> Self {
        Self::new()
    }
}

impl<T: Send> Queue<T> for Segments<T> {
    type Worker<'q>
        = &'q Self
    where
        Self: 'q;

    fn deal(&self, tasks: impl IntoIterator<Item = T>) {
        tasks.into_iter().for_each(|task| self.0.push(task));
    }

    fn worker(&self, _thread: usize) -> &Self {
        self
    }
}

impl<T> Worker<T> for &Segments<T> {
    fn add(&mut self, task: T) {
        self.0.push(task);
    }

    fn get(&mut self) -> Option<T> {
        self.0.pop()
    }
}
