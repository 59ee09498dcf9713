//! Buffers: made, filled, read back.
//!
//! What an adapter cannot bind, or has no memory for, is an error by name. wgpu says
//! so when it refuses a buffer that we make; where a staging buffer of its own finds
//! no room, as in `Queue::write_buffer`, it loses the device. So everything passes
//! through staging buffers that we make, piece by piece: memory that host and device
//! share is scarce on some boards.

use super::Gpu;
use crate::error::GpuError;

/// Bytes that pass through a staging buffer at once.
const STAGING: usize = 1 << 24;

impl Gpu {
    /// A storage buffer of `bytes` zeros (at least one word).
    ///
    /// # Errors
    /// [`GpuError::Limit`] if the adapter cannot bind so much, [`GpuError::Memory`] if
    /// it does not have it.
    pub fn storage(&self, what: &'static str, bytes: u64) -> Result<wgpu::Buffer, GpuError> {
        let bytes = bytes.max(16);
        self.check_binding(what, bytes)?;
        let usage = wgpu::BufferUsages::STORAGE
            | wgpu::BufferUsages::COPY_SRC
            | wgpu::BufferUsages::COPY_DST;
        self.buffer(what, bytes, usage, false)
    }

    /// The same for numbers of workgroups, which passes are told by it.
    ///
    /// # Errors
    /// As [`Gpu::storage`].
    pub(crate) fn arguments(&self, what: &'static str) -> Result<wgpu::Buffer, GpuError> {
        let usage = wgpu::BufferUsages::STORAGE
            | wgpu::BufferUsages::COPY_SRC
            | wgpu::BufferUsages::COPY_DST
            | wgpu::BufferUsages::INDIRECT;
        self.buffer(what, 16, usage, false)
    }

    /// The same for copies alone, of which no kernel sees anything.
    ///
    /// # Errors
    /// [`GpuError::Memory`] if the adapter does not have it.
    pub(crate) fn storage_unbound(
        &self,
        what: &'static str,
        bytes: u64,
    ) -> Result<wgpu::Buffer, GpuError> {
        let usage = wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST;
        self.buffer(what, bytes.max(16), usage, false)
    }

    /// A storage buffer that holds `data`.
    ///
    /// # Errors
    /// As [`Gpu::storage`], and whatever the device reports.
    pub fn upload<T: bytemuck::NoUninit>(
        &self,
        what: &'static str,
        data: &[T],
    ) -> Result<wgpu::Buffer, GpuError> {
        let bytes: &[u8] = bytemuck::cast_slice(data);
        let buffer = self.storage(what, bytes.len() as u64)?;
        self.write(&buffer, bytes)?;
        Ok(buffer)
    }

    /// A storage buffer of `words` words with the same value.
    ///
    /// # Errors
    /// As [`Gpu::upload`].
    pub fn filled(
        &self,
        what: &'static str,
        words: u32,
        value: u32,
    ) -> Result<wgpu::Buffer, GpuError> {
        self.upload(what, &vec![value; words as usize])
    }

    /// A uniform buffer that holds `block`.
    ///
    /// # Errors
    /// As [`Gpu::upload`].
    pub fn uniform<T: bytemuck::NoUninit>(
        &self,
        what: &'static str,
        block: &T,
    ) -> Result<wgpu::Buffer, GpuError> {
        let bytes = bytemuck::bytes_of(block);
        let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
        let buffer = self.buffer(what, bytes.len() as u64, usage, false)?;
        self.write(&buffer, bytes)?;
        Ok(buffer)
    }

    /// The first `count` items of a buffer.
    ///
    /// # Errors
    /// [`GpuError::Memory`], and whatever the device reported meanwhile.
    pub fn read<T: bytemuck::Pod>(
        &self,
        buffer: &wgpu::Buffer,
        count: usize,
    ) -> Result<Vec<T>, GpuError> {
        let at_once = STAGING / size_of::<T>();
        let mut items = Vec::with_capacity(count);
        for first in (0..count).step_by(at_once) {
            let part = at_once.min(count - first);
            let from = (first * size_of::<T>()) as u64;
            self.read_part(buffer, from, part, &mut items)?;
        }
        Ok(items)
    }

