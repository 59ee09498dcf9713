//! A-buffer on the device: opaque, build, sort, resolve, in bands of rows.

mod attempt;

use std::time::Duration;

use triptych_spec::abuffer::{Lists, Opaque};

use crate::error::GpuError;
use crate::frame::Band;
use crate::raster::{Next, Rasterizer, after, first_capacity, nodes_max};
use attempt::{Buffers, HEADER, Run};
pub use attempt::{PROGRESS, STEPS};

/// Another leg's results in place of the stages before one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Given<'a> {
    /// The nearest opaque surface of each pixel.
    pub opaque: &'a Opaque,
    /// Lists of the whole target: built, or sorted as well.
    pub lists: &'a Lists,
    /// Whether they are sorted, so that only `resolve` runs.
    pub sorted: bool,
}

/// What to do and what to leave out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options<'a> {
    /// Start from these instead of from triangles.
    pub given: Option<Given<'a>>,
    /// Nodes of the first attempt, as far as the adapter can bind so many; `None`
    /// leaves it to the host.
    pub capacity: Option<u32>,
    /// Draw opaque triangles.
    pub opaque: bool,
    /// Build, sort and blend lists.
    pub lists: bool,
    /// Drop transparent fragments at or behind an opaque surface.
    pub depth_test: bool,
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
    /// The nearest opaque surface of each pixel.
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
    let size = rasterizer.size;
    let mut result = Abuffer::default();
    let mut capacity = match options.given {
        Some(given) => given.lists.attempts,
        None => options.capacity.unwrap_or_else(|| first_capacity(size)),
    };
    let mut bands = vec![Band::whole(size)];
    while let Some(band) = bands.pop() {
        if let (false, Some([upper, lower])) = (fits(rasterizer, band), band.halves()) {
            bands.extend([lower, upper]);
            continue;
        }
        capacity = capacity.min(nodes_max(rasterizer.gpu));
        let times = Times::default();
        let mut run = Run {
            rasterizer,
            options,
            band,
            capacity,
            times,
        };
        let buffers = run.buffers()?;
        run.fill(&buffers, &is_opaque)?;
        let built = run.lists(&buffers)?;
        match after(rasterizer.gpu, "build", band, built.attempts, capacity)? {
            Next::Done => {
                let longest = inspect(band, &built);
                result.finish(run, &buffers, built, longest)?;
            }
            Next::Resize(exact) => {
                result.overflowed.push((band, built));
                capacity = exact;
                bands.push(band);
            }
            Next::Split([upper, lower]) => {
                result.overflowed.push((band, built));
                bands.extend([lower, upper]);
            }
        }
    }
    Ok(result)
}

impl Abuffer {
    /// Adds a band whose lists are built: sorts and resolves them, unless any band's
    /// lists are damaged.
    fn finish(
        &mut self,
        mut run: Run<'_, '_>,
        buffers: &Buffers,
        built: Lists,
        longest: Option<u32>,
    ) -> Result<(), GpuError> {
        self.opaque.key.extend(run.read(&buffers.opaque_key)?);
        self.opaque.prim.extend(run.read(&buffers.opaque_prim)?);
        self.damaged |= longest.is_none();
        let mut sorted = None;
        if let (false, None, Some(longest)) = (self.damaged, self.endless, longest) {
            match run.finish(buffers, longest, &mut self.image) {
                Ok(lists) => sorted = Some(lists),
                Err(GpuError::Endless { stage, .. }) => self.endless = Some(stage),
                Err(error) => return Err(error),
            }
        }
        if sorted.is_none() {
            self.image.clear();
        }
        self.times.add(run.times);
        self.bands.push(BandResult {
            band: run.band,
            built,
            sorted,
        });
        Ok(())
    }
}

/// Whether a band's pixels fit a dispatch, and their largest buffer a binding. What
/// its nodes need shows when they are counted.
fn fits(rasterizer: &Rasterizer<'_>, band: Band) -> bool {
    let pixels = band.pixels(rasterizer.size);
    let bytes = HEADER + PROGRESS * u64::from(pixels);
    pixels <= PIXELS_MAX && bytes <= rasterizer.gpu.binding_limit()
}

/// Pixels that a dispatch of one workgroup row can serve.
const PIXELS_MAX: u32 = 65_535 * crate::frame::WORKGROUP;

impl Times {
    fn add(&mut self, other: Self) {
        self.opaque += other.opaque;
        self.build += other.build;
        self.sort += other.sort;
        self.resolve += other.resolve;
    }
}
