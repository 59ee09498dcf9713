//! How tasks are distributed, and what traces them.

use crate::dispatch::crew::Ending;

/// A method.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Method {
    /// One thread on a queue that nobody shares: what speed-ups are relative to.
    Sequential,
    /// The paper's queue with two locks.
    Lock,
    /// The paper's queue without locks.
    Lfree,
    /// The paper's queue of each thread's own.
    Local,
    /// LOCK, whose threads stay until no task is left.
    LockCounted,
    /// LFREE, likewise.
    LfreeCounted,
    /// LFREE with the paper's framebuffer: floats under a spin lock.
    LfreeSpinning,
    /// `crossbeam`'s list of blocks, counted.
    Segments,
    /// Queues of each thread's own that others steal from (`crossbeam-deque`), counted.
    Stealing,
    /// `rayon`'s threads.
    Rayon,
    /// LOCAL, with Embree in place of our tree.
    Embree,
    /// The wavefront of an adapter.
    Board(usize),
}

impl Method {
    /// Those that run on threads, in the order in which they are shown.
    pub const ON_THREADS: [Self; 10] = [
        Self::Lock,
        Self::Lfree,
        Self::Local,
        Self::LockCounted,
        Self::LfreeCounted,
        Self::LfreeSpinning,
        Self::Segments,
        Self::Stealing,
        Self::Rayon,
        Self::Embree,
    ];

    /// The paper's three.
    pub const PAPERS: [Self; 3] = [Self::Lock, Self::Lfree, Self::Local];

    /// The paper's three, and those whose ending makes a difference with the other one: nobody adds to
    /// another's LOCAL.
    pub const PAPERS_COUNTED: [Self; 5] = [
        Self::Lock,
        Self::Lfree,
        Self::Local,
        Self::LockCounted,
        Self::LfreeCounted,
    ];

    /// Queues with both endings: the paper's first, then the same counted.
    pub const ENDINGS: [[Self; 2]; 2] = [
        [Self::Lock, Self::LockCounted],
        [Self::Lfree, Self::LfreeCounted],
    ];

    /// When its threads take a frame to be done.
    pub fn ending(self) -> Ending {
        match self {
            Self::Lock | Self::Lfree | Self::Local | Self::LfreeSpinning | Self::Embree => {
                Ending::Empty
            }
            _ => Ending::Counted,
        }
    }

    /// A word for tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Sequential => "sequential",
            Self::Lock => "LOCK",
            Self::Lfree => "LFREE",
            Self::Local => "LOCAL",
            Self::LockCounted => "LOCK counted",
            Self::LfreeCounted => "LFREE counted",
            Self::LfreeSpinning => "LFREE spin lock",
            Self::Segments => "segments",
            Self::Stealing => "stealing",
            Self::Rayon => "rayon",
            Self::Embree => "Embree LOCAL",
            Self::Board(_) => "wavefront",
        }
    }

    /// What it is, for those who read a page.
    pub fn words(self) -> &'static str {
        match self {
            Self::Sequential => {
                "one thread on a queue that nobody shares; speed-ups are relative to it"
            }
            Self::Lock => "one queue, a lock for adding and one for getting (listing 4)",
            Self::Lfree => "one queue without locks (listing 5), its memory reclaimed by epochs",
            Self::Local => {
                "a queue for each thread, to which tasks are dealt in turn (section 4.2)"
            }
            Self::LockCounted => "LOCK; threads stay until no task is left",
            Self::LfreeCounted => "LFREE; threads stay until no task is left",
            Self::LfreeSpinning => {
                "LFREE, whose pictures are sums of floats under one spin lock (section 3)"
            }
            Self::Segments => "crossbeam's SegQueue; counted",
            Self::Stealing => {
                "crossbeam-deque: a queue for each thread, from which idle ones steal; counted"
            }
            Self::Rayon => "rayon's threads, a job for each task",
            Self::Embree => {
                "LOCAL, with Embree's tree in place of ours: rays one by one, as the others"
            }
            Self::Board(_) => "an adapter's wavefront, by its own timestamps",
        }
    }
}
