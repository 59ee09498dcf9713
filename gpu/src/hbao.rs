//! Ambient occlusion in screen space, for comparison: horizons over what one eye sees, which
//! knows nothing of what is hidden or outside the picture.
//!
//! After Bavoil, Sainz and Dimitrov (2008) and Jimenez, Wu, Pesce and Jarabo (2016): for each pixel
//! some slices through its view ray, each integrated in closed form between the horizons that
//! samples along it find. Samples get farther apart, and come from coarser levels of a
//! pyramid, the farther they are; a tile of 4 x 4 pixels turns its slices and moves its steps,
//! and a pass over pixels of the same surface takes the tile's mean. A sample at a distance
//! blocks as much as a hit at that distance does in layered depth maps.

mod screen;
mod turns;

use bytemuck::{Pod, Zeroable};
use triptych_spec::ldm::Falloff;

use crate::context::Gpu;
use crate::error::GpuError;
use crate::frame::WORKGROUP;
use crate::kernel::Kernels;
use crate::ready::Ready;
use crate::timer::Timer;

pub use screen::{Pixel, Screen};
pub use turns::{TURNED, turns};

/// Levels of the pyramid.
pub const LEVELS: usize = 8;

/// Most slices of a pixel.
pub const SLICES_MAX: u32 = 64;

/// Most samples of a pixel, `2 slices steps`; each is an iteration, which the rest of an
/// invocation has no more than nine times as many of: llvmpipe leaves loops after 65,535.
pub const SAMPLES_MAX: u32 = 1 << 12;

/// Most passes that denoise.
pub const DENOISE_MAX: u32 = 8;

/// Distances of 2^k pixels are read from level `k - DETAIL`, so that a sample is off its place by no
/// more than a sixteenth of its distance along x and y.
pub const DETAIL: u32 = 3;

/// What a kernel is told. Twin: `Sight` in `screen.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
struct Sight {
    width: u32,
    height: u32,
    slices: u32,
    steps: u32,
    scale: [f32; 2],
    inverse: [f32; 2],
    near: u32,
    power: u32,
    most: f32,
    detail: u32,
    items: u32,
    /// Up to a multiple of 16 bytes.
    unused: [u32; 3],
    /// One for each of [`LEVELS`].
    firsts: [u32; 8],
}

/// How much work a pixel is given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// What a distance does, as in layered depth maps; `None` looks as far as the picture goes.
    pub falloff: Falloff,
    /// Through the view ray of each pixel, 1 to [`SLICES_MAX`].
    pub slices: u32,
    /// Samples on either side of a slice, at least 1, and [`SAMPLES_MAX`] in all.
    pub steps: u32,
    /// Passes over pixels of the same surface, at most [`DENOISE_MAX`].
    pub denoise: u32,
    /// [`DETAIL`], or more for levels that begin farther away; 31: everything from the finest.
    pub detail: u32,
}

impl Settings {
    fn check(&self, adapter: &str) -> Result<(), GpuError> {
        let samples = 2 * u64::from(self.slices) * u64::from(self.steps);
        let power = match self.falloff {
            Falloff::None => 0,
            Falloff::Distance { power, .. } => power,
        };
        for (what, value, least, most) in [
            ("slices of a pixel", self.slices.into(), 1, SLICES_MAX),
            ("samples of a pixel", samples, 2, SAMPLES_MAX),
            ("passes that denoise", self.denoise.into(), 0, DENOISE_MAX),
            ("the falloff's power", power.into(), 0, 8),
            ("detail", self.detail.into(), 0, 31),
        ] {
            if !(least..=u64::from(most)).contains(&value) {
                return Err(GpuError::Limit {
                    adapter: adapter.to_owned(),
                    what,
                    needed: value,
                    limit: if value < least { least } else { most.into() },
                });
            }
        }
        Ok(())
    }
}

/// What is timed, in the order of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Span {
    /// The pyramid of depths.
    Prepare,
    /// What each pixel's own slices find.
    Horizons,
    /// Means over pixels of the same surface; left out without a pass.
    Denoise,
}

/// Buffers and passes, ready to run any number of times.
pub struct Hbao<'g> {
    gpu: &'g Gpu,
    spans: Vec<(Span, Vec<Ready>)>,
    opened: wgpu::Buffer,
    pixels: usize,
    /// Bytes of all that a run reads or writes, what is seen among it.
    pub bytes: u64,
}

