//! Sharing out rows of triangles among invocations.

use triptych_spec::raster::Samples;

use super::Rasterizer;
use crate::error::GpuError;
use crate::frame::{Band, WORKGROUP};

/// Most rows of triangles that one dispatch walks (WebGPU: 65,535 workgroups).
const ITEMS_MAX: u32 = 65_535 * WORKGROUP;

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
pub(super) fn sampled_rows(
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
        for (prim, rows) in (0..).zip(&self.rows) {
            let rows = rows.map_or(0, |rows| rows_within(rows, band));
            if rows == 0 || !select(prim) {
                continue;
            }
            if batch.items + rows > ITEMS_MAX {
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
            batch.items += rows;
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
