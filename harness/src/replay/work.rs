//! How much work a scene's rays are, counted before any leg traces them.
//!
//! A ray passes cells, and may be held against every triangle that each of them lists, as often
//! as one does. [`of`] counts cells and entries of lists along its whole way through the grid:
//! what Embree's vote goes through for each query, and no less than what the spec and the kernels
//! do, which stop at a hit. So one limit bounds all legs. It is a number of steps, not a time: what
//! is refused is the same on every machine, and with any number of threads.

use std::sync::atomic::{AtomicU64, Ordering};

use triptych_spec::grid::Grid;
use triptych_spec::grid::ray::Ray;
use triptych_spec::grid::walk::{Walk, step_bound};

/// Most cells and entries that a scene's rays may meet. The spec took 39 to 75 ns for each where it
/// needs longest, at thousands of needles side by side: up to 43 minutes on one core. Two million
/// rays of each kind at the whole ball of fur, the most of any mesh here, meet three quarters of it.
pub const WORK_MAX: u64 = 1 << 35;

/// Cells that a ray passes, and the entries of their lists.
pub fn of(grid: &Grid, ray: Ray) -> Work {
    let mut work = Work::default();
    for passed in Walk::new(grid, ray) {
        work.cells += 1;
        work.entries += grid.list(passed.cell).len() as u64;
    }
    work
}

/// No ray of a grid has more: it passes no cell twice.
pub fn most(grid: &Grid) -> Work {
    Work {
        cells: u64::from(step_bound(grid)),
        entries: grid.prims.len() as u64,
    }
}

/// What a ray meets. Two sums, as only a grid's legs pass empty cells.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// Cells that it passes.
    pub cells: u64,
    /// Entries of their lists: at most all of a grid, 2^26.
    pub entries: u64,
}

impl Work {
    /// Both together.
    pub fn total(self) -> u64 {
        self.cells + self.entries
    }
}

/// Adds work up to a limit, on any number of threads.
pub struct Meter {
    limit: u64,
    spent: AtomicU64,
}

impl Meter {
    /// Nothing has been spent yet.
    pub fn new(limit: u64) -> Self {
        Self {
            limit,
            spent: AtomicU64::new(0),
        }
    }

    /// Spends a part, and says whether all parts so far are within the limit. If those of a scene
    /// exceed it together, some part is told so, whoever comes last.
    pub fn takes(&self, part: u64) -> bool {
        // Sums beyond the limit grow no more, so this never wraps.
        let add = |spent: u64| (spent <= self.limit).then(|| spent.saturating_add(part));
        let before = self
            .spent
            .fetch_update(Ordering::Relaxed, Ordering::Relaxed, add);
        before.is_ok_and(|spent| spent.saturating_add(part) <= self.limit)
    }
}

#[cfg(test)]
mod tests;
