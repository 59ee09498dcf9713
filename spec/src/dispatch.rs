//! Dispatch: rays as tasks in a queue, and the ray tracer that they feed.
//!
//! Nunes and Santos, "Workload Distribution for Ray Tracing in Multi-Core Systems". Rays are
//! traced iteratively and breadth-first (Whitted 1980, without recursion): a ray knows its pixel
//! and its weight, so whatever comes of it are further rays in a queue ([`queue::Fifo`]) and sums
//! in a picture ([`Sums`]). Every point that is seen asks for a shadow ray to each lamp that could
//! light it, and for a mirror ray where its material reflects.
//!
//! **What decides is integers.** Rays start at points of the grid's [`crate::grid::lattice`] and go in
//! integer directions; what they meet is exact ([`crate::grid::hit`]); the point that is met is the
//! nearest of the lattice to an exact quotient ([`locate`]); the mirror direction is an integer
//! polynomial ([`reflect`]); weights are integers. So every leg shoots the same rays, to the bit,
//! bounce after bounce. **What is reported** (light) carries the bound of an `f32` evaluation, is
//! rounded to `f32` once, and is summed up in units of 2^-[`UNIT_BITS`]: sums of integers do not depend on
//! the order in which tasks are done, nor on how many threads do them.
//!
//! | stage | gives | class |
//! |---|---|---|
//! | [`primary`] | the ray of each pixel | exact |
//! | [`intersect`] | what a ray meets | exact |
//! | [`locate`] | triangle, side and point | exact |
//! | [`light`] | which lamps are asked for | exact |
//! | | the light of each | interval |
//! | [`reflect`] | mirror ray and its weight | exact |
//! | [`deposit`] | the picture's sums | exact |
//!
//! Errata of the paper: listing 2 ends a frame when the queue is *momentarily* empty; the picture
//! is right all the same, as whoever adds tasks goes on to take them. The queues' own are told in
//! the harness, where the concurrent ones are: they must give what [`queue::Fifo`] gives.

mod deposit;
mod eye;
mod follow;
mod intersect;
mod lamp;
mod light;
mod locate;
pub mod queue;
mod ray;
mod reflect;
mod world;

pub use deposit::{Sums, UNIT_BITS, deposit, units};
pub use eye::{Eye, primary};
pub use follow::{Shot, behind, follow, render, tasks};
pub use intersect::{Met, Searched, Tracer, intersect};
pub use lamp::{LIGHT_MAX, Lamp};
pub use light::{light, lit};
pub use locate::{OFFSET, locate};
pub use ray::{Carried, Ray, WEIGHT_BITS, WEIGHT_ONE, Weight, weighted};
pub use reflect::{mirrored, reflect};
pub use world::{Material, World};

use crate::camera::CameraError;
use crate::grid::lattice::REACH;
use thiserror::Error;

/// Most mirror rays in a row.
pub const DEPTH_MAX: u32 = 64;

/// Most lamps.
pub const LAMPS_MAX: usize = 64;

/// Why there is no world to trace rays in.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum DispatchError {
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
    /// Materials that are not one for each triangle.
    #[error("{0} materials for {1} triangles")]
    Materials(usize, usize),
    /// A colour or a strength that is negative or not finite.
    #[error("{0} must be finite and not negative")]
    Light(f32),
    /// A mirror that gives back more than it gets, or less than nothing.
    #[error("{0} of the light cannot be reflected; 0 to 1 are allowed")]
    Mirror(f32),
    /// A lamp that is too bright at its shortest distance, or with a material that gives back more than it
    /// gets; or a background.
    #[error(
        "light of lamps, as materials give it back, or of the background may reach {0:e}; at most {LIGHT_MAX:e}"
    )]
    Bright(f64),
    /// An eye or a lamp that is not a point of the lattice.
    #[error("{0} is beyond the lattice, which ends at {REACH} steps")]
    TooFar(&'static str),
    /// No view.
    #[error(transparent)]
    Camera(#[from] CameraError),
}
