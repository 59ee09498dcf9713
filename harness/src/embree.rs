//! Embree as the third leg, asked twice.
//!
//! In screen space, parallel rays run through the samples of the target, and every
//! snapped triangle that Embree reports along them is collected ([`scene`]). In world
//! space ([`world`]) these are the camera's rays ([`view`]), and the triangles are those
//! of the scene, as loaded. Embree computes in `f32`; how far that can be trusted is
//! derived, not measured ([`bound`], [`world::bound`]).
//!
//! The library is called through its bindings in [`mod@bare`] and, for its version, in
//! [`mod@library`]. They are older than it: Embree 4.4 writes an accepted hit past the end
//! of their hit structure, so it gets more room there.

pub mod bare;
pub mod bound;
pub mod library;
pub mod rounded;
pub mod scene;
pub mod view;
pub mod world;

pub use library::{Library, library};
pub use scene::{EmbreeScene, Hit, RayHits, ScreenHits};

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
