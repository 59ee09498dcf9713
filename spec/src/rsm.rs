//! RSM: one bounce of indirect light from a reflective shadow map, with indirect shadows.
//!
//! Yang, Hensley, Grün and Thibieroz, "Real-Time Concurrent Linked List Construction on
//! the GPU" (2010), section 4.2; reflective shadow maps are those of Dachsbacher and
//! Stamminger (2005), where every texel is a small light. The eye's surfaces ([`gbuffer`])
//! and the light's ([`rsm`]) are seen; [`gather`] sums the light of a kernel of texels
//! (buffer A), [`block`] the part of it that blockers in the [`crate::grid`] keep away
//! (buffer B, coarser); [`compose`] adds A - [`blur`] of B to the [`direct`] light.
//!
//! **What decides is integers.** Which triangle a pixel sees is settled by
//! [`crate::abuffer::opaque`]. The point that is seen is snapped to the grid's lattice,
//! once, and so is its place in the light's map ([`place`]); who faces whom, which rays
//! there are, what they meet, what is lit and what is blurred together follow from those
//! integers exactly. **What is reported** (colours) carries the bound of an `f32`
//! evaluation. All lengths are lattice steps, so a scene that is moved by steps, or scaled
//! by a power of two together with the light's reference distance, gives the same numbers.
//!
//! | stage | gives | class |
//! |---|---|---|
//! | [`gbuffer`], [`rsm`] | triangle, side | exact |
//! | | point, intensity | interval |
//! | [`place`] | texel and key of a point | decision, on one `f64` quotient each |
//! | [`direct`], [`gather`] | which are lit, who contributes | exact |
//! | | irradiance | interval |
//! | [`block`] | which texels are blocked, how many rays | exact |
//! | | irradiance | interval |
//! | [`blur`], [`compose`] | whom a pixel takes from | exact |
//! | | colour | interval |
//!
//! Each is compared from equal inputs: those that are numbers are rounded to `f32` once.

mod block;
mod blur;
mod compose;
mod direct;
mod frame;
mod gather;
mod kernel;
mod lamp;
mod model;
mod parameters;
mod place;
mod point;
mod same;
mod sum;
mod view;

pub use block::{Blocked, block, fine};
pub use blur::{Coarse, blur};
pub use compose::compose;
pub use direct::{Direct, direct};
pub use frame::{Frame, Setting};
pub use gather::gather;
pub use kernel::{faces, term, texels};
pub(crate) use kernel::{projected, squared};
pub use lamp::{Lamp, Light, Rsm, rsm};
pub(crate) use model::sound;
pub use model::{COARSE_BITS, Face, Model};
pub use parameters::{
    BIAS_MAX, BITS_MAX, BLUR_MAX, DIVISOR_MAX, EDGE_MAX, OFFSET_MAX, OFFSET_MIN, Parameters,
    RADIUS_MAX, STRIDE_MAX,
};
pub use place::{PLACE_MAX, Place, place, project};
pub(crate) use point::moved_off;
pub use point::{Gbuffer, Points, Surface, gbuffer};
pub use same::same;
pub use view::{View, Viewpoint};

use crate::bound::Bounded;
use crate::camera::CameraError;
use crate::grid::lattice::{EXTENT, Point, REACH};
use thiserror::Error;

/// A linear colour, and how far an `f32` evaluation may be from it.
pub type Colour = [Bounded; 3];

/// No light, exactly.
pub const DARK: Colour = [Bounded {
    value: 0.0,
    bound: 0.0,
}; 3];

/// Why there is no frame.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum RsmError {
    /// A parameter beyond its limits.
    #[error("{name} is {value}; {least} to {most} are allowed")]
    Limit {
        /// Of the field.
        name: &'static str,
        /// What was given.
        value: u64,
        /// Least allowed.
        least: u64,
        /// Most allowed.
        most: u64,
    },
    /// A corner beyond the lattice's extent.
    #[error("a corner at {0:?} is beyond the lattice, which ends at {EXTENT}")]
    Outside(Point),
    /// An eye or a light that is not a point of the lattice.
    #[error("a perspective from beyond the lattice, which ends at {REACH} steps")]
    TooFar,
    /// A triangle whose corner is no vertex.
    #[error("vertex {0} does not exist")]
    Row(u32),
    /// Colours that are not one for each triangle.
    #[error("{0} colours for {1} triangles")]
    Colours(usize, usize),
    /// A colour or a strength that is negative or not finite.
    #[error("{0} must be finite and not negative")]
    Light(f32),
    /// No matrix.
    #[error(transparent)]
    Camera(#[from] CameraError),
}
