//! When the memory of a node that was taken out may be used again.
//!
//! Listing 5 says `delete first` right after its compare-and-swap. But others may have read
//! `head` before, and be about to read `first->next`: of memory that is gone. Worse, if that
//! address has become a new node, and that one the sentinel, their compare-and-swap finds
//! what it expects and sets `head` to a node that has long been elsewhere (ABA). Michael and Scott
//! count pointers and never give memory back; here the queue asks a [`Reclaim`].

use super::sync::{AtomicPtr, Ordering, create, free};

/// How nodes are made, read and given back. What it takes is what any of the known ways
/// needs: epochs, hazard pointers, counted references, an arena, or never freeing.
pub trait Reclaim<N> {
    /// What a thread holds while it has pointers to nodes: an epoch, its hazard pointers.
    type Guard<'g>
    where
        Self: 'g;

    /// Begins an operation of this thread; it ends with the guard.
    fn pin(&self) -> Self::Guard<'_>;

    /// Memory for a node: from the heap, or one's own.
    fn create(&self, node: N) -> *mut N;

    /// Reads a pointer that others may change, acquiring what was written before it. Hazard
    /// pointers announce here what they have read, and read again; an arena notes which
    /// generation it was. Of one guard at most three are in use at a time.
    fn load(&self, guard: &Self::Guard<'_>, place: &AtomicPtr<N>) -> *mut N;

    /// A node, for as long as the guard is there.
    ///
    /// # Safety
    ///
    /// It was loaded under this guard, from where it could be reached then or later.
    #[expect(unsafe_code, reason = "nodes are shared by pointers")]
    unsafe fn node<'g>(&self, guard: &'g Self::Guard<'_>, node: *mut N) -> &'g N;

    /// Gives a node back that nothing leads to any more, but that others may still read.
    ///
    /// # Safety
    ///
    /// It is [`create`](Self::create)'s, this happens once, who pins from now on does not come to
    /// it, and it can be dropped on any thread and however late: it refers to nothing.
    #[expect(unsafe_code, reason = "nodes are shared by pointers")]
    unsafe fn retire(&self, guard: &Self::Guard<'_>, node: *mut N);

    /// Gives a node back that nobody reads.
    ///
    /// # Safety
    ///
    /// It is [`create`](Self::create)'s, this happens once, and no thread has a pointer to it.
    #[expect(unsafe_code, reason = "nodes are shared by pointers")]
    unsafe fn free(&self, node: *mut N);
}

/// Epochs, as crossbeam has them: what was retired is freed once every thread that was at
/// work then has come to an end of what it did. A thread that stops for good inside an
/// operation keeps memory from being freed, and nobody from working.
#[derive(Clone, Copy, Debug, Default)]
pub struct Epochs;

impl<N> Reclaim<N> for Epochs {
    type Guard<'g> = crossbeam_epoch::Guard;

    fn pin(&self) -> crossbeam_epoch::Guard {
        crossbeam_epoch::pin()
    }

    fn create(&self, node: N) -> *mut N {
        create(node)
    }

    fn load(&self, _guard: &crossbeam_epoch::Guard, place: &AtomicPtr<N>) -> *mut N {
        place.load(Ordering::Acquire)
    }

    #[expect(unsafe_code, reason = "nodes are shared by pointers")]
    unsafe fn node<'g>(&self, _guard: &'g crossbeam_epoch::Guard, node: *mut N) -> &'g N {
        // SAFETY: it could be reached while the guard was there, so it is not freed before the
        // guard has gone.
        unsafe { &*node }
    }

    #[expect(unsafe_code, reason = "nodes are shared by pointers")]
    unsafe fn retire(&self, guard: &crossbeam_epoch::Guard, node: *mut N) {
        // SAFETY: nobody can come to it who is not pinned now, and those have ended by then.
        // This may run on another thread, after everything that `N` names has gone: the
        // caller promises that dropping it then touches nothing of that.
        unsafe { guard.defer_unchecked(move || free(node)) };
    }

    #[expect(unsafe_code, reason = "nodes are shared by pointers")]
    unsafe fn free(&self, node: *mut N) {
        // SAFETY: as the caller promises.
        unsafe { free(node) };
    }
}
