//! Lists of a batch of maps: counted, filled, and put in order.

use std::time::Duration;

use triptych_spec::ldm::Layers;

use super::Told;
use super::batch::{Span, spans};
use super::device::Device;
use crate::error::GpuError;
use crate::lists::{LONG, TILE, long_passes};

/// Kernels that count keys, of small triangles and of large ones.
pub(super) const COUNT: [&str; 2] = ["layers_count", "layers_count_large"];

/// Kernels that write them.
pub(super) const FILL: [&str; 2] = ["layers_fill", "layers_fill_large"];

/// Kernels that put long lists in order.
pub(super) const LONGEST: [&str; 2] = ["layers_runs", "layers_merge"];

/// A batch of maps with its lists.
pub(super) struct Batch {
    pub(super) span: Span,
    /// Where the list of each pixel starts, and the end of the last: 4 bytes a pixel.
    pub(super) offsets: wgpu::Buffer,
    /// 4 bytes a key.
    pub(super) keys: wgpu::Buffer,
    /// How many keys there are.
    pub(super) total: u32,
    /// Keys of the longest list, if it is longer than [`LONG`].
    pub(super) longest: u32,
}

impl Device<'_> {
    /// All maps in batches, by pixels alone.
    pub(super) fn spans(&self) -> Vec<Span> {
        spans(self.all, self.room / 4 - 1)
    }

    /// All maps in batches whose pixels and keys have room, as far as a batch is more than a map.
    pub(super) fn batches_of(&self, layers: &Layers) -> Vec<Span> {
        let mut waiting = self.spans();
        waiting.reverse();
        let mut batches = Vec::new();
        while let Some(span) = waiting.pop() {
            let [first, end] = [span.pixels.start, span.pixels.end];
            let keys = layers.offsets[end as usize] - layers.offsets[first as usize];
            match span.halves(self.all) {
                Some([one, other]) if 4 * u64::from(keys) > self.room => {
                    waiting.extend([other, one]);
                }
                _ => batches.push(span),
            }
        }
        batches
    }

    /// All batches as one; offsets as the device left them.
    pub(super) fn read(&self, batches: &[Batch]) -> Result<Layers, GpuError> {
        let mut layers = Layers {
            offsets: vec![0],
            keys: Vec::new(),
        };
        for batch in batches {
            let gpu = self.gpu;
            let before = u32::try_from(layers.keys.len()).unwrap_or(u32::MAX);
            let offsets: Vec<u32> = gpu.read(&batch.offsets, batch.span.len() as usize + 1)?;
            let moved = offsets.iter().map(|at| at.wrapping_add(before));
            // The first is the last of the batch before, unless the device says otherwise.
            layers.offsets.pop();
            layers.offsets.extend(moved);
            layers
                .keys
                .extend(gpu.read::<u32>(&batch.keys, batch.total as usize)?);
        }
        Ok(layers)
    }

    /// Lists of these maps, in as many batches as their keys need.
    pub(super) fn build(&self, span: Span) -> Result<(Vec<Batch>, Duration), GpuError> {
        let offsets = self
            .gpu
            .storage("offsets of pixels", 4 * (u64::from(span.len()) + 1))?;
        let counts = [("counts", &offsets)];
        let mut time = self.run(&self.draw(COUNT, (&span, 0), &counts)?)?;
        let tiles = span.len().div_ceil(TILE);
        let sums = self.gpu.storage("sums of tiles", 4 * u64::from(tiles))?;
        let buffers = [("counts", &offsets), ("sums", &sums)];
        time += self.run(&self.scan(&span, &buffers)?)?;
        let total = match span.len() {
            0 => 0,
            pixels => self.gpu.word(&offsets, pixels)?,
        };
        if 4 * u64::from(total) > self.room {
            return self.halved(&span, total, time);
        }
        let keys = self.gpu.storage("keys of pixels", 4 * u64::from(total))?;
        let buffers = [("counts", &offsets), ("listed", &keys)];
        time += self.run(&self.draw(FILL, (&span, total), &buffers)?)?;
        let mut batch = Batch {
            span,
            offsets,
            keys,
            total,
            longest: 0,
        };
        time += self.sort(&mut batch)?;
        Ok((vec![batch], time))
    }

    /// Two batches in place of one whose keys have no room.
    fn halved(
        &self,
        span: &Span,
        total: u32,
        mut time: Duration,
    ) -> Result<(Vec<Batch>, Duration), GpuError> {
        let halves = span.halves(self.all).ok_or_else(|| GpuError::Limit {
            adapter: self.gpu.name.clone(),
            what: "keys of one map, in bytes,",
            needed: 4 * u64::from(total),
            limit: self.room,
        })?;
        let mut batches = Vec::new();
        for half in halves {
            let (more, taken) = self.build(half)?;
            batches.extend(more);
            time += taken;
        }
        Ok((batches, time))
    }

    /// Each list in order of key.
    fn sort(&self, batch: &mut Batch) -> Result<Duration, GpuError> {
        let told = batch.span.told(self.told);
        let buffers = [("offsets", &batch.offsets), ("listed", &batch.keys)];
        let mut time = self.run(&[self.each("layers_sort", told, &buffers)?])?;
        // No list is longer than all are together, whatever damaged offsets say.
        batch.longest = self.gpu.take(&self.unfinished)?.min(batch.total);
        if batch.longest <= LONG {
            return Ok(time);
        }
        let mut merged = self.gpu.storage("keys of pixels", batch.keys.size())?;
        for (entry, run) in long_passes(LONGEST, batch.longest) {
            let buffers = [
                ("offsets", &batch.offsets),
                ("listed", &batch.keys),
                ("merged", &merged),
            ];
            let told = Told {
                items: batch.total,
                run,
                ..told
            };
            time += self.run(&[self.each(entry, told, &buffers)?])?;
            std::mem::swap(&mut batch.keys, &mut merged);
        }
        Ok(time)
    }
}
