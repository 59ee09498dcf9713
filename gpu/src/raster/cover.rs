//! Stage `cover`: the stream of all fragments, in bands of rows.

use std::time::Duration;

use triptych_spec::raster::Fragment;

use super::{Attempts, Need, Rasterizer};
use crate::error::GpuError;
use crate::frame::{Band, Frame};

/// What stage `cover` gave.
#[derive(Default)]
pub struct Covered {
    /// Fragments in no particular order.
    pub fragments: Vec<Fragment>,
    /// Time on the device, without transfers.
    pub time: Duration,
}

/// The stream alone: nothing has the size of the target.
const NEED: Need = Need {
    what: "cover",
    pixel: 0,
    node: 16,
    pixels_max: u64::MAX,
};

/// Stage `cover`: every covered pixel of every triangle.
///
/// # Errors
/// Limits by name, WGSL errors, and whatever the device reports.
pub fn cover(rasterizer: &Rasterizer<'_>) -> Result<Covered, GpuError> {
    let mut covered = Covered::default();
    let mut attempts = Attempts::new(rasterizer.gpu, rasterizer.size, NEED, None);
    while let Some((band, capacity)) = attempts.next() {
        match attempt(rasterizer, band, capacity) {
            Ok((counted, part)) if counted <= capacity => {
                covered.fragments.extend(part.fragments);
                covered.time += part.time;
            }
            Ok((counted, _)) => attempts.overflowed(band, counted)?,
            Err(error) => attempts.failed(band, capacity, error)?,
        }
    }
    Ok(covered)
}

/// Covers a band: how many fragments there are, and all of them if there is room.
fn attempt(
    rasterizer: &Rasterizer<'_>,
    band: Band,
    capacity: u32,
) -> Result<(u32, Covered), GpuError> {
    let gpu = rasterizer.gpu;
    let counter = gpu.filled("counter", 1, 0)?;
    let stream = gpu.storage("stream", 16 * u64::from(capacity))?;
    let work = rasterizer.work(band, |_| true)?;
    let frame = Frame {
        capacity,
        ..rasterizer.frame(band)
    };
    let buffers = [("counter", &counter), ("stream", &stream)];
    let time = rasterizer.draw("raster", "cover", frame, &work, &buffers)?;
    let counted = gpu.read::<u32>(&counter, 1)?[0];
    let mut covered = Covered {
        time,
        ..Covered::default()
    };
    if counted <= capacity {
        let first = band.first * rasterizer.size.width;
        let stored = gpu.read::<[u32; 4]>(&stream, counted as usize)?;
        let fragment = |[pixel, prim, key, mask]: [u32; 4]| Fragment {
            pixel: pixel + first,
            prim,
            key,
            mask,
        };
        covered.fragments = stored.into_iter().map(fragment).collect();
    }
    Ok((counted, covered))
}
