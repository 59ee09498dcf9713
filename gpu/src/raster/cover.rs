//! Stage `cover`: the stream of all fragments, in bands of rows.

use std::time::Duration;

use triptych_spec::raster::Fragment;

use super::{Next, Rasterizer, after, first_capacity, nodes_max};
use crate::error::GpuError;
use crate::frame::{Band, Frame};

/// What stage `cover` gave.
pub struct Covered {
    /// Fragments in no particular order.
    pub fragments: Vec<Fragment>,
    /// Time on the device, without transfers.
    pub time: Duration,
}

/// Stage `cover`: every covered pixel of every triangle.
///
/// # Errors
/// Limits by name, WGSL errors, and whatever the device reports.
pub fn cover(rasterizer: &Rasterizer<'_>) -> Result<Covered, GpuError> {
    let mut covered = Covered {
        fragments: Vec::new(),
        time: Duration::ZERO,
    };
    let size = rasterizer.size;
    let mut capacity = first_capacity(size).min(nodes_max(rasterizer.gpu));
    let mut bands = vec![Band::whole(size)];
    while let Some(band) = bands.pop() {
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
        let attempts = gpu.read::<u32>(&counter, 1)?[0];
        match after(gpu, "cover", band, attempts, capacity)? {
            Next::Done => {
                covered.time += time;
                let first = band.first * size.width;
                let stored = gpu.read::<[u32; 4]>(&stream, attempts as usize)?;
                let fragments = stored.into_iter().map(|[pixel, prim, key, mask]| Fragment {
                    pixel: pixel + first,
                    prim,
                    key,
                    mask,
                });
                covered.fragments.extend(fragments);
            }
            Next::Resize(exact) => {
                capacity = exact;
                bands.push(band);
            }
            Next::Split([upper, lower]) => bands.extend([lower, upper]),
        }
    }
    Ok(covered)
}
