//! Finds a driver's sub-pixel grid: WebGPU has no query for it.

use std::collections::BTreeSet;

use triptych_gpu::context::Gpu;
use triptych_gpu::error::GpuError;
use triptych_gpu::kernel::Kernels;
use triptych_gpu::raster::{Path, Rasterizer, cover};
use triptych_spec::raster;
use triptych_spec::scene::Size;
use triptych_spec::vertex::{GUARD, Primitives, SUBPIXEL_BITS, guard_origin};

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
    for bits in (BITS_MIN..=SUBPIXEL_BITS).rev() {
        let probe = probe(bits);
        let faces = vec![[0.0; 4]; probe.prims.len()];
        let rasterizer = Rasterizer::new(gpu, kernels, Path::Fragment, &probe, &faces)?;
        let seen = cover(&rasterizer)?;
        let seen: BTreeSet<_> = seen.fragments.iter().map(|f| (f.pixel, f.prim)).collect();
        let mut must = BTreeSet::new();
        raster::cover(&probe, |f| {
            must.insert((f.pixel, f.prim));
        });
        if seen == must {
            return Ok(Grid::Bits(bits));
        }
    }
    Ok(Grid::Unknown)
}

/// Triangles of all sizes on a grid, corners and edges through samples among them,
/// some of them leaving the target. With odd coordinates on the finest grid, any
/// coarser one moves them.
fn probe(bits: u32) -> Primitives {
    const TRIANGLES: u32 = 600;
    let size = Size {
        width: 127,
        height: 93,
    };
    let mut random = SplitMix(0x7121_7974);
    let mut primitives = Primitives {
        size,
        bits,
        snapped: Vec::new(),
        prims: Vec::new(),
        source: Vec::new(),
    };
    for t in 0..TRIANGLES {
        let reach = [4, 24, 160, 1200][t as usize % 4];
        let centre = [random.below(160) - 16, random.below(120) - 16];
        for _ in 0..3 {
            let corner = [0, 1].map(|axis| {
                let pixel = centre[axis] + random.below(2 * reach) - reach;
                let low = guard_origin(if axis == 0 { size.width } else { size.height });
                let pixel = pixel.clamp(low, low + GUARD - 1);
                let through_samples = t % 5 == 0;
                let fraction = if through_samples {
                    1 << (bits - 1)
                } else {
                    random.below(1 << bits)
                };
                (pixel << bits) + fraction
            });
            primitives
                .snapped
                .push([corner[0], corner[1], random.below(i32::MAX)]);
        }
        primitives.prims.push([3 * t, 3 * t + 1, 3 * t + 2]);
        primitives.source.push(t);
    }
    primitives
}

/// Steele, Lea and Flood 2014: enough randomness for a probe, and the same on every
/// machine.
struct SplitMix(u64);

impl SplitMix {
    fn below(&mut self, n: i32) -> i32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        let n = u64::from(n.unsigned_abs());
        i32::try_from((z ^ (z >> 31)) % n).expect("less than n")
    }
}
