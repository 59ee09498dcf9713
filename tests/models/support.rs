//! What the models share.
#![allow(dead_code, reason = "each target takes its part")]

#[macro_use]
pub mod checked;
pub mod events;
pub mod heap;
pub mod how;
pub mod kind;
pub mod linear;
pub mod script;
#[path = "../../harness/src/dispatch/queue/traits.rs"]
pub mod traits;
pub mod verdict;
