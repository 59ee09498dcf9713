//! Nodes that are freed with their queue.

use std::sync::Mutex;

use super::reclaim::Reclaim;
use super::sync::{AtomicPtr, Ordering, create, free};

/// Keeps what was retired.
pub struct Held<N>(Mutex<Vec<*mut N>>);

impl<N> Held<N> {
    pub const fn new() -> Self {
        Self(Mutex::new(Vec::new()))
    }
}

// SAFETY: the pointers are only kept.
#[expect(unsafe_code, reason = "a reclaimer is")]
unsafe impl<N> Send for Held<N> {}
// SAFETY: as above.
#[expect(unsafe_code, reason = "a reclaimer is")]
unsafe impl<N> Sync for Held<N> {}

#[expect(unsafe_code, reason = "a reclaimer is")]
impl<N> Reclaim<N> for Held<N> {
    type Guard<'g>
        = ()
    where
        N: 'g;

    fn pin(&self) {}

    fn create(&self, node: N) -> *mut N {
        create(node)
    }

    fn load(&self, _guard: &(), place: &AtomicPtr<N>) -> *mut N {
        place.load(Ordering::Acquire)
    }

    unsafe fn node<'g>(&self, _guard: &'g (), node: *mut N) -> &'g N {
        // SAFETY: it is there as long as the queue.
        unsafe { &*node }
    }

    unsafe fn retire(&self, _guard: &(), node: *mut N) {
        self.0.lock().expect("nobody panics here").push(node);
    }

    unsafe fn free(&self, node: *mut N) {
        // SAFETY: as the caller promises.
        unsafe { free(node) };
    }
}

impl<N> Drop for Held<N> {
    #[expect(unsafe_code, reason = "a reclaimer is")]
    fn drop(&mut self) {
        for node in self.0.get_mut().expect("nobody panics here").drain(..) {
            // SAFETY: retired once, and no thread is left.
            unsafe { free(node) };
        }
    }
}
