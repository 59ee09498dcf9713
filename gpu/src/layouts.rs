//! The A-buffer's lists in other layouts on the device, from triangles and the opaque surfaces.
//!
//! Whatever the layout, lists come out as those of [`crate::abuffer`], so that whoever compares need not
//! know it. Twin: `spec/src/layouts.rs`.

mod arrays;
mod bucket;
pub mod memory;
mod ordered;
mod packed;
mod precalc;
mod ranges;
mod regions;
mod room;
mod shown;
mod timed;

use std::time::Duration;

use bytemuck::{Pod, Zeroable};
use triptych_spec::abuffer::{Lists, Opaque};
use triptych_spec::layouts::PRIMS_MAX;

use crate::abuffer::BandResult;
use crate::error::GpuError;
use crate::frame::Band;
use crate::pass::Pass;
use crate::raster::{Attempts, Need, Rasterizer};
pub use ordered::is_wide;
pub use shown::{BEGINS, ENDS, FOLLOWS, GOES_ON, SAMPLED};
pub use timed::{Span, Timed};

/// Entries of a pixel's array in the first attempt.
pub const ENTRIES: u32 = 8;

/// Regions of nodes, each with a counter.
pub const REGIONS: u32 = 64;

/// How lists lie in memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Layout {
    /// An array and a counter for each pixel: stages `bucket` and `rank`.
    Bucket,
    /// Runs of one array, counted first: stages `precalc` and `rank`.
    Precalc,
    /// Linked nodes of 16 bytes: stage `packed`.
    Packed,
    /// Linked nodes from several counters: stage `regions`.
    Regions,
    /// Linked nodes that are in order while they are built: stage `ordered`.
    Ordered,
}

impl Layout {
    /// All of them.
    pub const ALL: [Self; 5] = [
        Self::Bucket,
        Self::Precalc,
        Self::Packed,
        Self::Regions,
        Self::Ordered,
    ];

    /// Its name, which is that of the stage that builds it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Bucket => "bucket",
            Self::Precalc => "precalc",
            Self::Packed => "packed",
            Self::Regions => "regions",
            Self::Ordered => "ordered",
        }
    }

    /// The file that ships its kernels.
    pub fn file(self) -> &'static str {
        match self {
            Self::Bucket | Self::Precalc => "layouts",
            other => other.name(),
        }
    }
}

/// What kernels of a layout are told beside the frame. Twin: `Listing` in `listing.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Listing {
    /// Entries of each pixel's array; 0: runs of one array.
    pub entries: u32,
    /// Regions of nodes.
    pub regions: u32,
    /// Entries, or links, of a dispatch.
    pub items: u32,
    /// Entries in a row that are in order.
    pub run: u32,
    /// The first entry of each list that a dispatch blends.
    pub first: u32,
    /// Of a dispatch that blends.
    pub flags: u32,
    /// Key of the first entry of a pass's range,
    pub from_key: u32,
    /// and its triangle and mask.
    pub from_face: u32,
    /// Key of the first entry behind the range,
    pub until_key: u32,
    /// and its triangle and mask.
    pub until_face: u32,
    /// Heads of lists, before the links of nodes.
    pub links: u32,
    /// Layers of each list that are shown, the nearest ones.
    pub layers: u32,
    /// The first sample of each pixel in a dispatch that blends several,
    pub sample: u32,
    /// and how many.
    pub samples: u32,
}

/// What to draw, and how.
#[derive(Clone, Copy, Debug)]
pub struct Options<'a> {
    /// The nearest opaque surface at each sample.
    pub opaque: &'a Opaque,
    /// Drop fragments at or behind it.
    pub depth_test: bool,
    /// Linear background colour.
    pub background: [f32; 3],
    /// Nodes that the first attempt has room for, in all, as far as they fit; `None` leaves it to the
    /// host.
    pub capacity: Option<u32>,
    /// Most entries of each pixel's array, at least 1; `None`: as many as can be had. Longer lists are
    /// drawn in several ranges of depth.
    pub arrays: Option<u32>,
    /// Numbers of the nearest layers that are shown alone, each in a frame of its own after that of all.
    pub nearest: &'a [u32],
}

