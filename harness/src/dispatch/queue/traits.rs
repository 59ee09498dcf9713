//! What every queue can do.

/// Where threads get tasks from and put new ones.
pub trait Queue<T: Send>: Sync {
    /// A thread's end of the queue.
    type Worker<'q>: Worker<T>
    where
        Self: 'q;

    /// Tasks of the application, dealt before threads are let go; a queue per thread gets
    /// them round-robin.
    fn deal(&self, tasks: impl IntoIterator<Item = T>);

    /// What a thread works with during a frame; each thread's number asks once a frame.
    fn worker(&self, thread: usize) -> Self::Worker<'_>;
}

/// One thread's end of a queue.
pub trait Worker<T> {
    /// Puts a task behind all others.
    fn add(&mut self, task: T);

    /// Takes the first task; `None`: empty at this moment.
    fn get(&mut self) -> Option<T>;
}
