//! The frame of indirect light: how long it takes against how far it is from the picture
//! without noise.
//!
//! A frame is everything from snapped triangles and the blockers' corners to the picture; the
//! blockers' cells are built anew in it, as they are when blockers move. Not timed: transfers,
//! compilation, the host's part of drawing (transform, clip and snap).
//!
//! The reference is the same light transport with the scene's own kernel, Embree's occlusion of
//! every pixel's own rays, and no blur. Against it stand the pictures of coarser kernels, of a
//! coarser buffer B and of more blur. An adapter is measured only if what it made is what the spec
//! makes of the same surfaces, lights and places: each pixel of all stages but gather and block, of
//! which a sample of 4,096 pixels is looked at.

mod case;
mod front;
mod gpu;
mod judge;
mod run;
mod table;

use super::{Machine, Spread};

pub use front::svg;
pub use run::{Options, run};
pub use table::{csv, lines, page};

/// A scene that is not of the corpus: the paper's picture of 1024 x 768 pixels.
pub const PAPER: &str = include_str!("rsm/paper.toml");

/// The scenes of the corpus that are measured if none is asked for.
pub const SCENES: [&str; 2] = ["rsm/corner", "rsm/bunny"];

/// A run: where, and what was measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Frames {
    /// When, year-month-day.
    pub date: String,
    /// Where.
    pub machine: Machine,
    /// Rounds that counted.
    pub runs: u32,
    /// What was measured.
    pub rows: Vec<Row>,
    /// What was not, and why; whose clock is not the device's.
    pub remarks: Vec<String>,
}

/// A frame of one leg.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// `family/case`, or `paper`.
    pub scene: String,
    /// `spec` or `gpu@adapter`.
    pub leg: String,
    /// Whose clock: `device` or `host`.
    pub clock: &'static str,
    /// Texels of a kernel along a side.
    pub kernel: u32,
    /// Texels from one of the kernel to the next.
    pub stride: u32,
    /// Pixels to one of buffer B, along x and y.
    pub divisor: u32,
    /// Pixels of buffer B to each side that are averaged.
    pub blur: u32,
    /// Pixels of the picture.
    pub pixels: u64,
    /// Triangles that block rays.
    pub blockers: u64,
    /// Rays that were asked for.
    pub rays: u64,
    /// Milliseconds from the first pass to the end of the last.
    pub frame: Spread,
    /// Milliseconds of each part, timed by itself; none of the spec.
    pub parts: Vec<(&'static str, Spread)>,
    /// Root of the mean squared difference from the reference, linear, over all channels.
    pub rmse: f64,
    /// The largest difference of a channel.
    pub largest: f64,
    /// What an adapter's picture has of its own.
    pub own: Option<OfAdapter>,
}

/// What only an adapter's frame has.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OfAdapter {
    /// Bytes of the buffers that its stages share, the blockers and their grid among them.
    pub memory: u64,
    /// Pixels that are lit where the spec's are not, or the reverse, as its own points say.
    pub lit_otherwise: u64,
    /// The largest difference of a channel at all other pixels.
    pub largest_elsewhere: f64,
}

impl Frames {
    /// The stem of the files.
    pub fn stem(&self) -> String {
        format!("rsm-{}-{}", self.date, self.machine.slug)
    }
}
