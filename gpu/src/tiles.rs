//! A-buffer by tiles on the device: triangles in bins, lists by tiles, in bands of rows.
//!
//! What comes out is that of [`crate::abuffer`], so that whoever compares need not know how the
//! lists were laid out. Twin: `spec/src/tiles.rs`.

mod attempt;
mod linked;
mod room;
mod timed;

use bytemuck::{Pod, Zeroable};
use triptych_spec::abuffer::Opaque;

use crate::abuffer::Abuffer;
use crate::error::GpuError;
use crate::frame::{Band, WORKGROUP};
use crate::raster::{Attempts, Rasterizer};
use attempt::Tried;
pub use timed::{Span, Timed};

/// Pixels along a side of a tile. Twin: `SIDE` in `tile.wgsl`.
pub const SIDE: u32 = 8;

/// Triangles in more tiles than this are shared by a workgroup. Twin: `FEW` in `bin.wgsl`.
pub const FEW: u32 = 8;

/// Bits of a triangle's number in a node of 16 bytes. Twin: `PRIM_BITS` in `tiles.wgsl`.
pub const PRIM_BITS: u32 = 24;

/// Triangles of a tile that one dispatch draws. llvmpipe leaves every loop of an invocation after
/// 65,535 iterations in all; a triangle takes one, 64 of them one more.
pub const DRAWN: u32 = 1 << 15;

/// What kernels of tiles are told. Twin: `Tiled` in `tile.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Tiled {
    /// Triangles, tiles, lists or entries of a dispatch.
    pub items: u32,
    /// 1: opaque triangles are drawn, 0: transparent ones.
    pub opaque: u32,
    /// Entries that there is room for; nodes, of each region.
    pub capacity: u32,
    /// The first triangle of each bin, or entry of each list, of a dispatch.
    pub first: u32,
    /// How many of them.
    pub count: u32,
    /// Entries in a row that are in order.
    pub run: u32,
    /// Workgroups that share the large triangles.
    pub groups: u32,
    /// Rounds of nearest layers, in a dispatch.
    pub rounds: u32,
}

/// How lists lie in memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layout {
    /// Runs of one array, 8 bytes a fragment, counted before they are filled (stage `blocks`).
    Blocks,
    /// Linked lists of 16-byte nodes, a counter and nodes of its own for each tile (stage
    /// `regions`).
    Regions,
}

/// What to draw, and how.
#[derive(Clone, Copy, Debug)]
pub struct Options<'a> {
    /// How lists are laid out.
    pub layout: Layout,
    /// The nearest opaque surface of each pixel.
    pub opaque: &'a Opaque,
    /// Drop fragments at or behind it.
    pub depth_test: bool,
    /// Linear background colour.
    pub background: [f32; 3],
    /// Fragments that the first attempt has room for, as far as they fit; nodes, of each tile of
    /// [`Layout::Regions`]. `None` leaves it to the host.
    pub capacity: Option<u32>,
    /// Triangles of a tile that one dispatch draws, at most [`DRAWN`].
    pub drawn: u32,
}

/// Draws the transparent triangles, in bands of rows.
///
/// # Errors
/// Limits by name, WGSL errors, and whatever the device reports.
pub fn run(rasterizer: &Rasterizer<'_>, options: Options<'_>) -> Result<Abuffer, GpuError> {
    let mut result = Abuffer::default();
    let need = room::need(options.layout);
    let mut attempts = Attempts::new(rasterizer.gpu, rasterizer.size, need, options.capacity);
    while let Some((band, capacity)) = attempts.next() {
        match attempt::run(rasterizer, &options, band, capacity) {
            Ok(Tried::Done(done)) => result.add(*done),
            Ok(Tried::Needs(nodes, stored)) => {
                attempts.overflowed(band, nodes)?;
                result.overflowed.extend(stored.map(|lists| (band, lists)));
            }
            Err(error) => attempts.failed(band, capacity, error)?,
        }
    }
    Ok(result)
}

/// Tiles of a band, across and down.
fn tiles(width: u32, band: Band) -> [u32; 2] {
    [width, band.rows].map(|side| side.div_ceil(SIDE))
}

/// Lists of a band: one for each pixel of each tile, beyond its edges as well.
fn lists(width: u32, band: Band) -> u32 {
    let [across, down] = tiles(width, band);
    across * down * WORKGROUP
}
