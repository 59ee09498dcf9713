//! Buffers that the bands of a target use one after another.

use std::cell::RefCell;
use std::collections::BTreeMap;

use crate::context::Gpu;
use crate::error::GpuError;

/// Buffers by what they hold, of which a band has one each.
#[derive(Clone, Default)]
pub(super) struct Pool(RefCell<BTreeMap<&'static str, wgpu::Buffer>>);

impl Pool {
    /// Buffers of these bytes.
    pub(super) fn of(gpu: &Gpu, sizes: &BTreeMap<&'static str, u64>) -> Result<Self, GpuError> {
        let pool = Self::default();
        for (what, bytes) in sizes {
            pool.storage(gpu, what, *bytes)?;
        }
        Ok(pool)
    }

    /// A buffer of at least so many bytes: the one that is there, unless it is too small. What it holds
    /// is left over from others.
    pub(super) fn storage(
        &self,
        gpu: &Gpu,
        what: &'static str,
        bytes: u64,
    ) -> Result<wgpu::Buffer, GpuError> {
        let held = self.0.borrow().get(what).cloned();
        if let Some(held) = held.filter(|held| held.size() >= bytes) {
            return Ok(held);
        }
        let buffer = gpu.storage(what, bytes)?;
        self.0.borrow_mut().insert(what, buffer.clone());
        Ok(buffer)
    }

    /// Raises sizes to those of its buffers.
    pub(super) fn raise(&self, sizes: &mut BTreeMap<&'static str, u64>) {
        for (what, buffer) in self.0.borrow().iter() {
            let size = sizes.entry(what).or_default();
            *size = buffer.size().max(*size);
        }
    }
}
