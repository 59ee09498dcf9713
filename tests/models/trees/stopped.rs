//! The shared queues, with threads that stop for good.

#[path = "../../../harness/src/dispatch/queue/lfree.rs"]
pub mod lfree;
#[path = "../../../harness/src/dispatch/queue/line.rs"]
pub mod line;
#[path = "../../../harness/src/dispatch/queue/lock.rs"]
pub mod lock;
#[path = "../../../harness/src/dispatch/queue/node.rs"]
pub mod node;
#[path = "../../../harness/src/dispatch/queue/reclaim.rs"]
pub mod reclaim;
#[path = "../shim/stopped.rs"]
pub mod sync;
#[path = "../../../harness/src/dispatch/queue/traits.rs"]
pub mod traits;
