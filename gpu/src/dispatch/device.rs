//! A world on the device, and passes over its rays.

use std::mem::offset_of;

use triptych_spec::dispatch::{Sums, World};
use triptych_spec::scene::Size;

use super::Task;
use super::queue::{BYTES, Queue};
use super::records::{lamps, triangles};
use crate::context::Gpu;
use crate::error::GpuError;
use crate::frame::WORKGROUP;
use crate::kernel::Kernels;
use crate::raster::MEMORY;
use crate::ready::Ready;
use crate::rsm::Surface;

/// Words of a pixel's sums.
const WORDS: usize = 6;

/// What all stages share.
pub(super) struct Device<'g> {
    pub(super) gpu: &'g Gpu,
    kernels: &'g Kernels,
    /// What kernels are told, but for what a dispatch adds.
    pub(super) task: Task,
    pub(super) size: Size,
    lamps: wgpu::Buffer,
    triangles: wgpu::Buffer,
}

impl<'g> Device<'g> {
    /// Uploads a world.
    pub(super) fn new(gpu: &'g Gpu, kernels: &'g Kernels, world: &World) -> Result<Self, GpuError> {
        Ok(Self {
            task: Task::from(world),
            size: world.eye.size,
            lamps: gpu.uniform("lamps", &lamps(world))?,
            triangles: gpu.upload("triangles", &triangles(world))?,
            gpu,
            kernels,
        })
    }

    /// Bytes of the world.
    pub(super) fn bytes(&self) -> u64 {
        self.triangles.size() + self.lamps.size()
    }

    /// Pixels that go through all bounces at once: so many that all that may come of them has
    /// room, whatever it is.
    pub(super) fn batch(&self) -> u32 {
        let lamps = u64::from(self.task.lamps.max(1));
        let each = 2 * BYTES + size_of::<Surface>() as u64 + lamps * BYTES;
        let bound = self.gpu.binding_limit() / (lamps * BYTES / 2);
        let most = (MEMORY / 2 / each).min(bound).max(1);
        u32::try_from(most).unwrap_or(u32::MAX)
    }

    fn pass(
        &self,
        entry: &str,
        task: &wgpu::Buffer,
        groups: u32,
        buffers: &[(&str, &wgpu::Buffer)],
    ) -> Result<Ready, GpuError> {
        let mut all = vec![
            ("task", task),
            ("lamps", &self.lamps),
            ("triangles", &self.triangles),
        ];
        all.extend_from_slice(buffers);
        Ready::new(self.gpu, self.kernels, ("dispatch", entry), groups, &all)
    }

    /// The first rays of some pixels.
    pub(super) fn primary(&self, first: u32, items: u32, queue: &Queue) -> Result<Ready, GpuError> {
        let task = Task {
            items,
            first,
            capacity: queue.capacity,
            ..self.task
        };
        let task = self.gpu.uniform("task", &task)?;
        self.pass("primary", &task, items.div_ceil(WORKGROUP), &queue.next())
    }

    /// How many rays a queue holds, for all passes that go through it.
    pub(super) fn count(&self, queue: &Queue) -> Result<Ready, GpuError> {
        let task = Task {
            capacity: queue.capacity,
            ..self.task
        };
        let task = self.gpu.uniform("task", &task)?;
        let buffers = [("counter", &queue.counter), ("arguments", &queue.arguments)];
        self.pass("intersect_queue", &task, 1, &buffers)
    }

    /// One invocation for each ray of a queue, however many those are then; `next` is filled from
    /// its beginning.
    pub(super) fn through(
        &self,
        entry: &str,
        queue: &Queue,
        next: Option<&Queue>,
        buffer: (&str, &wgpu::Buffer),
    ) -> Result<Ready, GpuError> {
        let task = Task {
            capacity: next.map_or(0, |next| next.capacity),
            ..self.task
        };
        let uniform = self.gpu.uniform("task", &task)?;
        let mut named = vec![buffer];
        named.extend(queue.current());
        named.extend(next.iter().flat_map(|next| next.next()));
        let items = offset_of!(Task, items) as u64;
        let mut pass = self
            .pass(entry, &uniform, 0, &named)?
            .after_word((&queue.arguments, 12), (&uniform, items))
            .counted(&queue.arguments);
        if let Some(next) = next {
            pass.clear(next.counter.clone());
        }
        Ok(pass)
    }

    /// Room for what so many rays see.
    pub(super) fn surfaces(&self, rays: u32) -> Result<wgpu::Buffer, GpuError> {
        let bytes = size_of::<Surface>() as u64 * u64::from(rays);
        self.gpu.storage("surfaces", bytes)
    }

    /// A picture without light.
    pub(super) fn sums(&self) -> Result<wgpu::Buffer, GpuError> {
        let bytes = 4 * (WORDS * self.size.pixels()) as u64;
        self.gpu.storage("sums of light", bytes)
    }

    /// A picture.
    pub(super) fn read_sums(&self, sums: &wgpu::Buffer) -> Result<Sums, GpuError> {
        let words: Vec<[u32; WORDS]> = self.gpu.read(sums, self.size.pixels())?;
        let whole = |low: u32, high: u32| u64::from(low) | (u64::from(high) << 32);
        let pixel = |w: &[u32; WORDS]| [whole(w[0], w[1]), whole(w[2], w[3]), whole(w[4], w[5])];
        Ok(Sums {
            size: self.size,
            pixels: words.iter().map(pixel).collect(),
        })
    }
}
