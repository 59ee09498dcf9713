//! Whether all tasks of a frame are done.
//!
//! Listing 2 ends a thread's frame when the queue is empty at that moment. Then a thread may
//! leave while another is about to add tasks: the picture comes out right, but fewer threads
//! make it. Counting tells the difference.

use super::line::Line;
use super::sync::{AtomicUsize, Ordering};

/// Tasks that were counted and are not done.
///
/// Tasks are counted before anyone can get them: the first before threads are let go, a
/// task's children before it is itself done. All changes of one atomic have one order, that of
/// a thread's own among them, and a task's count precedes its being done, as whoever does it
/// got it from a queue. So each value in that order is the number of tasks that were counted and
/// not done there, and zero comes only once, after the last: it needs no snapshot, and no
/// ordering of memory, to be final.
pub struct Outstanding(Line<AtomicUsize>);

impl Outstanding {
    /// None so far.
    pub fn new() -> Self {
        Self(Line(AtomicUsize::new(0)))
    }

    /// Counts tasks, before they become visible. Relaxed, as nobody learns anything from it.
    pub fn add(&self, tasks: usize) {
        self.0.0.fetch_add(tasks, Ordering::Relaxed);
    }

    /// Tasks are done, and their children counted. Released is what they wrote; each of the
    /// changes that follow, being a read and a write at once, passes that on.
    pub fn done(&self, tasks: usize) {
        let before = self.0.0.fetch_sub(tasks, Ordering::Release);
        debug_assert!(before >= tasks, "{tasks} done of {before}");
    }

    /// Whether all are done. If so, everything that they wrote can be read.
    pub fn is_over(&self) -> bool {
        self.0.0.load(Ordering::Acquire) == 0
    }
}

impl Default for Outstanding {
    fn default() -> Self {
        Self::new()
    }
}
