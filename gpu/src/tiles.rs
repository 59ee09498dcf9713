//! A-buffer by tiles on the device: triangles in bins, lists by tiles, in bands of rows.
//!
//! Lists come out as those of [`crate::abuffer`], so that whoever compares need not know how they
//! were laid out. Twin: `spec/src/tiles.rs`.

mod attempt;
mod banded;
mod linked;
mod lists;
mod local;
mod nodes;
mod pool;
mod room;
mod rows;
mod timed;

use std::time::Duration;

use bytemuck::{Pod, Zeroable};
use triptych_spec::abuffer::Opaque;
use triptych_spec::tiles::SIDE;

use crate::abuffer::BandResult;
use crate::error::GpuError;
use crate::frame::{Band, WORKGROUP};
use crate::raster::Rasterizer;
pub use banded::{Banded, Way};
pub use linked::{Linked, Region, run as run_linked};
pub use lists::{AS_IT_IS, IN_MEMORY};
pub use local::{FINISHED, Local, run as run_local};
pub use rows::{CONTIGUOUS, IN_ORDER, List};
pub use timed::Span;

/// Triangles of a tile that one dispatch draws. llvmpipe leaves every loop of an invocation after
/// 65,535 iterations in all; a triangle takes one, 64 of them one more.
pub const DRAWN: u32 = 1 << 15;

/// What kernels of tiles are told. Twin: `Tiled` in `tile.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Tiled {
    /// Triangles, tiles or lists of a dispatch.
    pub items: u32,
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
    /// Layers that are shown, at most.
    pub layers: u32,
    /// Whether lists are written back in order.
    pub stored: u32,
}

/// What to draw, and how.
#[derive(Clone, Copy, Debug)]
pub struct Options<'a> {
    /// The nearest opaque surface of each pixel.
    pub opaque: &'a Opaque,
    /// Drop fragments at or behind it.
    pub depth_test: bool,
    /// Linear background colour.
    pub background: [f32; 3],
    /// Fragments that the first attempt has room for, as far as they fit; `None` leaves it to the
    /// host.
    pub capacity: Option<u32>,
    /// Triangles of a tile that one dispatch draws, at most [`DRAWN`].
    pub drawn: u32,
}

/// What came out of all bands.
#[derive(Default)]
pub struct Drawn {
    /// Of each band, where the bins of its tiles begin, and the triangles in them.
    pub bins: Vec<(Band, Vec<u32>, Vec<u32>)>,
    /// Of each band, its lists as they were filled, and in order.
    pub bands: Vec<BandResult>,
    /// The picture, row by row.
    pub image: Vec<[f32; 3]>,
    /// Time of each stage on the device, without transfers and retries.
    pub times: Times,
}

/// Device time per stage.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Times {
    /// Stage bin.
    pub bin: Duration,
    /// Stage jagged.
    pub jagged: Duration,
    /// Stage shade.
    pub shade: Duration,
}

/// Draws the transparent triangles, in bands of rows.
///
/// # Errors
/// Limits by name, WGSL errors, and whatever the device reports.
pub fn run(rasterizer: &Rasterizer<'_>, options: Options<'_>) -> Result<Drawn, GpuError> {
    let mut result = Drawn::default();
    let draw = |band, capacity| attempt::run(rasterizer, &options, band, capacity);
    let add = |part| result.add(part);
    let need = room::need(rasterizer);
    attempt::in_bands(rasterizer, need, options.capacity, draw, add)?;
    Ok(result)
}

impl Drawn {
    /// Adds a band.
    fn add(&mut self, part: Self) {
        self.bins.extend(part.bins);
        self.bands.extend(part.bands);
        self.image.extend(part.image);
        self.times.bin += part.times.bin;
        self.times.jagged += part.times.jagged;
        self.times.shade += part.times.shade;
    }
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
