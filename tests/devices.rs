//! All adapters of the machine, opened and calibrated once, lent to one test at a
//! time.

use std::ops::{Deref, DerefMut};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

use triptych_harness::calibrate::Grid;
use triptych_harness::replay::gpu::Adapter;

#[path = "adapters.rs"]
mod adapters;

use adapters::open;

/// How many tests may run at once, each on devices of its own: what the spec and
/// Embree do for one scene fills the time in which another waits for its device.
const SETS: usize = 2;

/// Sets of devices, one for each adapter of the machine.
#[derive(Default)]
pub struct Devices {
    state: Mutex<State>,
    returned: Condvar,
}

#[derive(Default)]
struct State {
    idle: Vec<Vec<Adapter>>,
    lent: usize,
}

/// A set that is given back when dropped.
pub struct Lent<'a> {
    from: &'a Devices,
    set: Vec<Adapter>,
    spoilt: bool,
    /// The grids as they were found, of a set that is mended.
    changed: Option<Vec<Grid>>,
}

impl Devices {
    /// A set of devices, as soon as there is one.
    ///
    /// # Errors
    /// One line if there is no adapter, or one cannot be opened.
    pub fn take(&self) -> Result<Lent<'_>, String> {
        let mut state = self.state();
        while state.lent == SETS {
            state = self
                .returned
                .wait(state)
                .unwrap_or_else(PoisonError::into_inner);
        }
        state.lent += 1;
        let idle = state.idle.pop();
        drop(state);
        let mut lent = Lent {
            from: self,
            set: Vec::new(),
            spoilt: true,
            changed: None,
        };
        lent.set = match idle {
            Some(set) => set,
            None => open()?,
        };
        lent.spoilt = false;
        Ok(lent)
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Lent<'_> {
    /// What is lent is not what was opened any more. No other test gets this set; or, if that
    /// `mends` it, one with kernels and grids as they were.
    pub fn spoil(&mut self, mends: bool) {
        self.spoilt = !mends;
        self.changed = mends.then(|| self.set.iter().map(|a| a.grid).collect());
    }
}

impl Drop for Lent<'_> {
    fn drop(&mut self) {
        let mut set = std::mem::take(&mut self.set);
        for (adapter, grid) in set.iter_mut().zip(self.changed.take().unwrap_or_default()) {
            adapter.grid = grid;
            adapter.use_shipped();
        }
        let mut state = self.from.state();
        state.lent -= 1;
        if !self.spoilt && !std::thread::panicking() {
            state.idle.push(set);
        }
        self.from.returned.notify_one();
    }
}

impl Deref for Lent<'_> {
    type Target = [Adapter];

    fn deref(&self) -> &[Adapter] {
        &self.set
    }
}

impl DerefMut for Lent<'_> {
    fn deref_mut(&mut self) -> &mut [Adapter] {
        &mut self.set
    }
}
