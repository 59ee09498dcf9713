//! What the host does for each stage.

use std::time::Duration;

use triptych_spec::dispatch::{Carried, Met, Ray, Sums, World};
use triptych_spec::grid::ray::Ray as Way;
use triptych_spec::grid::trace::Query;
use triptych_spec::grid::{Grid, Membership};
use triptych_spec::rsm::Surface as SpecSurface;

use super::device::Device;
use super::queue::Queue;
use super::records::met;
use super::{Appended, Hits, Overflow, Surfaces};
use crate::context::Gpu;
use crate::error::GpuError;
use crate::grid;
use crate::kernel::Kernels;
use crate::rsm::Surface;

/// Stages of the ray tracer. What is read back is what the device says: triangles may be none of
/// the world.
pub struct Stages<'g> {
    pub(super) device: Device<'g>,
    /// The triangles' cells; `None` without triangles, which nothing meets.
    pub(super) grid: Option<grid::Stages<'g>>,
    /// Time on the device of what ran last, without transfers.
    pub time: Duration,
}

impl<'g> Stages<'g> {
    /// Uploads a world and its cells.
    ///
    /// # Errors
    /// Limits by name, and whatever the device reports; so for all stages.
    pub fn new(
        gpu: &'g Gpu,
        kernels: &'g Kernels,
        world: &World,
        grid: &Grid,
    ) -> Result<Self, GpuError> {
        Ok(Self {
            device: Device::new(gpu, kernels, world)?,
            grid: cells(gpu, kernels, world, grid)?,
            time: Duration::ZERO,
        })
    }

    /// Stage `primary`: the ray of each pixel.
    pub fn primary(&mut self) -> Result<Vec<Ray>, GpuError> {
        let device = &self.device;
        let pixels = device.size.width * device.size.height;
        let batch = device.batch();
        let mut rays = Vec::with_capacity(pixels as usize);
        self.time = Duration::ZERO;
        for first in (0..pixels).step_by(batch as usize) {
            let count = batch.min(pixels - first);
            let queue = Queue::new(device.gpu, count)?;
            self.time += device.primary(first, count, &queue)?.run(device.gpu)?;
            rays.extend(queue.read(device.gpu, count)?);
        }
        Ok(rays)
    }

    /// Stage `intersect`: what each ray meets.
    pub fn intersect(&mut self, rays: &[Ray]) -> Result<Hits, GpuError> {
        self.time = Duration::ZERO;
        let mut all = vec![Met::Nothing; rays.len()];
        for query in [Query::Closest, Query::Any] {
            let asks = |ray: &Ray| match ray.carried {
                Carried::Weight(_) => query == Query::Closest,
                Carried::Light(_) => query == Query::Any,
            };
            let asking: Vec<usize> = (0..rays.len()).filter(|at| asks(&rays[*at])).collect();
            let ways: Vec<Way> = asking.iter().map(|at| rays[*at].way).collect();
            let Some(grid) = self.grid.as_mut().filter(|_| !ways.is_empty()) else {
                continue;
            };
            let hits = grid.trace(&ways, query)?;
            self.time += grid.time;
            for (at, hit) in asking.into_iter().zip(hits) {
                all[at] = met(&rays[at], hit.prim);
            }
        }
        Ok(all)
    }

    /// Stage `locate`: what rays that ask for the nearest triangle see of what they met.
    pub fn locate(&mut self, rays: &[Ray], met: &[Met]) -> Result<Surfaces, GpuError> {
        self.time = Duration::ZERO;
        let batch = self.device.batch() as usize;
        let mut all = Vec::with_capacity(rays.len());
        for (rays, met) in rays.chunks(batch).zip(met.chunks(batch)) {
            let queue = self.given(rays, Some(met))?;
            let surfaces = self.device.surfaces(queue.capacity)?;
            self.run("locate", &queue, None, ("surfaces", &surfaces))?;
            let seen: Vec<Surface> = self.device.gpu.read(&surfaces, rays.len())?;
            all.extend(seen.into_iter().map(Surface::unpacked));
        }
        Ok(all)
    }

    /// Stage `light`: rays to the lamps that could light what rays see, `capacity` of which have
    /// room at first.
    pub fn light(
        &mut self,
        rays: &[Ray],
        seen: &[Option<SpecSurface>],
        capacity: Option<u32>,
    ) -> Result<Appended, GpuError> {
        self.append("light", rays, seen, capacity)
    }

