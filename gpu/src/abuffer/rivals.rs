//! Techniques that need no lists, the rivals of the A-buffer: each is set up once, and its
//! passes may be recorded any number of times.
//!
//! Yang, Hensley, Grün and Thibieroz (2010), section 2, table 1 and figure 4.

mod following;
mod once;
mod peeling;
mod peels;
mod reduced;
mod targets;

use std::time::{Duration, Instant};

use triptych_spec::abuffer::{Lists, Node, Opaque, Sorted};

use crate::context::Gpu;
use crate::error::GpuError;
use crate::frame::{Band, Frame};
use crate::pass::Pass;
use crate::raster::{Rasterizer, Ready};
pub use following::{Following, Shading, follow};
pub use once::{Once, Single, once};
pub use peeling::{Peeling, Technique, is_wide};
pub use peels::peel;
pub use reduced::{Low, Reduced, Reducing, reduce};

/// What rivals are given.
#[derive(Clone, Copy)]
pub struct Given<'a> {
    /// The nearest opaque surface of each pixel of the target.
    pub opaque: &'a Opaque,
    /// Linear background colour.
    pub background: [f32; 3],
}

/// What came of a rival.
#[derive(Default)]
pub struct Rival {
    /// The picture, row by row.
    pub image: Vec<[f32; 3]>,
    /// The fragments that were peeled, nearest first; empty lists where none are.
    pub sorted: Sorted,
    /// Fragments that the device counted as it peeled them.
    pub counted: u64,
    /// Time on the device, without transfers.
    pub time: Duration,
    /// What was recorded.
    pub passes: Vec<Pass>,
    /// Bytes of its buffers and targets, those of the largest band.
    pub bytes: u64,
    /// Layers that it recorded: times that the triangles were gone through.
    pub layers: u32,
}

/// The opaque surfaces behind all samples of a band on the device.
pub struct Surfaces {
    key: wgpu::Buffer,
    prim: wgpu::Buffer,
}

impl Surfaces {
    /// The surfaces of a band.
    ///
    /// # Errors
    /// What the device refuses.
    pub fn upload(
        rasterizer: &Rasterizer<'_>,
        opaque: &Opaque,
        band: Band,
    ) -> Result<Self, GpuError> {
        let gpu = rasterizer.gpu;
        let each = rasterizer.samples.count() as usize;
        let first = each * (band.first * rasterizer.size.width) as usize;
        let samples = first..first + each * band.pixels(rasterizer.size) as usize;
        Ok(Self {
            key: gpu.upload("opaque_key", &opaque.key[samples.clone()])?,
            prim: gpu.upload("opaque_prim", &opaque.prim[samples])?,
        })
    }

    /// Those that another technique found, in its buffers.
    pub fn of(key: &wgpu::Buffer, prim: &wgpu::Buffer) -> Self {
        Self {
            key: key.clone(),
            prim: prim.clone(),
        }
    }

    pub(crate) fn named(&self) -> [(&'static str, &wgpu::Buffer); 2] {
        [("opaque_key", &self.key), ("opaque_prim", &self.prim)]
    }
}

/// Pixels that a dispatch of one workgroup row can serve.
const PIXELS_MAX: u64 = 65_535 * crate::frame::WORKGROUP as u64;

/// The whole target, or bands of it, top to bottom, of which a pixel takes up to `bytes` in a
/// buffer.
fn bands(rasterizer: &Rasterizer<'_>, bytes: u64) -> Vec<Band> {
    let most = PIXELS_MAX.min(rasterizer.gpu.binding_limit() / bytes);
    // A single row that is too much is refused by the buffer's name.
    Band::of_pixels(rasterizer.size, most)
}

fn frame(rasterizer: &Rasterizer<'_>, band: Band, [r, g, b]: [f32; 3]) -> Frame {
    Frame {
        background: [r, g, b, 1.0],
        ..rasterizer.frame(band)
    }
}

/// The whole target, and its pixels, for what has no bands.
fn whole(rasterizer: &Rasterizer<'_>) -> Result<(Band, u64), GpuError> {
    let band = Band::whole(rasterizer.size);
    let pixels = u64::from(band.pixels(rasterizer.size));
    if pixels > PIXELS_MAX {
        return Err(GpuError::Limit {
            adapter: rasterizer.gpu.name.clone(),
            what: "a whole target",
            needed: pixels,
            limit: PIXELS_MAX,
        });
    }
    Ok((band, pixels))
}

/// Sorted lists that are only read, and where each pixel stands in its own; twin: `sorted.wgsl`.
fn read_lists(gpu: &Gpu, lists: &Lists, pixels: u64) -> Result<Vec<Buffer>, GpuError> {
    let node = |n: &Node| [n.key, n.next, n.prim, n.mask];
    let nodes: Vec<[u32; 4]> = lists.nodes.iter().map(node).collect();
    Ok(vec![
        ("heads", gpu.upload("heads", &lists.heads)?),
        ("nodes", gpu.upload("nodes", &nodes)?),
        ("picture", gpu.storage("picture", 16 * pixels)?),
        ("cursors", gpu.storage("cursors", 4 * pixels)?),
        ("unfinished", gpu.storage("unfinished", 4)?),
    ])
}

/// A buffer by the name of its variable.
type Buffer = (&'static str, wgpu::Buffer);

fn by_name<'b>(buffers: &'b [Buffer], name: &str) -> &'b wgpu::Buffer {
    let found = buffers.iter().find(|(other, _)| *other == name);
    &found.expect("it was made for the kernels").1
}

/// Runs passes over lists. What needs another dispatch says so in the last.
fn run_through<'p>(
    rasterizer: &Rasterizer<'_>,
    passes: impl Iterator<Item = &'p Ready>,
    unfinished: &wgpu::Buffer,
    stage: &'static str,
) -> Result<Duration, GpuError> {
    let gpu = rasterizer.gpu;
    let mut encoder = gpu.encoder();
    for pass in passes {
        encoder.clear_buffer(unfinished, 0, None);
        rasterizer.record(std::slice::from_ref(pass), &mut encoder);
    }
    let start = Instant::now();
    gpu.submit(encoder)?;
    let time = start.elapsed();
    match gpu.word(unfinished, 0)? {
        0 => Ok(time),
        _ => Err(GpuError::Endless {
            adapter: gpu.name.clone(),
            stage,
        }),
    }
}

/// The picture of so many pixels.
pub(crate) fn image(
    gpu: &Gpu,
    picture: &wgpu::Buffer,
    pixels: u32,
) -> Result<Vec<[f32; 3]>, GpuError> {
    let picture: Vec<[f32; 4]> = gpu.read(picture, pixels as usize)?;
    Ok(picture.into_iter().map(|[r, g, b, _]| [r, g, b]).collect())
}