/// What came of a layout.
#[derive(Default)]
pub struct Built {
    /// Of each band its lists as they were built, and in order.
    pub bands: Vec<BandResult>,
    /// The lists of frames after the first, in the same buffers; only packed nodes have any.
    pub again: Vec<(Band, Lists)>,
    /// First attempts that did not fit, in order: the band, and what was stored.
    pub overflowed: Vec<(Band, Lists)>,
    /// The picture, row by row, blended in the order of the lists: the mean of several samples.
    pub image: Vec<[f32; 3]>,
    /// The same of so many nearest layers alone as [`Options::nearest`] says; none where lists must not be
    /// followed.
    pub nearest: Vec<Vec<[f32; 3]>>,
    /// Time of the stage that builds, without transfers and retries.
    pub build: Duration,
    /// Time of what orders and blends.
    pub finish: Duration,
    /// What was recorded of passes over triangles.
    pub passes: Vec<Pass>,
    /// Passes over ranges of depth, of the band with the most.
    pub ranges: u32,
    /// Entries of each pixel's array, of the band with the most.
    pub entries: u32,
}

impl Built {
    fn add(&mut self, part: Self) {
        self.bands.extend(part.bands);
        self.again.extend(part.again);
        self.overflowed.extend(part.overflowed);
        self.image.extend(part.image);
        self.nearest
            .resize(self.nearest.len().max(part.nearest.len()), Vec::new());
        for (all, band) in self.nearest.iter_mut().zip(part.nearest) {
            all.extend(band);
        }
        self.build += part.build;
        self.finish += part.finish;
        self.ranges = self.ranges.max(part.ranges);
        self.entries = self.entries.max(part.entries);
    }
}

/// What came of an attempt at a band.
enum Tried {
    /// Everything fitted.
    Done(Box<Built>),
    /// There was not enough room: the nodes that the next attempt is to have, and what was stored.
    Needs(u32, Option<Lists>),
}

/// Builds the lists of a whole target in a layout, in bands of rows; puts them in order, and blends them.
/// `inspect` gives the length of the longest of some lists, or `None` if they are too damaged to be
/// followed by a kernel; then there is no more of that band.
///
/// # Errors
/// More triangles than an entry has bits for, a list that an invocation has no steps for, and other limits,
/// by name; WGSL errors, and whatever the device reports.
pub fn run(
    rasterizer: &Rasterizer<'_>,
    layout: Layout,
    options: Options<'_>,
    is_opaque: impl Fn(u32) -> bool,
    inspect: impl Fn(&Lists) -> Option<u32>,
) -> Result<Built, GpuError> {
    check(rasterizer)?;
    rasterizer.take_passes();
    let mut built = Built::default();
    if layout == Layout::Bucket {
        for band in bucket::bands(rasterizer) {
            built.add(bucket::run(rasterizer, options, band, &is_opaque)?);
        }
        built.passes = rasterizer.take_passes();
        return Ok(built);
    }
    let need = need(rasterizer, layout);
    let capacity = options.capacity;
    let mut attempts = Attempts::new(rasterizer.gpu, rasterizer.size, need, capacity);
    while let Some((band, capacity)) = attempts.next() {
        let run = (band, capacity);
        let tried = match layout {
            Layout::Bucket | Layout::Precalc => {
                precalc::attempt(rasterizer, options, run, &is_opaque)
            }
            Layout::Packed => packed::attempt(rasterizer, options, run, &is_opaque, &inspect),
            Layout::Regions => regions::attempt(rasterizer, options, run, &is_opaque, &inspect),
            Layout::Ordered => ordered::attempt(rasterizer, options, run, &is_opaque),
        };
        match tried {
            Ok(Tried::Done(part)) => built.add(*part),
            Ok(Tried::Needs(nodes, stored)) => {
                attempts.overflowed(band, nodes)?;
                built.overflowed.extend(stored.map(|lists| (band, lists)));
            }
            Err(error) => attempts.failed(band, capacity, error)?,
        }
    }
    built.passes = rasterizer.take_passes();
    Ok(built)
}

/// Triangles share a word with masks.
fn check(rasterizer: &Rasterizer<'_>) -> Result<(), GpuError> {
    let (prims, most) = (rasterizer.prims(), PRIMS_MAX);
    if prims <= most {
        return Ok(());
    }
    Err(GpuError::Limit {
        adapter: rasterizer.gpu.name.clone(),
        what: "triangles beside a mask in a word",
        needed: prims.into(),
        limit: most.into(),
    })
}

/// What an attempt takes.
fn need(rasterizer: &Rasterizer<'_>, layout: Layout) -> Need {
    let samples = rasterizer.samples.count();
    Need {
        what: layout.name(),
        pixel: memory::of_pixel(layout, samples),
        node: memory::of_node(layout),
        pixels_max: room::pixels_max(rasterizer),
    }
}
