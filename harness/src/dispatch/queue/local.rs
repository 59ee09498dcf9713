//! A queue of each thread's own (section 4.2): nothing is shared while a frame is made, and
//! nothing is balanced.

use std::collections::VecDeque;
use std::mem;

use super::line::Line;
use super::sync::Mutex;
use super::traits::{Queue, Worker};

/// Why a lock is never found poisoned.
const SOUND: &str = "nothing panics under the lock";

/// A queue per thread. Tasks are dealt to them in turn; what a thread adds, it gets itself.
pub struct Local<T> {
    /// What each thread begins with.
    slots: Box<[Line<Mutex<VecDeque<T>>>]>,
    /// Whose turn is next.
    turn: Mutex<usize>,
}

impl<T> Local<T> {
    /// Empty queues of so many threads.
    pub fn new(threads: usize) -> Self {
        assert!(threads > 0, "tasks need a thread");
        let slots = (0..threads).map(|_| Line(Mutex::new(VecDeque::new())));
        Self {
            slots: slots.collect(),
            turn: Mutex::new(0),
        }
    }
}

impl<T: Send> Queue<T> for Local<T> {
    type Worker<'q>
        = Own<'q, T>
    where
        Self: 'q;

    fn deal(&self, tasks: impl IntoIterator<Item = T>) {
        let mut turn = self.turn.lock().expect(SOUND);
        for task in tasks {
            let mut slot = self.slots[*turn].0.lock().expect(SOUND);
            slot.push_back(task);
            *turn = (*turn + 1) % self.slots.len();
        }
    }

    fn worker(&self, thread: usize) -> Own<'_, T> {
        let slot = &self.slots[thread].0;
        let tasks = mem::take(&mut *slot.lock().expect(SOUND));
        Own { tasks, slot }
    }
}

/// A thread's queue, out of its slot for as long as the thread works with it.
pub struct Own<'q, T> {
    tasks: VecDeque<T>,
    slot: &'q Mutex<VecDeque<T>>,
}

impl<T> Worker<T> for Own<'_, T> {
    fn add(&mut self, task: T) {
        self.tasks.push_back(task);
    }

    fn get(&mut self) -> Option<T> {
        self.tasks.pop_front()
    }
}

impl<T> Drop for Own<'_, T> {
    /// Back into the slot: the memory serves the next frame, and what was not done is not lost.
    fn drop(&mut self) {
        if let Ok(mut slot) = self.slot.lock() {
            // Dealt meanwhile.
            self.tasks.append(&mut slot);
            *slot = mem::take(&mut self.tasks);
        }
    }
}
