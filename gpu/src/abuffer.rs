//! A-buffer on the device: opaque, build, sort, resolve, in bands of rows.

use std::ops::ControlFlow;
use std::time::Duration;

use triptych_spec::abuffer::{EOL, Lists, NOTHING, Node, Opaque};

use crate::context::Gpu;
use crate::error::GpuError;
use crate::frame::{Band, Frame};
use crate::raster::{Next, Rasterizer, after, first_capacity, nodes_max, per_pixel};

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

/// Buffers of a band.
struct Buffers {
    counter: wgpu::Buffer,
    opaque_key: wgpu::Buffer,
    opaque_prim: wgpu::Buffer,
    heads: wgpu::Buffer,
    nodes: wgpu::Buffer,
    colours: wgpu::Buffer,
    picture: wgpu::Buffer,
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

/// Steps along a list within one dispatch. Twin: `STEPS` in `abuffer.wgsl`.
pub const STEPS: u64 = 16_384;

/// Bytes of a pixel's progress. Twin: `Progress` in `abuffer.wgsl`.
pub const PROGRESS: u64 = 32;

/// Whether a band's pixels fit a dispatch, and their largest buffer a binding. What
/// its nodes need shows when they are counted.
fn fits(rasterizer: &Rasterizer<'_>, band: Band) -> bool {
    let pixels = band.pixels(rasterizer.size);
    let bytes = HEADER + PROGRESS * u64::from(pixels);
    pixels <= PIXELS_MAX && bytes <= rasterizer.gpu.binding_limit()
}

/// Bytes before the pixels' progress. Twin: `Work` in `abuffer.wgsl`.
const HEADER: u64 = 4;

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

/// One attempt at one band.
struct Run<'r, 'g> {
    rasterizer: &'r Rasterizer<'g>,
    options: Options<'r>,
    band: Band,
    capacity: u32,
    times: Times,
}

impl Run<'_, '_> {
    fn gpu(&self) -> &Gpu {
        self.rasterizer.gpu
    }

    fn buffers(&self) -> Result<Buffers, GpuError> {
        let gpu = self.gpu();
        let pixels = self.band.pixels(self.rasterizer.size);
        let picture = gpu.storage("picture", 16 * u64::from(pixels))?;
        if let Some(given) = self.options.given {
            return self.buffers_from(given, picture);
        }
        let capacity = if self.options.lists {
            u64::from(self.capacity)
        } else {
            0
        };
        Ok(Buffers {
            counter: gpu.filled("counter", 1, 0)?,
            opaque_key: gpu.filled("opaque_key", pixels, NOTHING)?,
            opaque_prim: gpu.filled("opaque_prim", pixels, NOTHING)?,
            heads: gpu.filled("heads", pixels, EOL)?,
            nodes: gpu.storage("nodes", 16 * capacity)?,
            colours: gpu.storage("colours", 16 * capacity)?,
            picture,
        })
    }

    fn buffers_from(&self, given: Given<'_>, picture: wgpu::Buffer) -> Result<Buffers, GpuError> {
        let gpu = self.gpu();
        let width = self.rasterizer.size.width;
        let first = (self.band.first * width) as usize;
        let pixels = first..first + self.band.pixels(self.rasterizer.size) as usize;
        let lists = given.lists;
        let nodes: Vec<[u32; 4]> = lists
            .nodes
            .iter()
            .map(|n| [n.key, n.next, n.prim, n.mask])
            .collect();
        Ok(Buffers {
            counter: gpu.filled("counter", 1, lists.attempts)?,
            opaque_key: gpu.upload("opaque_key", &given.opaque.key[pixels.clone()])?,
            opaque_prim: gpu.upload("opaque_prim", &given.opaque.prim[pixels.clone()])?,
            heads: gpu.upload("heads", &lists.heads[pixels])?,
            nodes: gpu.upload("nodes", &nodes)?,
            colours: gpu.upload("colours", &lists.colours)?,
            picture,
        })
    }

    fn frame(&self) -> Frame {
        let [r, g, b] = self.options.background;
        Frame {
            capacity: self.capacity,
            depth_test: u32::from(self.options.depth_test),
            background: [r, g, b, 1.0],
            ..self.rasterizer.frame(self.band)
        }
    }

