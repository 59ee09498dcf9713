//! Fragments at a reduced resolution: their lists blended there, and what the full one shows of them.

mod timed;

use std::time::{Duration, Instant};

use bytemuck::{Pod, Zeroable};
use triptych_spec::abuffer::{Lists, Opaque, Reduction};

use super::{Given, Rival, Surfaces, by_name, frame, image, read_lists, run_through, whole};
use crate::abuffer::STEPS;
use crate::error::GpuError;
use crate::raster::Rasterizer;
pub use timed::Reduced;

/// What kernels are told of a reduction. Twin: `Reduction` in `reduced.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Reducing {
    /// A reduced pixel stands for a block of `2^halvings` a side.
    pub halvings: u32,
    /// Reduced pixels in a row,
    pub across: u32,
    /// and in a column.
    pub down: u32,
    /// Of weights with depth, one over the depth range.
    pub falloff: f32,
}

impl Reducing {
    /// Of a reduced target.
    fn new(low: &Rasterizer<'_>, reduction: Reduction) -> Self {
        Self {
            halvings: reduction.halvings,
            across: low.size.width,
            down: low.size.height,
            falloff: reduction.falloff,
        }
    }
}

/// The lists of a reduced target.
#[derive(Clone, Copy)]
pub struct Low<'a, 'g> {
    /// The target.
    pub rasterizer: &'a Rasterizer<'g>,
    /// Its nearest opaque surfaces.
    pub opaque: &'a Opaque,
    /// Its lists, sorted and certified, of so many layers at most.
    pub lists: &'a Lists,
    /// The longest one's.
    pub layers: u32,
}

/// Blends sorted lists of a reduced target, and shows them over the surfaces of the full one: each pixel as its
/// block, and by the reduced pixels around it.
///
/// # Errors
/// [`GpuError::Endless`] where a list is longer than is said; targets that do not fit at once, by name; WGSL
/// errors, and whatever the device reports.
pub fn reduce(
    full: &Rasterizer<'_>,
    low: Low<'_, '_>,
    given: Given<'_>,
    reduction: Reduction,
) -> Result<[Rival; 2], GpuError> {
    let gpu = full.gpu;
    full.take_passes();
    low.rasterizer.take_passes();
    let (band, pixels) = whole(full)?;
    let words = Reducing::new(low.rasterizer, reduction);
    let blended = blend(low, given)?;
    let guide = gpu.upload("guide", &low.opaque.key)?;
    let reducing = gpu.uniform("reduction", &words)?;
    let shown = gpu.storage("picture", 16 * pixels)?;
    let surfaces = Surfaces::upload(full, given.opaque, band)?;
    let mut named = vec![
        ("picture", &shown),
        ("reduced_layer", &blended.layers),
        ("guide", &guide),
        ("reduction", &reducing),
    ];
    named.extend(surfaces.named());
    let above = frame(full, band, given.background);
    let below = low.rasterizer.take_passes();
    let show = |stage| -> Result<Rival, GpuError> {
        let pass = full.ready_per_pixel("reduced", stage, above, &named)?;
        let mut encoder = gpu.encoder();
        full.record(std::slice::from_ref(&pass), &mut encoder);
        let start = Instant::now();
        gpu.submit(encoder)?;
        let time = start.elapsed();
        let mut passes = below.clone();
        passes.extend(full.take_passes());
        Ok(Rival {
            image: image(gpu, &shown, band.pixels(full.size))?,
            time: blended.time + time,
            passes,
            bytes: blended.bytes + guide.size() + shown.size(),
            layers: low.layers,
            ..Rival::default()
        })
    };
    Ok([show("reduced_nearest")?, show("reduced")?])
}

/// A reduced target's layers.
struct Blended {
    /// Of each pixel their colour, and what goes through.
    layers: wgpu::Buffer,
    /// Of these and of the lists.
    bytes: u64,
    time: Duration,
}

/// Blends the lists of a reduced target, without what lies behind.
fn blend(low: Low<'_, '_>, given: Given<'_>) -> Result<Blended, GpuError> {
    let (rasterizer, gpu) = (low.rasterizer, low.rasterizer.gpu);
    let (band, pixels) = whole(rasterizer)?;
    let own = read_lists(gpu, low.lists, pixels)?;
    let surfaces = Surfaces::upload(rasterizer, low.opaque, band)?;
    let mut named: Vec<_> = own.iter().map(|(name, buffer)| (*name, buffer)).collect();
    named.extend(surfaces.named());
    let frame = frame(rasterizer, band, given.background);
    let ready = |stage| rasterizer.ready_per_pixel("reduced", stage, frame, &named);
    let mut passes = vec![ready("reduced_clear")?];
    for _ in 0..=u64::from(low.layers) / STEPS {
        passes.push(ready("reduced_layers")?);
    }
    let time = run_through(
        rasterizer,
        passes.iter(),
        by_name(&own, "unfinished"),
        "reduced",
    )?;
    Ok(Blended {
        time,
        layers: by_name(&own, "picture").clone(),
        bytes: own.iter().map(|(_, buffer)| buffer.size()).sum(),
    })
}
