//! A-buffer on the device: opaque, build, sort, resolve, in bands of rows.

mod attempt;
mod buffers;
mod multisample;
pub mod rivals;
mod stages;
mod timed;

use std::time::Duration;

use triptych_spec::abuffer::{Lists, Opaque, Order};

use crate::error::GpuError;
use crate::frame::Band;
use crate::pass::Pass;
use crate::raster::{Attempts, Rasterizer};
pub use attempt::STEPS;
pub(crate) use attempt::dispatches;
use attempt::{Done, Run, Tried};
pub use buffers::{NODE, PROGRESS, bytes};
pub use stages::{Stage, Stages};
pub use timed::{KEPT_MAX, Part, Timed, can_keep, with_layers};

/// Another leg's results in place of the stages before one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Given<'a> {
    /// The nearest opaque surface of each pixel.
    pub opaque: &'a Opaque,
    /// Lists of the whole target: built, or sorted as well. `None`: `build` is first.
    pub lists: Option<&'a Lists>,
    /// Whether they are sorted, so that only `resolve` runs.
    pub sorted: bool,
}

/// What to do and what to leave out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options<'a> {
    /// Start from these instead of from triangles.
    pub given: Option<Given<'a>>,
    /// Nodes of the first attempt, as far as they fit; `None` leaves it to the host.
    pub capacity: Option<u32>,
    /// Draw opaque triangles.
    pub opaque: bool,
    /// Build, sort and blend lists.
    pub lists: bool,
    /// Drop transparent fragments at or behind an opaque surface.
    pub depth_test: bool,
    /// In which order layers lie at each sample, where pixels have several.
    pub order: Order,
    /// Shade pixels once whose samples are all alike.
    pub once: bool,
    /// Linear background colour.
    pub background: [f32; 3],
}

/// A band as it came out. Pixels count from the band's first row.
pub struct BandResult {
    /// Which rows.
    pub band: Band,
    /// Heads and nodes after `build`.
    pub built: Lists,
    /// The same after `sort`; `None` if the lists were found damaged before.
    pub sorted: Option<Lists>,
}

/// The A-buffer of a whole target.
#[derive(Default)]
pub struct Abuffer {
    /// The nearest opaque surface at each sample.
    pub opaque: Opaque,
    /// The bands, from top to bottom.
    pub bands: Vec<BandResult>,
    /// Attempts that did not fit, in order: the band, and what was stored.
    pub overflowed: Vec<(Band, Lists)>,
    /// The picture, row by row; empty if any band could not be finished.
    pub image: Vec<[f32; 3]>,
    /// Time of each stage on the device, without transfers and retries.
    pub times: Times,
    /// Some band's lists were found damaged; nothing is sorted from there on.
    pub damaged: bool,
    /// The stage that followed a list without coming to its end.
    pub endless: Option<&'static str>,
    /// What was recorded.
    pub passes: Vec<Pass>,
}

/// Device time per stage.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Times {
    /// Both passes of stage opaque.
    pub opaque: Duration,
    /// Stage build.
    pub build: Duration,
    /// Stage sort.
    pub sort: Duration,
    /// Stage resolve.
    pub resolve: Duration,
}

/// Runs the whole family. `is_opaque` sorts the triangles into the two passes;
/// `inspect` sees each band's lists after `build` and gives the length of the
/// longest, or `None` if they are too damaged to be followed by a kernel.
///
/// # Errors
/// Limits by name, WGSL errors, and whatever the device reports.
pub fn run(
    rasterizer: &Rasterizer<'_>,
    options: Options<'_>,
    is_opaque: impl Fn(u32) -> bool,
    mut inspect: impl FnMut(Band, &Lists) -> Option<u32>,
) -> Result<Abuffer, GpuError> {
    let mut result = Abuffer::default();
    rasterizer.take_passes();
    let mut attempts = attempts(rasterizer, options);
    while let Some((band, capacity)) = attempts.next() {
        let run = Run {
            rasterizer,
            options,
            band,
            capacity,
            times: Times::default(),
        };
        let follow = !result.damaged && result.endless.is_none();
        match run.attempt(&is_opaque, |lists| inspect(band, lists), follow) {
            Ok(Tried::Done(done)) => result.add(*done),
            Ok(Tried::Overflowed(lists)) => {
                attempts.overflowed(band, lists.attempts)?;
                result.overflowed.push((band, lists));
            }
            Err(error) => attempts.failed(band, capacity, error)?,
        }
    }
    result.passes = rasterizer.take_passes();
    Ok(result)
}

/// What to attempt: given lists take exactly their room, others are yet to be counted.
fn attempts(rasterizer: &Rasterizer<'_>, options: Options<'_>) -> Attempts {
    let Rasterizer { gpu, size, .. } = *rasterizer;
    let need = buffers::need_of(gpu, rasterizer.samples.count());
    if let Some(lists) = options.given.and_then(|given| given.lists) {
        let rows = buffers::nodes_of_rows(lists, size.width);
        return Attempts::new(gpu, size, need, None).with_rows(rows);
    }
    let capacity = if options.lists {
        options.capacity
    } else {
        Some(0)
    };
    Attempts::new(gpu, size, need, capacity)
}

impl Abuffer {
    /// Adds a band. There is no picture unless every band has its part.
    fn add(&mut self, done: Done) {
        self.opaque.key.extend(done.opaque.key);
        self.opaque.prim.extend(done.opaque.prim);
        self.damaged |= done.damaged;
        self.endless = self.endless.or(done.endless);
        self.image.extend(done.image);
        if done.band.sorted.is_none() {
            self.image.clear();
        }
        self.times.add(done.times);
        self.bands.push(done.band);
    }
}

impl Times {
    fn add(&mut self, other: Self) {
        self.opaque += other.opaque;
        self.build += other.build;
        self.sort += other.sort;
        self.resolve += other.resolve;
    }
}
