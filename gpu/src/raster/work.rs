//! Sharing out walks over rows of triangles among invocations.

use triptych_spec::raster::Samples;
use triptych_spec::scene::Size;

use super::Rasterizer;
use crate::error::GpuError;
use crate::frame::{Band, WORKGROUP};

/// Most walks of one dispatch (WebGPU: 65,535 workgroups).
const ITEMS_MAX: u32 = 65_535 * WORKGROUP;

/// Columns of a row that an invocation walks at most.
pub const WALKED: u32 = 64;

/// What a triangle may cover of a target.
#[derive(Clone, Copy)]
pub(super) struct Reach {
    /// First and last row with a sample.
    rows: [i64; 2],
    /// Walks over each row.
    stride: u32,
}

impl Reach {
    /// That of a triangle; `None` if it has no sample of the target.
    pub(super) fn of(
        corners: &[[i32; 3]; 3],
        (size, bits): (Size, u32),
        heights: [i64; 2],
    ) -> Option<Self> {
        let rows = sampled_rows(corners, bits, heights)?;
        let x = corners.map(|c| i64::from(c[0]));
        let reach = [x[0].min(x[1]).min(x[2]), x[0].max(x[1]).max(x[2])];
        let stride = stride(reach, bits, size.width);
        (stride > 0).then_some(Self { rows, stride })
    }

    /// All of the target.
    pub(super) fn whole(size: Size) -> Self {
        Self {
            rows: [0, i64::from(size.height) - 1],
            stride: 1,
        }
    }

    /// Walks over the rows of a band.
    fn walks(self, band: Band) -> u32 {
        rows_within(self.rows, band) * self.stride
    }
}

/// How many invocations share each row of a triangle that lies between two sub-pixels; each
/// takes one column of so many. A power of two, and 0 if no column of the target is between
/// them. Twin: `stride_of` in frame.wgsl.
fn stride([low, high]: [i64; 2], bits: u32, width: u32) -> u32 {
    let within = |column: i64| column.clamp(0, i64::from(width));
    let columns = within((high >> bits) + 1) - within(low >> bits);
    let walks = u32::try_from(columns).unwrap_or(0).div_ceil(WALKED);
    walks.min(1) * walks.next_power_of_two()
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
pub(super) fn heights(samples: Samples, bits: u32) -> [i64; 2] {
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
