//! Grids on the device: cells' lists, and rays through them.
//!
//! Each stage can be handed what the stage before should have made, or takes what this
//! device made of it. Twin: `spec/src/grid.rs`.

mod device;
mod room;
mod stages;
mod timed;

use bytemuck::{Pod, Zeroable};
use triptych_spec::grid::lattice::Point;
use triptych_spec::grid::ray::Ray;

pub use device::Device;
pub(crate) use room::Room;
pub use stages::Stages;
pub(crate) use stages::fresh;
pub use timed::{Shape, Span, Timed};

/// Kernels that put long lists in order.
const LONGEST: [&str; 2] = ["fill_runs", "fill_merge"];

/// Boxes of up to so many cells are gone through by one invocation. Twin: `SMALL` in
/// `sweep.wgsl`.
pub const SMALL: u32 = 64;

/// Cells of a larger box that a workgroup goes through. Twin: `CHUNK` in `sweep.wgsl`.
pub const CHUNK: u32 = 1024;

/// What an invocation does at most within a dispatch. Twin: `STEPS` in `cells.wgsl`.
pub const STEPS: u32 = 16_384;

/// A ray that has not started, and one that is done. Twins in `ray.wgsl`.
pub const FRESH: u32 = u32::MAX;
/// See [`FRESH`].
pub const TRACED: u32 = u32::MAX - 1;

/// What every kernel is told. Twin: `Cells` in `cells.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Cells {
    /// Cells along x.
    pub x: u32,
    /// Cells along y.
    pub y: u32,
    /// Cells along z.
    pub z: u32,
    /// 1: cells that a triangle does not touch, though its box does, drop it.
    pub overlap: u32,
    /// Triangles, chunks, cells, bricks, entries or rays of a dispatch.
    pub items: u32,
    /// Chunks of large boxes that there is room for.
    pub chunks: u32,
    /// Entries that there is room for.
    pub capacity: u32,
    /// Entries that are in order already, in a row.
    pub run: u32,
    /// 1 if the first triangle that blocks a ray ends its search, 0 for the nearest.
    pub any: u32,
    /// Up to a multiple of 16 bytes.
    pub unused: [u32; 7],
}

/// An entry of a linked list. Twin: `Entry` in `grid.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
pub struct Entry {
    /// The triangle.
    pub prim: u32,
    /// The next entry, or the end of the list.
    pub next: u32,
}

/// The paper's lists, as a device left them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Linked {
    /// First entry of each cell's list.
    pub heads: Vec<u32>,
    /// Entries by address, as many as the capacity.
    pub entries: Vec<Entry>,
    /// The counter.
    pub attempts: u32,
}

/// What a ray met. Twin: `Hit` in `ray.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct Hit {
    /// The triangle, or [`triptych_spec::abuffer::NOTHING`].
    pub prim: u32,
    /// When, if anything was met.
    pub time: f32,
    /// [`TRACED`], for rays that have been traced.
    pub state: u32,
    /// Where in a list the search stood.
    pub at: u32,
}

/// A ray as kernels read it. Twin: `Ray` in `ray.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub(crate) struct Packed {
    pub(crate) origin: [f32; 3],
    pub(crate) segment: u32,
    pub(crate) direction: [f32; 3],
    pub(crate) owner: u32,
}

impl From<&Ray> for Packed {
    fn from(ray: &Ray) -> Self {
        Self {
            origin: exact(ray.origin),
            segment: ray.segment.into(),
            direction: exact(ray.direction),
            owner: 0,
        }
    }
}

/// Rays on the device, what they have met, and how many there are: the first four words for a
/// dispatch, workgroups along three axes and rays.
#[derive(Clone, Copy)]
pub(crate) struct Counted<'b> {
    pub(crate) rays: &'b wgpu::Buffer,
    pub(crate) hits: &'b wgpu::Buffer,
    pub(crate) arguments: &'b wgpu::Buffer,
}

/// Lattice points have 24 bits, which `f32` holds.
pub(crate) fn exact(point: Point) -> [f32; 3] {
    point.map(|c| c as f32)
}

/// Back from there: what is no integer of at most 24 bits comes out as `i32::MIN`.
pub(crate) fn integers(point: [f32; 3]) -> Point {
    point.map(|c| {
        let whole = c.fract() == 0.0 && c.abs() <= 16_777_216.0;
        #[expect(clippy::cast_possible_truncation, reason = "an integer of 24 bits")]
        let integer = if whole { c as i32 } else { i32::MIN };
        integer
    })
}
