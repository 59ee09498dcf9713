//! Where the threads of a frame get their tasks from, after Nunes and Santos, section 4.
//!
//! Their three: one queue with two locks ([`Lock`], listing 4), one without locks ([`Lfree`],
//! listing 5, after Michael and Scott), and one of each thread's own ([`Local`]). Two of
//! today's stand beside them: one shared list of blocks ([`Segments`]), and queues of each
//! thread's own that others steal from ([`Stealing`]). All are behind one interface
//! ([`Queue`], [`Worker`]); a thread's loop over one is a [`Part`] of a frame, and whether that is over is
//! [`Outstanding`]'s to say.
//!
//! Three things in the listings do not hold, and are otherwise here. Listing 4 reads in one
//! lock what it writes in the other, and gives the value of the node that it takes away, which
//! is the one taken before: its first `get` gives nothing's value, and the last task never
//! comes out. Listing 5 frees a node that others may still read, and whose address may come
//! back (the ABA problem); see [`reclaim`].
//!
//! The files here name only each other and crossbeam, so that `tests/models` can build the very
//! same text with atomics, locks and memory of a model checker in place of `sync.rs`.

pub mod lfree;
mod line;
pub mod local;
pub mod lock;
pub mod node;
pub mod outstanding;
pub mod part;
pub mod reclaim;
pub mod segments;
pub mod steal;
mod sync;
pub mod traits;

pub use lfree::Lfree;
pub use local::Local;
pub use lock::Lock;
pub use outstanding::Outstanding;
pub use part::Part;
pub use reclaim::{Epochs, Reclaim};
pub use segments::Segments;
pub use steal::Stealing;
pub use traits::{Queue, Worker};