    /// Stage `reflect`: rays that mirrors send on, `capacity` of which have room at first.
    pub fn reflect(
        &mut self,
        rays: &[Ray],
        seen: &[Option<SpecSurface>],
        capacity: Option<u32>,
    ) -> Result<Appended, GpuError> {
        self.append("reflect", rays, seen, capacity)
    }

    /// Stage `deposit`: what rays that met nothing bring to a picture.
    pub fn deposit(&mut self, rays: &[Ray], met: &[Met]) -> Result<Sums, GpuError> {
        self.time = Duration::ZERO;
        let batch = self.device.batch() as usize;
        let sums = self.device.sums()?;
        for (rays, met) in rays.chunks(batch).zip(met.chunks(batch)) {
            let queue = self.given(rays, Some(met))?;
            self.run("deposit", &queue, None, ("sums", &sums))?;
        }
        self.device.read_sums(&sums)
    }

    fn append(
        &mut self,
        entry: &'static str,
        rays: &[Ray],
        seen: &[Option<SpecSurface>],
        capacity: Option<u32>,
    ) -> Result<Appended, GpuError> {
        self.time = Duration::ZERO;
        let batch = self.device.batch() as usize;
        let mut all = Appended::default();
        let parts = rays.chunks(batch).zip(seen.chunks(batch));
        for (number, (rays, seen)) in parts.enumerate() {
            let queue = self.given(rays, None)?;
            let first = number * batch;
            let packed = seen.iter().map(|s| Surface::packed(s.as_ref()));
            let packed: Vec<Surface> = packed.collect();
            let surfaces = self.device.gpu.upload("surfaces", &packed)?;
            let (next, overflows) = self.filled(entry, &queue, &surfaces, capacity)?;
            let count = next.items(self.device.gpu)?;
            all.rays.extend(next.read(self.device.gpu, count)?);
            all.overflows
                .extend(overflows.into_iter().map(|tried| Overflow {
                    asked: first..first + rays.len(),
                    ..tried
                }));
        }
        Ok(all)
    }

    /// A queue of what a stage appends for another's rays: tried with some room, then with as
    /// much as it needs.
    pub(super) fn filled(
        &mut self,
        entry: &str,
        queue: &Queue,
        surfaces: &wgpu::Buffer,
        capacity: Option<u32>,
    ) -> Result<(Queue, Vec<Overflow>), GpuError> {
        let mut capacity = capacity.unwrap_or(queue.capacity);
        let mut overflows = Vec::new();
        loop {
            let next = Queue::new(self.device.gpu, capacity)?;
            self.run(entry, queue, Some(&next), ("surfaces", surfaces))?;
            self.time += self.device.count(&next)?.run(self.device.gpu)?;
            let Some(overflow) = next.overflow(self.device.gpu)? else {
                return Ok((next, overflows));
            };
            capacity = overflow.attempts;
            overflows.push(overflow);
        }
    }

    /// A queue that is given, and counted.
    fn given(&mut self, rays: &[Ray], met: Option<&[Met]>) -> Result<Queue, GpuError> {
        let queue = Queue::of(self.device.gpu, rays, met)?;
        self.time += self.device.count(&queue)?.run(self.device.gpu)?;
        Ok(queue)
    }

    pub(super) fn run(
        &mut self,
        entry: &str,
        queue: &Queue,
        next: Option<&Queue>,
        buffer: (&str, &wgpu::Buffer),
    ) -> Result<(), GpuError> {
        let pass = self.device.through(entry, queue, next, buffer)?;
        self.time += pass.run(self.device.gpu)?;
        Ok(())
    }
}

/// The triangles' cells on the device.
fn cells<'g>(
    gpu: &'g Gpu,
    kernels: &'g Kernels,
    world: &World,
    grid: &Grid,
) -> Result<Option<grid::Stages<'g>>, GpuError> {
    if world.blockers.triangles.is_empty() {
        return Ok(None);
    }
    let device = grid::Device::new(gpu, kernels, &world.blockers, &grid.axes, Membership::Box)?;
    let mut stages = grid::Stages::new(device.exactly())?;
    stages.give_offsets(&grid.offsets)?;
    stages.give_prims(&grid.prims)?;
    Ok(Some(stages))
}
