//! One queue of all threads, under two locks (listing 4): who adds and who gets do not wait
//! for each other.

use super::line::Line;
use super::node::Node;
use super::sync::{Mutex, Ordering, create, free};
use super::traits::{Queue, Worker};

/// Why a lock is never found poisoned.
const SOUND: &str = "nothing panics under the lock";

/// An unbounded queue with a lock for adding and one for getting.
pub struct Lock<T> {
    /// The sentinel.
    head: Line<Mutex<*mut Node<T>>>,
    /// The last node, which may be the sentinel.
    tail: Line<Mutex<*mut Node<T>>>,
}

// SAFETY: the nodes are the queue's own, what is reached by `head` or `tail` alone is touched
// under its lock, what is reached by both is `next`, an atomic; and values only move through.
#[expect(unsafe_code, reason = "nodes are shared by pointers")]
unsafe impl<T: Send> Send for Lock<T> {}
// SAFETY: as above.
#[expect(unsafe_code, reason = "nodes are shared by pointers")]
unsafe impl<T: Send> Sync for Lock<T> {}

impl<T> Lock<T> {
    /// An empty queue.
    pub fn new() -> Self {
        let sentinel = create(Node::sentinel());
        Self {
            head: Line(Mutex::new(sentinel)),
            tail: Line(Mutex::new(sentinel)),
        }
    }

    /// Puts a task behind all others.
    #[expect(unsafe_code, reason = "nodes are shared by pointers")]
    pub fn add(&self, task: T) {
        let node = create(Node::of(task));
        let mut tail = self.tail.0.lock().expect(SOUND);
        let last = *tail;
        // SAFETY: the last node is not freed, as `get` frees only nodes that have a next one.
        // From here on this one has, and it is not touched again. In an empty queue `get`
        // reads here at the same time: hence an atomic, that carries the node's contents over.
        unsafe { &*last }.next.store(node, Ordering::Release);
        *tail = node;
    }

    /// Takes the first task; `None`: empty at this moment.
    #[expect(unsafe_code, reason = "nodes are shared by pointers")]
    pub fn get(&self) -> Option<T> {
        let mut head = self.head.0.lock().expect(SOUND);
        let first = *head;
        // SAFETY: whoever frees the sentinel has moved `head` on before, under this lock.
        let next = unsafe { &*first }.next.load(Ordering::Acquire);
        if next.is_null() {
            return None;
        }
        *head = next;
        // Under the lock still, as the next one to get frees this node.
        // SAFETY: it was no sentinel before, so nobody has taken its value; it was written
        // before `next` was.
        let value = unsafe { (*next).take() };
        drop(head);
        // SAFETY: nothing leads to it now: neither `head` nor `tail`, which was moved on, or is
        // about to be by an `add` that does not look back, once `next` was there.
        unsafe { free(first) };
        Some(value)
    }
}

impl<T> Default for Lock<T> {
    fn default() -> Self {
        Self::new()
    }
}

impl<T> Drop for Lock<T> {
    #[expect(unsafe_code, reason = "nodes are shared by pointers")]
    fn drop(&mut self) {
        // A thread that panicked elsewhere may have poisoned it; the chain is whole all the same.
        let head = self.head.0.lock();
        let first = *head.unwrap_or_else(std::sync::PoisonError::into_inner);
        // SAFETY: no thread is left, and all nodes are `create`'s.
        unsafe { Node::free_chain(first, |node| free(node)) };
    }
}

impl<T: Send> Queue<T> for Lock<T> {
    type Worker<'q>
        = &'q Self
    where
        Self: 'q;

    fn deal(&self, tasks: impl IntoIterator<Item = T>) {
        tasks.into_iter().for_each(|task| self.add(task));
    }

    fn worker(&self, _thread: usize) -> &Self {
        self
    }
}

impl<T: Send> Worker<T> for &Lock<T> {
    fn add(&mut self, task: T) {
        Lock::add(self, task);
    }

    fn get(&mut self) -> Option<T> {
        Lock::get(self)
    }
}
