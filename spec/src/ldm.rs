//! LDM: layered depth maps in deterministic directions, and what is seen through them.
//!
//! Aalund, Frisvad and Bærentzen, "Interactive Global Illumination Effects Using
//! Deterministically Directed Layered Depth Maps" (2015), sections 3.1 to 3.3 and 5.2. A map is
//! an orthographic picture that keeps all depths of every pixel, front and back faces alike. One
//! is made for each of N [`directions`], all of them a partition of half the sphere; [`layers`]
//! fills and sorts them, [`neighbours`] finds what is before and behind a point along a direction,
//! [`occlusion`] and [`environment`] sum that up over the directions, and [`mirror`] picks one of them.
//!
//! **What decides is integers.** Blockers and points are on the lattice of the [`crate::grid`],
//! and a map's axes are rows of integers, made once and given to every leg ([`Map`]). So
//! coverage, keys, which of them belong to the point itself, and what is found before and behind
//! are exact; the sum of ambient occlusion is one of integers, too. **What is reported**
//! (distances, obscurance, irradiance) carries the bound of an `f32` evaluation.
//!
//! | stage | gives | class |
//! |---|---|---|
//! | [`layers`] | keys of every pixel, rising | exact |
//! | [`chain`] | the same as linked lists | exact, without addresses |
//! | [`neighbours`] | the keys before and behind a point's own | exact |
//! | [`occlusion`] | weight of what is open | exact; with a distance interval |
//! | [`environment`] | irradiance | interval |
//! | [`mirror`] | what is seen in the direction nearest to the mirror direction | exact |
//!
//! Settled errata of the paper: equation 2's sum has N terms, not N + 1; what lies beside a map
//! is open and weighs as much as any other direction; a point's own layers are those within half
//! a pixel's slope of its depth, not the nearest one, and there is no fixed step off the surface.

mod chain;
mod directions;
mod environment;
mod layers;
mod map;
mod mirror;
mod neighbours;
mod occlusion;
mod rotation;

pub use chain::{Chains, Link, chain};
pub use directions::{DIRECTIONS_MAX, Zone, directions, zones};
pub use environment::{Sky, environment};
pub use layers::{KEYS_MAX, Layers, layers};
pub use map::{KEYS_PER_STEP, Map, Maps, PLANE_BITS, RESOLUTION_MAX, RESOLUTION_MIN};
pub use mirror::{Mirrored, mirror, nearness, view};
pub use neighbours::{Hits, OFF_MAX, Receiver, neighbours, own_band};
pub use occlusion::{FAR_MAX, Falloff, Open, WEIGHT_BITS, occlusion, openness, weight};
pub use rotation::{Rotation, rotated};

use thiserror::Error;

/// Why there are no maps.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum LdmError {
    /// A number beyond its limits.
    #[error("{name} is {value}; {least} to {most} are allowed")]
    Limit {
        /// Of what.
        name: &'static str,
        /// What was given.
        value: u64,
        /// Least allowed.
        least: u64,
        /// Most allowed.
        most: u64,
    },
    /// A corner that is no vertex.
    #[error("vertex {0} does not exist")]
    Row(u32),
}

/// An error unless `least <= value <= most`.
fn within(name: &'static str, value: u64, least: u64, most: u64) -> Result<(), LdmError> {
    match (least..=most).contains(&value) {
        true => Ok(()),
        false => Err(LdmError::Limit {
            name,
            value,
            least,
            most,
        }),
    }
}