impl<'g> Hbao<'g> {
    /// Uploads what is seen, and makes the passes.
    ///
    /// # Errors
    /// A setting beyond its limits, as one of the adapter's; whatever the device reports.
    ///
    /// # Panics
    /// If the screen does not have as many pixels as its size says, or none.
    pub fn new(
        gpu: &'g Gpu,
        kernels: &Kernels,
        screen: &Screen,
        settings: Settings,
    ) -> Result<Self, GpuError> {
        settings.check(&gpu.name)?;
        let pixels = screen.size.pixels();
        assert!(
            pixels > 0 && screen.pixels.len() == pixels,
            "{} pixels for {:?}",
            screen.pixels.len(),
            screen.size
        );
        let (told, texels) = told(screen, settings);
        let items = told.items;
        let each = |entry: &str, items: u32, buffers: &[(&str, &wgpu::Buffer)]| {
            ready((gpu, kernels), entry, Sight { items, ..told }, buffers)
        };
        let seen = gpu.upload("what is seen", &screen.pixels)?;
        let turns = gpu.upload("slices", &turns(settings.slices))?;
        let depths = gpu.storage("depths", 4 * u64::from(texels))?;
        let room = || gpu.storage("what is open", 4 * u64::from(items));
        let mut opened = room()?;
        let mut bytes = seen.size() + turns.size() + depths.size() + opened.size();
        let named = [("seen", &seen), ("pyramid", &depths)];
        let prepare = each("prepare", texels, &named)?;
        let named = [
            ("seen", &seen),
            ("turns", &turns),
            ("depths", &depths),
            ("opened", &opened),
        ];
        let horizons = each("horizons", items, &named)?;
        let mut spans = vec![
            (Span::Prepare, vec![prepare]),
            (Span::Horizons, vec![horizons]),
        ];
        if settings.denoise > 0 {
            let mut other = room()?;
            bytes += other.size();
            let mut passes = Vec::new();
            for _ in 0..settings.denoise {
                let named = [("seen", &seen), ("rough", &opened), ("opened", &other)];
                passes.push(each("denoise", items, &named)?);
                std::mem::swap(&mut opened, &mut other);
            }
            spans.push((Span::Denoise, passes));
        }
        Ok(Self {
            gpu,
            spans,
            opened,
            pixels,
            bytes,
        })
    }

    /// The parts, in the order in which they run.
    pub fn spans(&self) -> impl Iterator<Item = Span> {
        self.spans.iter().map(|(span, _)| *span)
    }

    /// Runs all passes, and waits for the end.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn run(&self) -> Result<(), GpuError> {
        let mut encoder = self.gpu.encoder();
        for pass in self.spans.iter().flat_map(|(_, passes)| passes) {
            pass.record(&mut encoder, None);
        }
        self.gpu.submit(encoder)
    }

    /// Runs all passes, and gives the seconds of each part; `timer` has a span for each.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn time(&self, timer: &Timer) -> Result<Vec<f64>, GpuError> {
        let count = u32::try_from(self.spans.len()).expect("at most three");
        timer.time(self.gpu, 0..count, |span, encoder, queries| {
            let passes = &self.spans[span as usize].1;
            for (number, pass) in passes.iter().enumerate() {
                let writes = queries.and_then(|q| q.writes(span, number, passes.len()));
                pass.record(encoder, writes);
            }
        })
    }

    /// What the last run found open of each pixel's hemisphere, weighted by the cosine: 1 for all
    /// of it, and where nothing is seen. Of few slices what is blocked can come to more than
    /// all; then it is 0.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn openness(&self) -> Result<Vec<f32>, GpuError> {
        let opened: Vec<f32> = self.gpu.read(&self.opened, self.pixels)?;
        Ok(opened.into_iter().map(|open| open.max(0.0)).collect())
    }
}

/// One invocation for each item, to be recorded.
fn ready(
    (gpu, kernels): (&Gpu, &Kernels),
    entry: &str,
    told: Sight,
    buffers: &[(&str, &wgpu::Buffer)],
) -> Result<Ready, GpuError> {
    let uniform = gpu.uniform("told", &told)?;
    let mut all = vec![("told", &uniform)];
    all.extend_from_slice(buffers);
    let groups = told.items.div_ceil(WORKGROUP);
    Ready::new(gpu, kernels, ("hbao", entry), groups, &all)
}

/// What kernels are told of pixels, and how many texels the pyramid has.
fn told(screen: &Screen, settings: Settings) -> (Sight, u32) {
    let (width, height) = (screen.size.width, screen.size.height);
    let mut texels = 0;
    let firsts = std::array::from_fn(|level| {
        let first = texels;
        let [w, h] = [width, height].map(|side| ((side - 1) >> level) + 1);
        texels += w * h;
        first
    });
    let (most, power) = match settings.falloff {
        Falloff::None => (0, 0),
        Falloff::Distance { most, power } => (most.max(1), power),
    };
    let told = Sight {
        width,
        height,
        slices: settings.slices,
        steps: settings.steps,
        scale: screen.scale,
        inverse: screen.scale.map(|scale| 1.0 / scale),
        near: screen.near.into(),
        power,
        most: most as f32,
        detail: settings.detail,
        items: width * height,
        unused: [0; 3],
        firsts,
    };
    (told, texels)
}
