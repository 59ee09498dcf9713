//! Layered depth maps on the device: lists of all depths, and what is seen through them.
//!
//! Each stage can be handed what the stage before should have made, or takes what this device
//! made of it. Twin: `spec/src/ldm.rs`.

mod batch;
mod device;
mod light;
mod lists;
mod mirror;
mod stages;
mod timed;

use bytemuck::{Pod, Zeroable};
use triptych_spec::grid::lattice::Point;
use triptych_spec::ldm;

pub use light::irradiance;
pub use stages::Stages;
pub use timed::{ChainSpan, Question, Span, Timed, TimedChains};

/// Maps of a workgroup that draws small triangles. Twin: `MAPS_AT_ONCE` in `cover.wgsl`.
pub const MAPS_AT_ONCE: u32 = 8;

/// Large triangles of a workgroup. Twin: `LARGE_AT_ONCE` in `cover.wgsl`.
pub const LARGE_AT_ONCE: u32 = 16;

/// What kernels are told. Twin: `Told` in `maps.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Told {
    /// Sub-pixel bits.
    pub bits: u32,
    /// By how much dot products with a map's first two rows are shifted down.
    pub shift: u32,
    /// Keys of half a pixel at a slope of one.
    pub half: u32,
    /// And the bits that were shifted out.
    pub half_shift: u32,
    /// First map of a dispatch.
    pub first_map: u32,
    /// How many maps it is about.
    pub maps: u32,
    /// The first pixel, of all maps', that a batch's lists begin with.
    pub first_pixel: u32,
    /// Lists of a batch.
    pub pixels: u32,
    /// Triangles.
    pub triangles: u32,
    /// Pixels, keys or receivers of a dispatch.
    pub items: u32,
    /// First row of each map that is drawn.
    pub first_row: u32,
    /// How many rows are.
    pub rows: u32,
    /// Keys that there is room for.
    pub capacity: u32,
    /// Keys that are in order already, in a row.
    pub run: u32,
    /// Keys from which on nothing blocks; 0: all hits block.
    pub most: u32,
    /// The power of what a hit lets pass.
    pub power: u32,
    /// The lowest corner of the box that is drawn, along x.
    pub low_x: i32,
    /// Along y.
    pub low_y: i32,
    /// Along z.
    pub low_z: i32,
    /// The longest side of a small triangle's box on the lattice.
    pub small: i32,
    /// How many triangles are large.
    pub larges: u32,
}

/// A map as kernels read it. Twin: `Map` in `maps.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
struct Packed {
    columns: Point,
    width: u32,
    rows: Point,
    height: u32,
    depths: Point,
    first: u32,
    planes: [[i32; 4]; 3],
    about: [[f32; 4]; 2],
}

impl Packed {
    /// `low` is the lowest corner of what is drawn.
    fn new(map: &ldm::Map, shift: u32, low: Point) -> Self {
        let [columns, rows, depths] = map.rows;
        let plane = |axis: usize| {
            let [x, y, z] = map.planes[axis];
            [x, y, z, map.origin[axis]]
        };
        Self {
            columns,
            width: map.size.width,
            rows,
            height: map.size.height,
            depths,
            first: map.first,
            planes: [0, 1, 2].map(plane),
            about: [0, 1].map(|axis| about(map.rows[axis], shift, low, map.origin[axis])),
        }
    }
}

/// A row of a map in sub-pixels, and where a point is along it from the map's origin, in `f32`.
fn about(row: Point, shift: u32, point: Point, origin: i32) -> [f32; 4] {
    let products = row.iter().zip(point);
    let products = products.map(|(r, p)| i64::from(*r) * i64::from(p));
    let unit = (1_u64 << shift) as f64;
    // Below 2^54: rounding to f64 moves it by less than 2^-27 of a sub-pixel.
    let place = products.sum::<i64>() as f64 / unit - f64::from(origin);
    #[expect(clippy::cast_possible_truncation, reason = "rounding is meant")]
    let rounded = |x: f64| x as f32;
    let [x, y, z] = row.map(|c| rounded(f64::from(c) / unit));
    [x, y, z, rounded(place)]
}

/// A receiver as kernels read it. Twin: `Receiver` in `receiver.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
struct Receiver {
    point: Point,
    off: u32,
    normal: Point,
    unused: u32,
}

impl From<&ldm::Receiver> for Receiver {
    fn from(receiver: &ldm::Receiver) -> Self {
        Self {
            point: receiver.point,
            off: receiver.off,
            normal: receiver.normal,
            unused: 0,
        }
    }
}

/// What is before and behind a receiver. Twin: `Hits` in `opened.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
struct Hits {
    key: i32,
    before: u32,
    behind: u32,
}

impl From<Hits> for ldm::Hits {
    fn from(hits: Hits) -> Self {
        let some = |key: u32| (key != triptych_spec::abuffer::NOTHING).then_some(key);
        Self {
            key: hits.key,
            before: some(hits.before),
            behind: some(hits.behind),
        }
    }
}

/// What of a receiver's directions is open. Twin: `Open` in `opened.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Open {
    /// The sum of the weights of directions that nothing blocks.
    pub whole: u32,
    /// The sum of the weights that what blocks lets pass.
    pub part: f32,
}

/// An entry of a linked list. Twin: `Link` in `ldm.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
pub struct Link {
    /// Depth key.
    pub key: u32,
    /// The next entry, or the end of the list.
    pub next: u32,
}

/// The paper's lists, as a device left them.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Chains {
    /// First entry of the list of each pixel of all maps.
    pub heads: Vec<u32>,
    /// Entries by address, as many as had one.
    pub links: Vec<Link>,
    /// How often an address was asked for.
    pub attempts: u64,
}
