//! The queues under loom.

#[path = "../tree/arena.rs"]
pub mod arena;
#[path = "../tree/frame.rs"]
pub mod frame;
#[path = "../tree/held.rs"]
pub mod held;
#[path = "../../../harness/src/dispatch/queue/lfree.rs"]
pub mod lfree;
#[path = "../../../harness/src/dispatch/queue/line.rs"]
pub mod line;
#[path = "../../../harness/src/dispatch/queue/local.rs"]
pub mod local;
#[path = "../../../harness/src/dispatch/queue/lock.rs"]
pub mod lock;
#[path = "../../../harness/src/dispatch/queue/node.rs"]
pub mod node;
#[path = "../../../harness/src/dispatch/queue/outstanding.rs"]
pub mod outstanding;
#[path = "../../../harness/src/dispatch/queue/part.rs"]
pub mod part;
#[path = "../../../harness/src/dispatch/queue/reclaim.rs"]
pub mod reclaim;
#[path = "../tree/run.rs"]
pub mod run;
#[path = "../shim/loom.rs"]
pub mod sync;
#[path = "../tree/tracked.rs"]
pub mod tracked;

pub use crate::support::traits;
