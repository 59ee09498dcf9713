//! Where threads wait for a frame, and for each other at its end: the paper's barriers, which can be
//! left for good.

use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

/// The two barriers and the tag `END` of listings 2 and 3.
#[derive(Default)]
pub(super) struct Gate {
    state: Mutex<State>,
    changed: Condvar,
}

#[derive(Default)]
struct State {
    /// Number of the frame, from 1; 0 before the first.
    frame: u64,
    /// Threads that have not left it.
    at_work: usize,
    /// No frame will follow.
    over: bool,
}

/// Says that no frame will follow, also while the application panics: nobody waits for ever.
pub(super) struct End<'a>(pub(super) &'a Gate);

impl Drop for End<'_> {
    fn drop(&mut self) {
        self.0.locked().over = true;
        self.0.changed.notify_all();
    }
}

impl Gate {
    /// Lets so many threads go on to the next frame.
    pub(super) fn open(&self, threads: usize) {
        let mut state = self.locked();
        state.frame += 1;
        state.at_work = threads;
        self.changed.notify_all();
    }

    /// Waits until all threads have left the frame.
    pub(super) fn wait(&self) {
        drop(self.until(|state| state.at_work == 0));
    }

    /// Waits for the frame after this one; `None` if there is none.
    pub(super) fn enter(&self, after: u64) -> Option<u64> {
        let state = self.until(|state| state.frame > after || state.over);
        (state.frame > after).then_some(state.frame)
    }

    /// Leaves a frame, and waits until all have, or another has begun.
    pub(super) fn leave(&self, frame: u64) {
        let mut state = self.locked();
        state.at_work -= 1;
        if state.at_work == 0 {
            self.changed.notify_all();
        }
        drop(state);
        drop(self.until(|state| state.at_work == 0 || state.frame != frame));
    }

    fn until(&self, holds: impl Fn(&State) -> bool) -> MutexGuard<'_, State> {
        let state = self.locked();
        let waited = self.changed.wait_while(state, |state| !holds(state));
        waited.unwrap_or_else(PoisonError::into_inner)
    }

    fn locked(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
