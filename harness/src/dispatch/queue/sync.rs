//! All that the queues share between threads, under names that a model checker can take over.

pub(super) use std::sync::Mutex;
pub(super) use std::sync::atomic::{AtomicPtr, AtomicUsize, Ordering};

/// A cell whose accesses have a beginning and an end, which a model checker can watch.
pub(super) struct UnsafeCell<T>(std::cell::UnsafeCell<T>);

impl<T> UnsafeCell<T> {
    pub(super) const fn new(value: T) -> Self {
        Self(std::cell::UnsafeCell::new(value))
    }

    /// Lends a pointer to write through; that nobody else has one is the caller's care.
    pub(super) fn with_mut<R>(&self, write: impl FnOnce(*mut T) -> R) -> R {
        write(self.0.get())
    }
}

/// Memory for a node, to be given back by [`free`].
pub(super) fn create<N>(node: N) -> *mut N {
    Box::into_raw(Box::new(node))
}

/// Drops a node and gives its memory back.
///
/// # Safety
///
/// It is [`create`]'s, this happens once, and nobody reads it any more.
#[expect(unsafe_code, reason = "nodes are shared by pointers")]
pub(super) unsafe fn free<N>(node: *mut N) {
    // SAFETY: it came from a box, and the caller is its last owner.
    drop(unsafe { Box::from_raw(node) });
}
