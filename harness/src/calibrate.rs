//! Finds a driver's sub-pixel grid, and where its samples lie: WebGPU has no query for either.

mod probe;
mod samples;

use triptych_gpu::context::Gpu;
use triptych_gpu::error::GpuError;
use triptych_gpu::kernel::Kernels;
use triptych_gpu::raster::{Path, Rasterizer, cover};
use triptych_spec::raster::{self, Fragment};
use triptych_spec::vertex::{Primitives, SUBPIXEL_BITS};

use probe::probe;
pub use samples::calibrate_samples;

/// The coarsest grid that WebGPU's back ends allow (Vulkan: subPixelPrecisionBits
/// is at least 4).
pub const BITS_MIN: u32 = 4;

/// What a driver's rasteriser turned out to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Grid {
    /// Coverage equals the spec's on a grid of this many bits.
    Bits(u32),
    /// It equals the spec's on none: pixels near edges are compared by a band.
    Unknown,
}

impl Grid {
    /// The bits to snap to: the driver's, or the finest where they are unknown.
    pub fn bits(self) -> u32 {
        match self {
            Self::Bits(bits) => bits,
            Self::Unknown => SUBPIXEL_BITS,
        }
    }
}

/// The finest grid on which the fragment path covers exactly what the spec says.
///
/// # Errors
/// Whatever the device reports.
pub fn calibrate(gpu: &Gpu, kernels: &Kernels) -> Result<Grid, GpuError> {
    finest(|probe| {
        let faces = vec![[0.0; 4]; probe.prims.len()];
        let rasterizer = Rasterizer::new(gpu, kernels, Path::Fragment, probe, &faces)?;
        Ok(cover(&rasterizer)?.fragments)
    })
}

/// The finest grid on which a driver covers exactly what the spec says.
fn finest<E>(driver: impl Fn(&Primitives) -> Result<Vec<Fragment>, E>) -> Result<Grid, E> {
    for bits in (BITS_MIN..=SUBPIXEL_BITS).rev() {
        let probe = probe(bits);
        let mut must = Vec::new();
        raster::cover(&probe, |fragment| must.push(fragment));
        if places(&driver(&probe)?) == places(&must) {
            return Ok(Grid::Bits(bits));
        }
    }
    Ok(Grid::Unknown)
}

/// Where triangles cover: keys, and how often a place is reported, are for the
/// comparers to judge.
fn places(fragments: &[Fragment]) -> Vec<(u32, u32)> {
    let mut places: Vec<_> = fragments.iter().map(|f| (f.prim, f.pixel)).collect();
    places.sort_unstable();
    places.dedup();
    places
}

#[cfg(test)]
mod tests;
