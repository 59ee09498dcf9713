//! The links of a chain, of which two of the queues are made.
//!
//! The first node of a chain is a sentinel: its value was never there, or is taken already.
//! So a queue is empty if its sentinel has no next node, and no node needs to be the first and
//! the last at once.

use super::sync::{AtomicPtr, Ordering, UnsafeCell};

/// One link of a chain.
pub struct Node<T> {
    /// Null as long as this is the last; written once.
    pub(super) next: AtomicPtr<Self>,
    value: UnsafeCell<Option<T>>,
}

impl<T> Node<T> {
    /// The node that an empty queue consists of.
    pub(super) fn sentinel() -> Self {
        Self::new(None)
    }

    /// A node that nobody knows yet.
    pub(super) fn of(value: T) -> Self {
        Self::new(Some(value))
    }

    fn new(value: Option<T>) -> Self {
        Self {
            next: AtomicPtr::new(std::ptr::null_mut()),
            value: UnsafeCell::new(value),
        }
    }

    /// Moves the value out, which makes a sentinel of this node.
    ///
    /// # Safety
    ///
    /// No other thread takes it, and its being written happened before.
    #[expect(unsafe_code, reason = "nodes are shared by pointers")]
    pub(super) unsafe fn take(&self) -> T {
        // SAFETY: nobody else has a pointer into the cell meanwhile, says the caller.
        let value = self.value.with_mut(|value| unsafe { (*value).take() });
        value.expect("a value is taken once, by who made its node the sentinel")
    }

    /// Frees a chain from its first node on; node by node, for one that dropped itself would need as
    /// much stack as it is long.
    ///
    /// # Safety
    ///
    /// No other thread has a pointer to any node, and `free` may be asked to free each.
    #[expect(unsafe_code, reason = "nodes are shared by pointers")]
    pub(super) unsafe fn free_chain(mut first: *mut Self, free: impl Fn(*mut Self)) {
        while !first.is_null() {
            // SAFETY: it is not freed yet, and nobody changes it.
            let next = unsafe { (*first).next.load(Ordering::Relaxed) };
            free(first);
            first = next;
        }
    }
}
