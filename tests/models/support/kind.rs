//! Which queues there are models of.

/// A queue, and how its nodes are freed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Listing 4.
    Lock,
    /// Listing 5, whose nodes are freed with the queue.
    Held,
    /// Listing 5, whose nodes are freed as soon as may be.
    Tracked,
    /// Listing 5 as it is used.
    Epochs,
    /// Listing 5 as it is printed.
    Freed {
        /// Whether reading what was freed is noticed.
        looks: bool,
    },
    /// A queue per thread.
    Local,
    /// A frame's loop, counted.
    Frame,
}
