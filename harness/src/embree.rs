//! Embree as the third leg: what it sees of the snapped triangles in screen space.
//!
//! Parallel rays run through the samples of the target, and every triangle that
//! Embree reports along them is collected ([`scene`]). Embree computes in `f32`;
//! how far that can be trusted is derived, not measured ([`bound`]).
//!
//! The embree4-rs wrapper serves for building and tracing; only the library's
//! version ([`mod@library`]) needs the bindings below it. Those are older than the
//! library: Embree 4.4 writes an accepted hit past the end of the wrapper's hit
//! structure. Here no hit is ever accepted; the closest hit must not be asked of
//! [`embree4_rs::CommittedScene::intersect_1`].

pub mod bound;
pub mod library;
pub mod scene;

pub use library::{Library, library};
pub use scene::{EmbreeScene, Hit, RayHits};

/// Something that Embree refused to do.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("Embree: {step}: {reason}")]
pub struct EmbreeError {
    /// What was asked for.
    pub step: &'static str,
    /// What the library or the wrapper said.
    pub reason: String,
}

impl EmbreeError {
    fn new(step: &'static str, reason: impl std::fmt::Display) -> Self {
        Self {
            step,
            reason: reason.to_string(),
        }
    }
}
