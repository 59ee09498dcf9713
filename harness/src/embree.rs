//! Embree as the third leg, asked twice.
//!
//! In screen space, parallel rays run through the samples of the target, and every
//! snapped triangle that Embree reports along them is collected ([`scene`]). In world
//! space ([`world`]) these are the camera's rays ([`view`]), and the triangles are those
//! of the scene, as loaded. On a grid's lattice any rays are asked, whether and what they
//! meet ([`rays`]). Embree computes in `f32`; how far that can be trusted is derived, not
//! measured ([`bound`], [`world::bound`], [`rays::bound`]).
//!
//! The embree4-rs wrapper serves for building and tracing; only the library's version
//! ([`mod@library`]) and bare calls ([`mod@bare`]) need the bindings below it. Those are
//! older than the library: Embree 4.4 writes an accepted hit past the end of the wrapper's
//! hit structure. The wrapper's callers accept no hit; the closest one is asked of
//! [`bare::Bare`] alone, never of [`embree4_rs::CommittedScene::intersect_1`].

pub mod bare;
pub mod bound;
mod collect;
pub mod library;
pub mod rays;
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
