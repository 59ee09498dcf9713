//! Room for fragments: first attempt, overflow, retry; bands of rows where not all of
//! a target fits at once.

use triptych_spec::scene::Size;

use crate::context::Gpu;
use crate::error::GpuError;
use crate::frame::Band;

/// Past this many claims a counter no longer counts. Twin: `SATURATED` in
/// `counter.wgsl`.
pub const SATURATED: u32 = 0x8000_0000;

/// Most bytes that an attempt asks for, staging buffers apart. WebGPU cannot be asked
/// what is free, and a driver in the host's memory may promise more than there is:
/// llvmpipe gives 64 GiB on a machine with 24, and whoever touches them is killed. This
/// is eight bindings of WebGPU's guaranteed size; what needs more runs in bands. A
/// device with less refuses, which makes bands as well.
pub const MEMORY: u64 = 1 << 30;

/// Bytes of a node in each buffer that holds nodes.
const NODE: u64 = 16;

/// What an attempt at a stage takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Need {
    /// The stage, for errors.
    pub what: &'static str,
    /// Bytes of each pixel, in all buffers together.
    pub pixel: u64,
    /// Bytes of each node, in all buffers together.
    pub node: u64,
    /// Most pixels that one attempt can serve.
    pub pixels_max: u64,
}

/// The attempts at a target: which rows next, and with room for how many nodes. What
/// comes after an attempt depends on what came of it, which it must be told.
pub struct Attempts {
    size: Size,
    need: Need,
    adapter: String,
    /// Largest binding, in bytes.
    binding: u64,
    /// Attempts at more bytes than this are not made.
    memory: u64,
    /// Not done yet; the next one is last.
    bands: Vec<Band>,
    /// Nodes of the next attempt, if they fit.
    capacity: u32,
    /// Nodes before each row, and in all, where they are known beforehand.
    known: Option<Vec<u32>>,
    /// Rows of a band are multiples of this, but for those at the end.
    side: u32,
}

impl Attempts {
    /// Begins with the whole target, and with room for `capacity` nodes or two a pixel,
    /// which is enough for most scenes.
    pub fn new(gpu: &Gpu, size: Size, need: Need, capacity: Option<u32>) -> Self {
        Self {
            size,
            need,
            adapter: gpu.name.clone(),
            binding: gpu.binding_limit(),
            memory: MEMORY,
            bands: vec![Band::whole(size)],
            capacity: capacity.unwrap_or(2 * size.width * size.height),
            known: None,
            side: 1,
        }
    }

    /// The same in bands of whole multiples of so many rows.
    #[must_use]
    pub fn in_rows_of(self, side: u32) -> Self {
        Self { side, ..self }
    }

    /// The same with attempts at no more than so many bytes.
    #[must_use]
    pub fn within(self, memory: u64) -> Self {
        Self { memory, ..self }
    }

    /// The same where the number of nodes in each row is known: every attempt has room
    /// for exactly its own.
    #[must_use]
    pub fn with_rows(mut self, nodes: impl Iterator<Item = u32>) -> Self {
        let mut sum = 0;
        let before = std::iter::once(0).chain(nodes.map(|n| {
            sum += n;
            sum
        }));
        self.known = Some(before.collect());
        self
    }

    /// More nodes were counted than there was room for: again with exactly as many, or
    /// in halves where so many cannot be had (section 3.3: "detect when overflow happens
    /// and resize the node buffer as needed").
    ///
    /// # Errors
    /// [`GpuError::Limit`] if even a single row does not fit.
    pub fn overflowed(&mut self, band: Band, counted: u32) -> Result<(), GpuError> {
        let most = self.nodes_max(band);
        if counted < SATURATED && counted <= most {
            self.capacity = counted;
            self.bands.push(band);
        } else if !self.split(band) {
            return Err(GpuError::Limit {
                adapter: self.adapter.clone(),
                what: self.need.what,
                needed: u64::from(counted),
                limit: u64::from(most),
            });
        }
        Ok(())
    }

    /// An attempt failed. If for want of memory, so much is not asked for again: half of
    /// the rows come next, or a single row with room for half of the nodes, which tells
    /// whether it needs more.
    ///
    /// # Errors
    /// Every other error, and this one where nothing less is left to try.
    pub fn failed(&mut self, band: Band, capacity: u32, error: GpuError) -> Result<(), GpuError> {
        let less = band.rows > 1 || (capacity > 0 && self.known.is_none());
        if !less || !matches!(error, GpuError::Memory { .. }) {
            return Err(error);
        }
        self.memory = self.memory.min(self.bytes(band, capacity) - 1);
        self.capacity = capacity / 2;
        if !self.split(band) {
            self.bands.push(band);
        }
        Ok(())
    }

    /// Puts the halves of a band in its place; false if it is a single row.
    fn split(&mut self, band: Band) -> bool {
        let halves = band.halves_in(self.side);
        if let Some([upper, lower]) = halves {
            self.bands.extend([lower, upper]);
        }
        halves.is_some()
    }

    fn fits(&self, band: Band, nodes: u32) -> bool {
        u64::from(band.pixels(self.size)) <= self.need.pixels_max
            && NODE * u64::from(nodes) <= self.binding
            && self.bytes(band, nodes) <= self.memory
    }

    /// The most nodes that a band can have room for.
    fn nodes_max(&self, band: Band) -> u32 {
        let left = self.memory.saturating_sub(self.bytes(band, 0));
        let most = (self.binding / NODE).min(left / self.need.node);
        u32::try_from(most).unwrap_or(u32::MAX)
    }

    fn bytes(&self, band: Band, nodes: u32) -> u64 {
        let Need { pixel, node, .. } = self.need;
        pixel * u64::from(band.pixels(self.size)) + node * u64::from(nodes)
    }

    fn known(&self, band: Band) -> Option<u32> {
        let before = self.known.as_ref()?;
        let [start, end] = [band.first, band.first + band.rows].map(|row| before[row as usize]);
        Some(end - start)
    }
}

impl Iterator for Attempts {
    type Item = (Band, u32);

    /// The next rows, and the nodes that there shall be room for. A single row is given
    /// out even if it does not fit: it must fail by its name.
    fn next(&mut self) -> Option<(Band, u32)> {
        loop {
            let band = self.bands.pop()?;
            let known = self.known(band);
            if self.fits(band, known.unwrap_or(0)) || !self.split(band) {
                let capacity = || self.capacity.min(self.nodes_max(band));
                return Some((band, known.unwrap_or_else(capacity)));
            }
        }
    }
}

#[cfg(test)]
mod tests;
