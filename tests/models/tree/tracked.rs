//! Nodes that are freed as soon as epochs would allow it: when all have ended who were at
//! work when it was retired. Epochs free much later, and may hide that it was too early.

use std::collections::BTreeSet;
use std::sync::Mutex;

use super::reclaim::Reclaim;
use super::sync::{AtomicPtr, AtomicUsize, Ordering, create, free};

struct State<N> {
    next: usize,
    working: BTreeSet<usize>,
    /// Each with those who may still read it.
    retired: Vec<(*mut N, BTreeSet<usize>)>,
}

/// Frees as early as may be.
pub struct Tracked<N> {
    state: Mutex<State<N>>,
    /// What a model's checker sees of it: who frees comes after those who ended, and who begins
    /// after something was retired no longer sees what led there, for which epochs have fences.
    turn: AtomicUsize,
}

// SAFETY: the state is under a lock.
#[expect(unsafe_code, reason = "a reclaimer is")]
unsafe impl<N> Send for Tracked<N> {}
// SAFETY: as above.
#[expect(unsafe_code, reason = "a reclaimer is")]
unsafe impl<N> Sync for Tracked<N> {}

impl<N> Tracked<N> {
    pub fn new() -> Self {
        let state = State {
            next: 0,
            working: BTreeSet::new(),
            retired: Vec::new(),
        };
        Self {
            state: Mutex::new(state),
            turn: AtomicUsize::new(0),
        }
    }
}

/// Someone at work.
pub struct Guard<'g, N> {
    of: &'g Tracked<N>,
    number: usize,
}

impl<N> Drop for Guard<'_, N> {
    #[expect(unsafe_code, reason = "a reclaimer is")]
    fn drop(&mut self) {
        if std::thread::panicking() {
            return;
        }
        self.of.turn.fetch_add(1, Ordering::AcqRel);
        let mut state = self.of.state.lock().expect("nobody panics here");
        state.working.remove(&self.number);
        for (_, readers) in &mut state.retired {
            readers.remove(&self.number);
        }
        let free_now: Vec<_> = state
            .retired
            .extract_if(.., |(_, r)| r.is_empty())
            .collect();
        drop(state);
        for (node, _) in free_now {
            // SAFETY: retired once, and nobody is left who could read it.
            unsafe { free(node) };
        }
    }
}

#[expect(unsafe_code, reason = "a reclaimer is")]
impl<N> Reclaim<N> for Tracked<N> {
    type Guard<'g>
        = Guard<'g, N>
    where
        N: 'g;

    fn pin(&self) -> Guard<'_, N> {
        self.turn.fetch_add(1, Ordering::AcqRel);
        let mut state = self.state.lock().expect("nobody panics here");
        let number = state.next;
        state.next += 1;
        state.working.insert(number);
        Guard { of: self, number }
    }

    fn create(&self, node: N) -> *mut N {
        create(node)
    }

    fn load(&self, _guard: &Guard<'_, N>, place: &AtomicPtr<N>) -> *mut N {
        place.load(Ordering::Acquire)
    }

    unsafe fn node<'g>(&self, _guard: &'g Guard<'_, N>, node: *mut N) -> &'g N {
        // SAFETY: a model's memory stays until its schedule is over.
        unsafe { &*node }
    }

    unsafe fn retire(&self, _guard: &Guard<'_, N>, node: *mut N) {
        self.turn.fetch_add(1, Ordering::AcqRel);
        let mut state = self.state.lock().expect("nobody panics here");
        let working = state.working.clone();
        state.retired.push((node, working));
    }

    unsafe fn free(&self, node: *mut N) {
        // SAFETY: as the caller promises.
        unsafe { free(node) };
    }
}
