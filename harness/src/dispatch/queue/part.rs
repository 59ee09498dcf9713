//! A thread's part of a frame (listing 2): taking tasks and doing them until there are none.

use super::outstanding::Outstanding;
use super::traits::Worker;

/// A thread's end of a queue while it works on a frame.
pub struct Part<'a, W> {
    /// Its end.
    pub worker: W,
    /// Tasks that are not done, if the frame ends by their number. Without it a thread is done with the
    /// frame when it finds the queue empty, as in the paper.
    pub outstanding: Option<&'a Outstanding>,
}

impl<W> Part<'_, W> {
    /// Adds a task; somebody will do it within this frame.
    pub fn add<T>(&mut self, task: T)
    where
        W: Worker<T>,
    {
        // Before anybody can get it, and be done with it.
        if let Some(outstanding) = self.outstanding {
            outstanding.add(1);
        }
        self.worker.add(task);
    }

    /// Does tasks until the frame is over for this thread. While others have some that may add more,
    /// it does what `pause` says, and leaves if that is false.
    pub fn work_off<T>(
        &mut self,
        mut work: impl FnMut(&mut Self, T),
        mut pause: impl FnMut(&mut W) -> bool,
    ) where
        W: Worker<T>,
    {
        loop {
            if let Some(task) = self.worker.get() {
                work(self, task);
                // After its children were counted.
                if let Some(outstanding) = self.outstanding {
                    outstanding.done(1);
                }
            } else if self.outstanding.is_none_or(Outstanding::is_over) || !pause(&mut self.worker)
            {
                return;
            }
        }
    }
}
