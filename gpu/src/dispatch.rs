//! The ray tracer on the device: queues of rays, bounce after bounce.
//!
//! Each stage can be handed what the stage before should have made, or whole frames are made of
//! what this device makes itself. Rays are searched by the grid's `trace`, in its exact form
//! ([`crate::grid::Device::exactly`]). Twin: `spec/src/dispatch.rs`.

mod device;
mod frame;
mod queue;
mod records;
mod stages;
mod timed;

use std::ops::Range;

use bytemuck::{Pod, Zeroable};
use triptych_spec::dispatch::{Eye, Met, Ray, Sums, World};
use triptych_spec::rsm::Surface as SpecSurface;

pub use records::{Carried, Facet, Lamp};
pub use stages::Stages;
pub use timed::{Span, Timed};

/// Where a ray's depth begins, in the word that tells whose it is. Twin: `DEPTH_AT` in `task.wgsl`.
pub const DEPTH_AT: u32 = 24;

/// What tells rays that carry light. Twin: `LIGHT` in `task.wgsl`.
pub const LIGHT: u32 = 1 << 31;

/// A point or direction of each pixel. Twin: `Plane` in `task.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub struct Plane {
    /// Of the first pixel; the fourth number of this and those that follow is not used.
    pub corner: [i32; 4],
    /// From one column to the next.
    pub right: [i32; 4],
    /// From one row to the next.
    pub down: [i32; 4],
}

impl Plane {
    fn new(vectors: [[i32; 3]; 3]) -> Self {
        let [corner, right, down] = vectors.map(|[x, y, z]| [x, y, z, 0]);
        Self {
            corner,
            right,
            down,
        }
    }
}

/// What a kernel is told. Twin: `Task` in `task.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Task {
    /// Rays of a dispatch.
    pub items: u32,
    /// The first pixel, where rays begin.
    pub first: u32,
    /// Rays that the next queue has room for.
    pub capacity: u32,
    /// How many there are.
    pub lamps: u32,
    /// Most mirrors on the way of a ray.
    pub depth: u32,
    /// Pixels a row of the picture.
    pub width: u32,
    /// Up to a multiple of 16 bytes.
    pub unused: [u32; 2],
    /// Linear light along rays that meet nothing; the fourth number is not used.
    pub background: [f32; 4],
    /// Where pixels' rays start.
    pub origin: Plane,
    /// Where they go.
    pub direction: Plane,
}

impl From<&World> for Task {
    fn from(world: &World) -> Self {
        let Eye {
            size,
            origin,
            direction,
        } = &world.eye;
        let [red, green, blue] = world.background;
        Self {
            lamps: u32::try_from(world.lamps.len()).unwrap_or(u32::MAX),
            depth: world.depth,
            width: size.width,
            background: [red, green, blue, 0.0],
            origin: Plane::new([origin.corner, origin.right, origin.down]),
            direction: Plane::new([direction.corner, direction.right, direction.down]),
            ..Self::default()
        }
    }
}

/// What rays meet, as the spec has it; a triangle is whatever the device says.
pub type Hits = Vec<Met>;

/// What is seen where rays that ask for the nearest triangle meet one.
pub type Surfaces = Vec<Option<SpecSurface>>;

/// An attempt to fill a queue that had too little room.
#[derive(Clone, Debug, PartialEq)]
pub struct Overflow {
    /// Rays that there was room for.
    pub capacity: u32,
    /// Rays that were to be stored.
    pub attempts: u32,
    /// Those that were: some of all, in any order.
    pub rays: Vec<Ray>,
    /// Rows of the rays that asked for them, as a stage goes through many in parts; none in a frame of the
    /// device's own.
    pub asked: Range<usize>,
}

/// What a stage appended to a queue.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Appended {
    /// All rays, in any order.
    pub rays: Vec<Ray>,
    /// Attempts before, which had too little room.
    pub overflows: Vec<Overflow>,
}

/// How much room a frame begins with; whatever is left out is chosen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Room {
    /// Pixels that go through all bounces at once.
    pub pixels: Option<u32>,
    /// Shadow rays of such a batch.
    pub shadows: Option<u32>,
    /// Mirror rays of such a batch.
    pub mirrors: Option<u32>,
}

/// Rays of one depth, and what came of them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Bounce {
    /// Rays that ask for the nearest triangle.
    pub rays: Vec<Ray>,
    /// What each of them met.
    pub met: Hits,
    /// What they see there.
    pub seen: Surfaces,
    /// Rays to lamps, and what was too little room for them.
    pub shadows: Appended,
    /// Whether each of them met anything.
    pub blocked: Hits,
    /// Rays into mirrors that were asked for, and what was too little room for them; they are the
    /// next bounce's rays.
    pub mirrors: Vec<Overflow>,
}

/// What a bounce of a batch needs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Needs {
    /// Rays that ask for the nearest triangle.
    pub rays: u32,
    /// Rays to lamps.
    pub shadows: u32,
    /// Dispatches of the searches, of the former and of the latter.
    pub rounds: [u32; 2],
}

/// A batch of pixels, and what each of its bounces needs.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Batch {
    /// The first pixel.
    pub first: u32,
    /// Bounces, while there are rays.
    pub bounces: Vec<Needs>,
}

/// A whole frame, from the device's own rays.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// Bounce after bounce, all batches together.
    pub bounces: Vec<Bounce>,
    /// The picture.
    pub sums: Sums,
    /// What it takes to do it again ([`Timed`]).
    pub batches: Vec<Batch>,
}
