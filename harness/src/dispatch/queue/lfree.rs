//! One queue of all threads, without locks (listing 5, after Michael and Scott): whenever
//! some are at work, one of them comes to an end, wherever the others were stopped.
//!
//! Adding takes two steps: the last node gets a next one, then `tail` is moved there. Between
//! them `tail` lags by one node, and whoever meets that helps to move it.
//!
//! `tail` never lags behind `head`: `head` is moved on from a node only by who saw `tail` at
//! another one. Whoever acquires that `head` sees such a `tail`, or a later one: so every change
//! of the two releases, and every read acquires.

use super::line::Line;
use super::node::Node;
use super::reclaim::{Epochs, Reclaim};
use super::sync::{AtomicPtr, Ordering};
use super::traits::{Queue, Worker};

/// An unbounded queue on compare-and-swap; `R` says when nodes are freed.
pub struct Lfree<T, R: Reclaim<Node<T>> = Epochs> {
    /// The sentinel.
    head: Line<AtomicPtr<Node<T>>>,
    /// The last node, or the one before.
    tail: Line<AtomicPtr<Node<T>>>,
    reclaim: R,
}

impl<T> Lfree<T> {
    /// An empty queue, whose nodes are freed by epochs.
    pub fn new() -> Self {
        Self::with(Epochs)
    }
}

impl<T, R: Reclaim<Node<T>>> Lfree<T, R> {
    /// An empty queue, whose nodes are freed by `reclaim`.
    pub fn with(reclaim: R) -> Self {
        let sentinel = reclaim.create(Node::sentinel());
        Self {
            head: Line(AtomicPtr::new(sentinel)),
            tail: Line(AtomicPtr::new(sentinel)),
            reclaim,
        }
    }
}

/// Listing 1. Whether `place` held `from`, and so holds `to` now.
fn swap<N>(place: &AtomicPtr<N>, from: *mut N, to: *mut N) -> bool {
    let swapped = place.compare_exchange(from, to, Ordering::Release, Ordering::Relaxed);
    swapped.is_ok()
}

impl<T: Send, R: Reclaim<Node<T>>> Lfree<T, R> {
    /// Puts a task behind all others.
    #[expect(unsafe_code, reason = "nodes are shared by pointers")]
    pub fn add(&self, task: T) {
        let node = self.reclaim.create(Node::of(task));
        let guard = self.reclaim.pin();
        loop {
            let last = self.reclaim.load(&guard, &self.tail.0);
            // SAFETY: `tail` is not behind `head`, so its node was not retired yet.
            let end = unsafe { self.reclaim.node(&guard, last) };
            let next = self.reclaim.load(&guard, &end.next);
            if last != self.tail.0.load(Ordering::Acquire) {
                continue;
            }
            if !next.is_null() {
                swap(&self.tail.0, last, next);
            } else if swap(&end.next, next, node) {
                // If this fails, someone has helped.
                swap(&self.tail.0, last, node);
                return;
            }
        }
    }

    /// Takes the first task; `None`: empty at this moment.
    #[expect(unsafe_code, reason = "nodes are shared by pointers")]
    pub fn get(&self) -> Option<T> {
        let guard = self.reclaim.pin();
        loop {
            let first = self.reclaim.load(&guard, &self.head.0);
            let last = self.reclaim.load(&guard, &self.tail.0);
            // SAFETY: it was the sentinel, so it was not retired yet.
            let sentinel = unsafe { self.reclaim.node(&guard, first) };
            let next = self.reclaim.load(&guard, &sentinel.next);
            if first != self.head.0.load(Ordering::Acquire) {
                continue;
            }
            if first == last {
                if next.is_null() {
                    return None;
                }
                // Else `head` would overtake `tail`, and this node be freed with `tail` on it.
                swap(&self.tail.0, last, next);
                continue;
            }
            debug_assert!(!next.is_null(), "only the last node has no next one");
            if swap(&self.head.0, first, next) {
                // SAFETY: `next` was in the queue while the guard was there. Whose swap moved
                // `head` onto it takes its value, and only one's did, after reading `next`,
                // which was written after the value.
                let value = unsafe { self.reclaim.node(&guard, next).take() };
                // SAFETY: the same one retires the sentinel, to which neither `head` leads any
                // more nor `tail`, that was seen behind it. Its value was taken, so that
                // dropping it only frees memory.
                unsafe { self.reclaim.retire(&guard, first) };
                return Some(value);
            }
        }
    }
}

impl<T> Default for Lfree<T> {
    fn default() -> Self {
        Self::new()
    }
}

impl<T, R: Reclaim<Node<T>>> Drop for Lfree<T, R> {
    #[expect(unsafe_code, reason = "nodes are shared by pointers")]
    fn drop(&mut self) {
        let first = self.head.0.load(Ordering::Relaxed);
        // SAFETY: no thread is left, and all nodes are the reclaimer's.
        unsafe { Node::free_chain(first, |node| self.reclaim.free(node)) };
    }
}

impl<T: Send, R: Reclaim<Node<T>> + Sync> Queue<T> for Lfree<T, R> {
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

impl<T: Send, R: Reclaim<Node<T>>> Worker<T> for &Lfree<T, R> {
    fn add(&mut self, task: T) {
        Lfree::add(self, task);
    }

    fn get(&mut self) -> Option<T> {
        Lfree::get(self)
    }
}
