//! A-buffer on the device: opaque, build, sort, resolve, in bands of rows.

mod attempt;

use std::ops::ControlFlow;
use std::time::Duration;

use triptych_spec::abuffer::{Lists, Opaque};

use crate::error::GpuError;
use crate::frame::Band;
use crate::raster::{Next, Rasterizer, after, first_capacity, nodes_max};
use attempt::{HEADER, Run};
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
pub struct Abuffer {
    /// The nearest opaque surface of each pixel.
    pub opaque: Opaque,
    /// The bands, from top to bottom.
    pub bands: Vec<BandResult>,
    /// Attempts that did not fit, in order: the band, and what was stored.
    pub overflowed: Vec<(Band, Lists)>,
    /// The picture, row by row; empty if the lists were found damaged.
    pub image: Vec<[f32; 3]>,
    /// Time of each stage on the device, without transfers and retries.
    pub times: Times,
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
/// `inspect` sees each band's lists after `build` and says whether they are sound
/// enough to be followed by a kernel.
///
/// # Errors
/// Limits by name, WGSL errors, and whatever the device reports.
pub fn run(
    rasterizer: &Rasterizer<'_>,
    options: Options<'_>,
    is_opaque: impl Fn(u32) -> bool,
    mut inspect: impl FnMut(Band, &Lists) -> ControlFlow<()>,
) -> Result<Abuffer, GpuError> {
    let size = rasterizer.size;
    let mut result = Abuffer {
        opaque: Opaque {
            key: Vec::new(),
            prim: Vec::new(),
        },
        bands: Vec::new(),
        overflowed: Vec::new(),
        image: Vec::new(),
        times: Times::default(),
    };
    let mut capacity = match options.given {
        Some(given) => given.lists.attempts,
        None => options.capacity.unwrap_or_else(|| first_capacity(size)),
    };
    let mut sound = true;
    let mut bands = vec![Band::whole(size)];
    while let Some(band) = bands.pop() {
        if let (false, Some([upper, lower])) = (fits(rasterizer, band), band.halves()) {
            bands.extend([lower, upper]);
            continue;
        }
        capacity = capacity.min(nodes_max(rasterizer.gpu));
        let mut run = Run {
            rasterizer,
            options,
            band,
            capacity,
            times: Times::default(),
        };
        let buffers = run.buffers()?;
        if options.opaque && options.given.is_none() {
            run.opaque(&buffers, &is_opaque)?;
        }
        if options.lists && options.given.is_none() {
            run.build(&buffers, &is_opaque)?;
        }
        let built = run.lists(&buffers)?;
        match after(rasterizer.gpu, "build", band, built.attempts, capacity)? {
            Next::Done => {}
            Next::Resize(exact) => {
                result.overflowed.push((band, built));
                capacity = exact;
                bands.push(band);
                continue;
            }
            Next::Split([upper, lower]) => {
                result.overflowed.push((band, built));
                bands.extend([lower, upper]);
                continue;
            }
        }
        result.opaque.key.extend(run.read(&buffers.opaque_key)?);
        result.opaque.prim.extend(run.read(&buffers.opaque_prim)?);
        sound &= inspect(band, &built).is_continue();
        let sorted = if sound {
            Some(run.finish(&buffers, &mut result.image)?)
        } else {
            None
        };
        result.times.add(run.times);
        result.bands.push(BandResult {
            band,
            built,
            sorted,
        });
    }
    Ok(result)
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
