//! The spec's work in pieces: over the cores, and in order.
//!
//! Vertices and triangles are taken in runs, a frame in bands of rows, a grid in slabs of layers. What comes of
//! the pieces is put together in their order, and is what one core makes of the whole.

pub mod bands;
mod drawn;
mod seen;
mod slabs;
mod vertices;

pub(super) use drawn::{Asked, draw};
pub use seen::{fragments_of, gbuffer};
pub use slabs::{Built, build};
pub use vertices::primitives;
