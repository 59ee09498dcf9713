//! Room for fragments: first attempt, overflow, retry.

use triptych_spec::scene::Size;

use crate::context::Gpu;
use crate::error::GpuError;
use crate::frame::Band;

/// Past this many claims a counter no longer counts. Twin: `SATURATED` in
/// `counter.wgsl`.
pub const SATURATED: u32 = 0x8000_0000;

/// Room for two fragments a pixel: enough for most scenes at the first attempt.
pub fn first_capacity(size: Size) -> u32 {
    2 * size.width * size.height
}

/// The most nodes of 16 bytes that the adapter can bind.
pub fn nodes_max(gpu: &Gpu) -> u32 {
    u32::try_from(gpu.binding_limit() / 16).unwrap_or(u32::MAX)
}

/// What to do after an attempt with some capacity.
pub enum Next {
    /// Everything fitted.
    Done,
    /// Again, with exactly this much room.
    Resize(u32),
    /// The adapter has no such buffer: again in two parts.
    Split([Band; 2]),
}

/// Overflow is detected by the counter and cured by size, or by halves where the
/// adapter cannot bind so much (section 3.3: "detect when overflow happens and
/// resize the node buffer as needed").
///
/// # Errors
/// [`GpuError::Limit`] if even a single row does not fit.
pub fn after(
    gpu: &Gpu,
    what: &'static str,
    band: Band,
    attempts: u32,
    capacity: u32,
) -> Result<Next, GpuError> {
    let most = nodes_max(gpu);
    if attempts <= capacity {
        return Ok(Next::Done);
    }
    if attempts < SATURATED && attempts <= most {
        return Ok(Next::Resize(attempts));
    }
    band.halves().map(Next::Split).ok_or(GpuError::Limit {
        adapter: gpu.name.clone(),
        what,
        needed: u64::from(attempts),
        limit: u64::from(most),
    })
}
