//! The queues as they are shipped.

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
#[path = "../../../harness/src/dispatch/queue/reclaim.rs"]
pub mod reclaim;
#[path = "../../../harness/src/dispatch/queue/segments.rs"]
pub mod segments;
#[path = "../../../harness/src/dispatch/queue/steal.rs"]
pub mod steal;
#[path = "../../../harness/src/dispatch/queue/sync.rs"]
pub mod sync;
#[path = "../../../harness/src/dispatch/queue/traits.rs"]
pub mod traits;
