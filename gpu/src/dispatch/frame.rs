//! A whole frame, bounce after bounce, from the device's own rays, which the host looks at.

use std::time::Duration;

use triptych_spec::dispatch::Met;
use triptych_spec::grid::trace::Query;

use super::queue::Queue;
use super::records::met;
use super::stages::Stages;
use super::{Batch, Bounce, Frame, Needs, Room};
use crate::error::GpuError;
use crate::rsm::Surface;

impl Stages<'_> {
    /// All stages, each from what the ones before have left on the device: the host reads it,
    /// and says only how much room there is.
    ///
    /// # Errors
    /// Limits by name, and whatever the device reports.
    pub fn frame(&mut self, room: Room) -> Result<Frame, GpuError> {
        let size = self.device.size;
        let pixels = size.width * size.height;
        let batch = room.pixels.unwrap_or(u32::MAX).min(self.device.batch());
        let sums = self.device.sums()?;
        self.time = match &self.grid {
            Some(grid) => grid.mark_bricks()?,
            None => Duration::ZERO,
        };
        let (mut bounces, mut batches) = (Vec::new(), Vec::new());
        for first in (0..pixels).step_by(batch.max(1) as usize) {
            let count = batch.max(1).min(pixels - first);
            let needs = self.batch([first, count], room, &sums, &mut bounces)?;
            batches.push(Batch {
                first,
                bounces: needs,
            });
        }
        Ok(Frame {
            bounces,
            sums: self.device.read_sums(&sums)?,
            batches,
        })
    }

    /// All bounces of some pixels, and one beyond the world's depth if there are rays for it.
    fn batch(
        &mut self,
        [first, count]: [u32; 2],
        room: Room,
        sums: &wgpu::Buffer,
        bounces: &mut Vec<Bounce>,
    ) -> Result<Vec<Needs>, GpuError> {
        let gpu = self.device.gpu;
        let mut queue = Queue::first(gpu, count)?;
        self.time += self.device.primary(first, count, &queue)?.run(gpu)?;
        self.time += self.device.count(&queue)?.run(gpu)?;
        let mut needs = Vec::new();
        // Rays of one bounce too many are seen, and not followed: a kernel may make some for ever.
        let most = self.device.task.depth as usize + 2;
        while needs.len() < most && queue.items(gpu)? > 0 {
            if bounces.len() == needs.len() {
                bounces.push(Bounce::default());
            }
            let (next, needed) = self.bounce(&queue, room, sums, &mut bounces[needs.len()])?;
            needs.push(needed);
            queue = next;
        }
        Ok(needs)
    }

    /// One bounce of a batch, and the queue of the next.
    fn bounce(
        &mut self,
        queue: &Queue,
        room: Room,
        sums: &wgpu::Buffer,
        bounce: &mut Bounce,
    ) -> Result<(Queue, Needs), GpuError> {
        let surfaces = self.device.surfaces(queue.capacity)?;
        let closest = self.search(queue, Query::Closest)?;
        self.run("locate", queue, None, ("surfaces", &surfaces))?;
        let (shadows, tried) = self.filled("light", queue, &surfaces, room.shadows)?;
        bounce.shadows.overflows.extend(tried);
        let any = self.search(&shadows, Query::Any)?;
        self.run("deposit", &shadows, None, ("sums", sums))?;
        self.run("deposit", queue, None, ("sums", sums))?;
        let (mirrors, tried) = self.filled("reflect", queue, &surfaces, room.mirrors)?;
        bounce.mirrors.extend(tried);
        let gpu = self.device.gpu;
        let needs = Needs {
            rays: queue.items(gpu)?,
            shadows: shadows.items(gpu)?,
            rounds: [closest, any],
        };
        self.read(queue, needs.rays, &mut bounce.rays, &mut bounce.met)?;
        let asked = (&mut bounce.shadows.rays, &mut bounce.blocked);
        self.read(&shadows, needs.shadows, asked.0, asked.1)?;
        let seen: Vec<Surface> = gpu.read(&surfaces, needs.rays as usize)?;
        bounce.seen.extend(seen.into_iter().map(Surface::unpacked));
        Ok((mirrors, needs))
    }

    /// What a queue's rays meet, in so many dispatches.
    fn search(&mut self, queue: &Queue, query: Query) -> Result<u32, GpuError> {
        let Some(grid) = &mut self.grid else {
            return Ok(0);
        };
        self.time += grid.search_counted(queue.counted(), query)?;
        Ok(grid.dispatches)
    }

    /// The rays of a queue, and what they met.
    fn read(
        &self,
        queue: &Queue,
        count: u32,
        rays: &mut Vec<triptych_spec::dispatch::Ray>,
        all: &mut Vec<Met>,
    ) -> Result<(), GpuError> {
        let own = queue.read(self.device.gpu, count)?;
        match &self.grid {
            Some(_) => {
                let prims = queue.prims(self.device.gpu, count)?;
                all.extend(own.iter().zip(prims).map(|(ray, prim)| met(ray, prim)));
            }
            None => all.extend(own.iter().map(|_| Met::Nothing)),
        }
        rays.extend(own);
        Ok(())
    }
}
