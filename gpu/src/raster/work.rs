//! Sharing out walks over rows of triangles among invocations.

use triptych_spec::raster::Samples;
use triptych_spec::scene::Size;

use super::Rasterizer;
use crate::error::GpuError;
use crate::frame::{Band, WORKGROUP};

/// Most walks of one dispatch (WebGPU: 65,535 workgroups).
const ITEMS_MAX: u32 = 65_535 * WORKGROUP;

/// Columns of a triangle's longest row that an invocation walks at most.
pub const WALKED: u32 = 64;

/// The walks over a triangle.
#[derive(Clone, Copy)]
pub(crate) struct Reach {
    /// First and last row with a sample.
    rows: [i64; 2],
    /// Walks over each row.
    stride: u32,
}

impl Reach {
    /// Those over a triangle; `None` if it has no sample.
    pub(crate) fn of(
        corners: &[[i32; 3]; 3],
        (size, bits): (Size, u32),
        heights: [i64; 2],
    ) -> Option<Self> {
        Some(Self {
            rows: sampled_rows(corners, bits, heights)?,
            stride: stride(corners, bits, size.width),
        })
    }

    /// Of what may lie anywhere on a target.
    pub(super) fn whole(size: Size) -> Self {
        Self {
            rows: [0, i64::from(size.height) - 1],
            stride: 1,
        }
    }

    /// Those over the rows of a band.
    pub(crate) fn walks(self, band: Band) -> u32 {
        rows_within(self.rows, band) * self.stride
    }
}

/// How many invocations share each row of a triangle on a target of this width: a power of two,
/// and each takes one column of so many. Its longest row is twice its area over its height.
/// Twin: `stride_of` in stride.wgsl.
fn stride(corners: &[[i32; 3]; 3], bits: u32, width: u32) -> u32 {
    let [a, b, c] = corners.map(|corner| corner.map(i64::from));
    let double_area = ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).abs();
    let height = a[1].max(b[1]).max(c[1]) - a[1].min(b[1]).min(c[1]);
    let most = height * i64::from(WALKED << bits);
    let mut stride = 1;
    while stride * WALKED < width && most * i64::from(stride) < double_area {
        stride *= 2;
    }
    stride
}

/// A work list and its batches.
pub struct Work {
    pub(super) buffer: wgpu::Buffer,
    pub(super) batches: Vec<Batch>,
}

pub(super) struct Batch {
    pub(super) first: u32,
    pub(super) count: u32,
    pub(super) items: u32,
}

/// How far down from a pixel's top its highest and its lowest sample are, in sub-pixels.
pub(crate) fn heights(samples: Samples, bits: u32) -> [i64; 2] {
    let down = || samples.offsets(bits).map(|[_, down]| down);
    [down().min(), down().max()].map(|end| end.expect("a pixel has a sample"))
}

/// First and last row of which a sample lies within a triangle's height; `None` if it
/// has none. This only shares out work: which of the samples are covered is decided
/// on the device.
fn sampled_rows(
    corners: &[[i32; 3]; 3],
    bits: u32,
    [highest, lowest]: [i64; 2],
) -> Option<[i64; 2]> {
    let y = corners.map(|c| i64::from(c[1]));
    let top = -((lowest - y[0].min(y[1]).min(y[2])) >> bits);
    let bottom = (y[0].max(y[1]).max(y[2]) - highest) >> bits;
    (top <= bottom).then_some([top, bottom])
}

fn rows_within([top, bottom]: [i64; 2], band: Band) -> u32 {
    let top = top.max(i64::from(band.first));
    let bottom = bottom.min(i64::from(band.first + band.rows) - 1);
    u32::try_from(bottom - top + 1).unwrap_or(0)
}

impl Rasterizer<'_> {
    /// The triangles that `select` picks, as far as they meet a band.
    ///
    /// # Errors
    /// More triangles than the adapter can bind.
    pub fn work(&self, band: Band, select: impl Fn(u32) -> bool) -> Result<Work, GpuError> {
        let mut list: Vec<[u32; 2]> = Vec::new();
        let mut batches = Vec::new();
        let mut batch = Batch {
            first: 0,
            count: 0,
            items: 0,
        };
        for (prim, reach) in (0..).zip(&self.reaches) {
            let walks = reach.map_or(0, |reach| reach.walks(band));
            if walks == 0 || !select(prim) {
                continue;
            }
            if batch.items + walks > ITEMS_MAX {
                let first = batch.first + batch.count;
                batches.push(std::mem::replace(
                    &mut batch,
                    Batch {
                        first,
                        count: 0,
                        items: 0,
                    },
                ));
            }
            list.push([prim, batch.items]);
            batch.count += 1;
            batch.items += walks;
        }
        if batch.count > 0 {
            batches.push(batch);
        }
        Ok(Work {
            buffer: self.gpu.upload("work", &list)?,
            batches,
        })
    }
}
