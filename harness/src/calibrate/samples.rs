//! Finds where a driver's samples lie: WebGPU names standard positions, and has no query.

use triptych_gpu::context::Gpu;
use triptych_gpu::error::GpuError;
use triptych_gpu::kernel::Kernels;
use triptych_gpu::raster::{Path, Rasterizer, cover};
use triptych_spec::raster::{self, Fragment, Samples};
use triptych_spec::scene::Size;
use triptych_spec::vertex::Primitives;

use super::probe::probe;

/// The pixel that edges pass through, one sub-pixel after the other.
const PIXEL: u32 = 8;

/// Pixels of a side of the target.
const SIDE: u32 = 17;

/// Where the samples of a pixel lie on a driver whose grid has `bits`; `None` if its coverage
/// is that of no samples.
///
/// # Errors
/// Whatever the device reports.
pub fn calibrate_samples(
    gpu: &Gpu,
    kernels: &Kernels,
    bits: u32,
    count: u32,
) -> Result<Option<Samples>, GpuError> {
    found(bits, count, |probe| {
        let faces = vec![[0.0; 4]; probe.prims.len()];
        let rasterizer = Rasterizer::new(gpu, kernels, Path::Fragment, probe, &faces)?;
        Ok(cover(&rasterizer)?.fragments)
    })
}

/// The same of any driver. Each sample is where the last left edge, and the last top edge, that
/// it is behind or on lies; then triangles of all sizes must have the spec's masks.
pub(super) fn found<E>(
    bits: u32,
    count: u32,
    driver: impl Fn(&Primitives) -> Result<Vec<Fragment>, E>,
) -> Result<Option<Samples>, E> {
    let Some(standard) = Samples::standard(count) else {
        return Ok(None);
    };
    let seen = driver(&steps(bits, standard))?;
    let steps = 1_u32 << bits;
    let mut behind = vec![[0_u32; 2]; count as usize];
    for f in seen.iter().filter(|f| f.pixel == PIXEL * (SIDE + 1)) {
        for s in raster::samples_of(f.mask & standard.all()) {
            behind[s as usize][(f.prim / steps) as usize & 1] += 1;
        }
    }
    let last = |n: u32| n.wrapping_sub(1);
    let places: Vec<[u32; 2]> = behind.iter().map(|at| at.map(last)).collect();
    let Some(samples) = Samples::found(&places, bits) else {
        return Ok(None);
    };
    let probe = Primitives {
        samples,
        ..probe(bits)
    };
    let mut must = Vec::new();
    raster::cover(&probe, |fragment| must.push(fragment));
    let right = masks(&driver(&probe)?) == masks(&must);
    Ok(right.then_some(samples))
}

/// A triangle for each sub-pixel of the pixel's width, with its left edge there, and then one
/// for each of its height, with its top edge there; they are much larger than the pixel.
fn steps(bits: u32, samples: Samples) -> Primitives {
    let mut primitives = Primitives {
        size: Size {
            width: SIDE,
            height: SIDE,
        },
        bits,
        samples,
        snapped: Vec::new(),
        prims: Vec::new(),
        source: Vec::new(),
    };
    let pixels = |n: i32| n << bits;
    let [near, middle, far] = [0, PIXEL.cast_signed(), 2 * PIXEL.cast_signed() + 1].map(pixels);
    for axis in 0..2 {
        for step in 0..1_i32 << bits {
            let edge = middle + step;
            let corners = [[edge, near], [edge, far], [edge + far, middle]];
            for [along, across] in corners {
                let at = match axis {
                    0 => [along, across, 0],
                    _ => [across, along, 0],
                };
                primitives.snapped.push(at);
            }
            let row = u32::try_from(primitives.prims.len()).expect("512 at most");
            primitives.prims.push([3 * row, 3 * row + 1, 3 * row + 2]);
            primitives.source.push(row);
        }
    }
    primitives
}

/// Which samples triangles cover: keys, and how often a place is reported, are for the
/// comparers to judge.
fn masks(fragments: &[Fragment]) -> Vec<(u32, u32, u32)> {
    let mut masks: Vec<_> = fragments
        .iter()
        .map(|f| (f.prim, f.pixel, f.mask))
        .collect();
    masks.sort_unstable();
    masks.dedup();
    masks
}