    fn opaque(&mut self, b: &Buffers, is_opaque: &impl Fn(u32) -> bool) -> Result<(), GpuError> {
        let work = self.rasterizer.work(self.band, is_opaque)?;
        for stage in ["opaque_nearest", "opaque_first"] {
            let buffers = b.named();
            self.times.opaque +=
                self.rasterizer
                    .draw("abuffer", stage, self.frame(), &work, &buffers)?;
        }
        Ok(())
    }

    fn build(&mut self, b: &Buffers, is_opaque: &impl Fn(u32) -> bool) -> Result<(), GpuError> {
        let work = self.rasterizer.work(self.band, |prim| !is_opaque(prim))?;
        let buffers = b.named();
        self.times.build =
            self.rasterizer
                .draw("abuffer", "build", self.frame(), &work, &buffers)?;
        Ok(())
    }

    /// Sorts and resolves; gives the sorted lists and appends to the picture.
    fn finish(&mut self, b: &Buffers, image: &mut Vec<[f32; 3]>) -> Result<Lists, GpuError> {
        if self.options.lists && !self.options.given.is_some_and(|g| g.sorted) {
            self.times.sort = self.until_done("sort", b)?;
        }
        self.times.resolve = self.until_done("resolve", b)?;
        let pixels = self.band.pixels(self.rasterizer.size) as usize;
        let picture = self.gpu().read::<[f32; 4]>(&b.picture, pixels)?;
        image.extend(picture.into_iter().map(|[r, g, b, _]| [r, g, b]));
        self.lists(b)
    }

    /// Dispatches a stage until no pixel asks for more. Merging a list of n nodes
    /// takes at most 4 n steps in each of at most 32 passes; what needs more
    /// follows a list that does not end.
    fn until_done(&self, stage: &'static str, b: &Buffers) -> Result<Duration, GpuError> {
        let gpu = self.gpu();
        let pixels = u64::from(self.band.pixels(self.rasterizer.size));
        let progress = gpu.storage("progress", HEADER + PROGRESS * pixels)?;
        let mut buffers = b.named().to_vec();
        buffers.push(("progress", &progress));
        let mut time = Duration::ZERO;
        for _ in 0..=4 * 32 * u64::from(self.capacity) / STEPS {
            gpu.queue.write_buffer(&progress, 0, &[0; 4]);
            time += per_pixel(self.rasterizer, "abuffer", stage, self.frame(), &buffers)?;
            if gpu.read::<u32>(&progress, 1)?[0] == 0 {
                return Ok(time);
            }
        }
        Err(GpuError::Endless {
            adapter: gpu.name.clone(),
            stage,
        })
    }

    fn lists(&self, b: &Buffers) -> Result<Lists, GpuError> {
        let gpu = self.gpu();
        let attempts = gpu.read::<u32>(&b.counter, 1)?[0];
        let stored = attempts.min(self.capacity) as usize;
        let node = |[key, next, prim, mask]: [u32; 4]| Node {
            key,
            next,
            prim,
            mask,
        };
        Ok(Lists {
            heads: self.read(&b.heads)?,
            nodes: gpu
                .read::<[u32; 4]>(&b.nodes, stored)?
                .into_iter()
                .map(node)
                .collect(),
            colours: gpu.read(&b.colours, stored)?,
            attempts,
            capacity: self.capacity,
        })
    }

    /// One word per pixel of the band.
    fn read(&self, buffer: &wgpu::Buffer) -> Result<Vec<u32>, GpuError> {
        self.gpu()
            .read(buffer, self.band.pixels(self.rasterizer.size) as usize)
    }
}

impl Buffers {
    fn named(&self) -> [(&'static str, &wgpu::Buffer); 7] {
        [
            ("counter", &self.counter),
            ("opaque_key", &self.opaque_key),
            ("opaque_prim", &self.opaque_prim),
            ("heads", &self.heads),
            ("nodes", &self.nodes),
            ("colours", &self.colours),
            ("picture", &self.picture),
        ]
    }
}