    /// So many items from a byte on, no more than pass at once.
    fn read_part<T: bytemuck::Pod>(
        &self,
        buffer: &wgpu::Buffer,
        from: u64,
        count: usize,
        items: &mut Vec<T>,
    ) -> Result<(), GpuError> {
        let bytes = (count * size_of::<T>()) as u64;
        let usage = wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST;
        let staging = self.buffer("staging", bytes, usage, false)?;
        let mut encoder = self.encoder();
        encoder.copy_buffer_to_buffer(buffer, from, &staging, 0, bytes);
        self.queue.submit([encoder.finish()]);
        staging.map_async(wgpu::MapMode::Read, .., |_| {});
        self.wait()?;
        let view = staging.get_mapped_range(..).map_err(|e| self.refused(&e))?;
        items.extend(bytemuck::pod_collect_to_vec::<u8, T>(&view));
        Ok(())
    }

    /// One word of a buffer.
    ///
    /// # Errors
    /// As [`Gpu::read`].
    pub fn word(&self, buffer: &wgpu::Buffer, at: u32) -> Result<u32, GpuError> {
        let mut word = Vec::with_capacity(1);
        self.read_part(buffer, 4 * u64::from(at), 1, &mut word)?;
        Ok(word[0])
    }

    /// The first word of a buffer, which is 0 afterwards.
    ///
    /// # Errors
    /// As [`Gpu::read`].
    pub fn take(&self, buffer: &wgpu::Buffer) -> Result<u32, GpuError> {
        let word: Vec<u32> = self.read(buffer, 1)?;
        let mut encoder = self.encoder();
        encoder.clear_buffer(buffer, 0, Some(4));
        self.submit(encoder)?;
        Ok(word[0])
    }

    /// Overwrites the beginning of a buffer.
    fn write(&self, buffer: &wgpu::Buffer, bytes: &[u8]) -> Result<(), GpuError> {
        for (to, part) in (0_u64..).step_by(STAGING).zip(bytes.chunks(STAGING)) {
            let size = part.len() as u64;
            let usage = wgpu::BufferUsages::MAP_WRITE | wgpu::BufferUsages::COPY_SRC;
            let staging = self.buffer("staging", size, usage, true)?;
            staging
                .get_mapped_range_mut(..)
                .map_err(|e| self.refused(&e))?
                .copy_from_slice(part);
            staging.unmap();
            let mut encoder = self.encoder();
            encoder.copy_buffer_to_buffer(&staging, 0, buffer, to, size);
            self.submit(encoder)?;
        }
        Ok(())
    }

    fn buffer(
        &self,
        what: &'static str,
        bytes: u64,
        usage: wgpu::BufferUsages,
        mapped_at_creation: bool,
    ) -> Result<wgpu::Buffer, GpuError> {
        let descriptor = wgpu::BufferDescriptor {
            label: Some(what),
            size: bytes,
            usage,
            mapped_at_creation,
        };
        self.make(what, bytes, |device| device.create_buffer(&descriptor))
    }

    /// Makes something that takes so many bytes of the device's memory.
    ///
    /// # Errors
    /// [`GpuError::Memory`] if the device does not have them; it lives on.
    pub(crate) fn make<T>(
        &self,
        what: &'static str,
        bytes: u64,
        make: impl FnOnce(&wgpu::Device) -> T,
    ) -> Result<T, GpuError> {
        let room = self
            .memory_limit
            .is_none_or(|limit| self.allocated() + bytes <= limit);
        let made = room.then(|| {
            let scope = self.device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
            let made = make(&self.device);
            let refused = pollster::block_on(scope.pop()).is_some();
            (!refused).then_some(made)
        });
        made.flatten().ok_or_else(|| GpuError::Memory {
            adapter: self.name.clone(),
            what,
            bytes,
        })
    }

    /// Fails by name if a kernel cannot see `bytes` at once.
    ///
    /// # Errors
    /// [`GpuError::Limit`].
    pub fn check_binding(&self, what: &'static str, bytes: u64) -> Result<(), GpuError> {
        let limit = self.binding_limit();
        if bytes <= limit {
            return Ok(());
        }
        Err(GpuError::Limit {
            adapter: self.name.clone(),
            what,
            needed: bytes,
            limit,
        })
    }

    /// Behaves like an adapter that has only so many bytes left. wgpu counts them; where
    /// it does not manage memory itself, as on OpenGL, nothing is restricted.
    pub fn restrict_memory(&mut self, bytes: u64) {
        self.memory_limit = Some(self.allocated() + bytes);
    }

    /// Bytes that are taken, as far as wgpu knows.
    fn allocated(&self) -> u64 {
        let report = self.device.generate_allocator_report();
        report.map_or(0, |report| report.total_allocated_bytes)
    }
}

#[cfg(test)]
mod tests;
