//! The queue of one thread, which all others must equal.

use std::collections::VecDeque;

/// Rays of a task (paper section 4: "a set of 20 rays").
pub const TASK_RAYS: usize = 20;

/// First in, first out: what is added is got once, in the order in which it was added, and
/// nothing is got only while nothing is there (paper section 4). Queues of many threads behave as if each of
/// their operations happened at one moment on this one.
#[derive(Clone, Debug)]
pub struct Fifo<T> {
    tasks: VecDeque<T>,
}

impl<T> Default for Fifo<T> {
    fn default() -> Self {
        Self {
            tasks: VecDeque::new(),
        }
    }
}

impl<T> Fifo<T> {
    /// Puts a task behind all others (`addRays`).
    pub fn add(&mut self, task: T) {
        self.tasks.push_back(task);
    }

    /// Takes the foremost task; `None` if there is none (`getRays`).
    pub fn get(&mut self) -> Option<T> {
        self.tasks.pop_front()
    }
}
