//! A frame that is set up once and run many times, each part timed.
//!
//! Nothing goes to the host in between: queues say how many rays they hold, and passes are
//! dispatched by that. Kernels run unchecked, as an engine has them, so only ours may, and only
//! where a checked run has been, which also tells how much room there must be and how often a
//! search is dispatched.

use triptych_spec::dispatch::{Sums, World};
use triptych_spec::grid::Membership;
use triptych_spec::grid::axis::Axis;
use triptych_spec::grid::trace::Query;

use super::Batch;
use super::device::Device;
use super::queue::Queue;
use crate::context::Gpu;
use crate::error::GpuError;
use crate::grid::{self, Shape};
use crate::kernel::Kernels;
use crate::raster::MEMORY;
use crate::ready::Ready;
use crate::timer::{Queries, Timer};

/// What is timed, in the order of a bounce.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Span {
    /// The triangles' cells: stages count, scan and fill, and the bricks.
    Cells,
    /// Stage primary.
    Primary,
    /// Stage intersect, of rays that ask for the nearest triangle.
    Closest,
    /// Stages locate and light.
    Light,
    /// Stage intersect, of rays to lamps.
    Any,
    /// Stage deposit.
    Deposit,
    /// Stage reflect.
    Reflect,
}

/// A part of a frame.
struct Part {
    span: Span,
    /// The bounce that it belongs to.
    bounce: u32,
    passes: Vec<Ready>,
}

/// A frame that is set up.
pub struct Timed<'g> {
    gpu: &'g Gpu,
    device: Device<'g>,
    parts: Vec<Part>,
    sums: wgpu::Buffer,
    /// For each bounce of each batch: attempts to store a ray that asks for the nearest triangle, and
    /// one to a lamp.
    counts: wgpu::Buffer,
    batches: Vec<Batch>,
    /// Bytes of the buffers that its stages share, triangles and their grid among them.
    pub bytes: u64,
}

/// The buffers that bounces share.
struct Shared {
    /// In turn: the rays of a bounce, and the next's.
    queues: [Queue; 2],
    shadows: Queue,
    surfaces: wgpu::Buffer,
}

impl<'g> Timed<'g> {
    /// Sets everything up: for the cells what a checked build needed, `None` without triangles,
    /// and for each batch of pixels what a checked frame needed.
    ///
    /// # Errors
    /// Limits by name, and whatever the device reports.
    pub fn new(
        gpu: &'g Gpu,
        kernels: &'g Kernels,
        world: &World,
        cells: Option<(&[Axis; 3], Shape)>,
        batches: &[Batch],
    ) -> Result<Self, GpuError> {
        let device = Device::new(gpu, kernels, world)?;
        let room = match cells {
            None => None,
            Some((axes, shape)) => {
                let blockers = &world.blockers;
                let grid = grid::Device::new(gpu, kernels, blockers, axes, Membership::Box)?;
                Some((grid::Room::of(grid.exactly(), shape)?, shape))
            }
        };
        let shared = Shared::new(&device, batches)?;
        let of_grid = room.as_ref().map_or(0, |(room, _)| room.bytes(true));
        let bounces = batches.iter().map(|batch| batch.bounces.len() as u64);
        let mut timed = Self {
            sums: device.sums()?,
            counts: gpu.storage("numbers of rays", 8 * bounces.sum::<u64>())?,
            bytes: shared.bytes() + of_grid + device.bytes(),
            gpu,
            device,
            parts: Vec::new(),
            batches: batches.to_vec(),
        };
        timed.bytes += timed.sums.size();
        if let Some((room, shape)) = &room {
            timed.push(Span::Cells, 0, room.build(*shape)?);
        }
        let mut slot = 0;
        for batch in batches {
            timed.batch(batch, &shared, room.as_ref().map(|room| &room.0), &mut slot)?;
        }
        Ok(timed)
    }

    fn push(&mut self, span: Span, bounce: u32, passes: Vec<Ready>) {
        if !passes.is_empty() {
            self.parts.push(Part {
                span,
                bounce,
                passes,
            });
        }
    }

    /// The passes of some pixels.
    fn batch(
        &mut self,
        batch: &Batch,
        shared: &Shared,
        room: Option<&grid::Room<'g>>,
        slot: &mut u64,
    ) -> Result<(), GpuError> {
        let count = batch.bounces.first().map_or(0, |needs| needs.rays);
        let pattern = self.gpu.upload("number of rays", &[count, 0, 0, 0])?;
        let device = &self.device;
        let [first, _] = &shared.queues;
        let primary = device.primary(batch.first, count, first)?;
        let mut primary = primary.after_copying(pattern, first.counter.clone());
        if batch.first == 0 {
            primary.clear(self.sums.clone());
        }
        let counted = device.count(first)?;
        self.push(Span::Primary, 0, vec![primary, counted]);
        for (bounce, needs) in (0..).zip(&batch.bounces) {
            let [queue, next] = match bounce % 2 {
                0 => [&shared.queues[0], &shared.queues[1]],
                _ => [&shared.queues[1], &shared.queues[0]],
            };
            let search = |queue: &Queue, query, rounds| match room {
                Some(room) => room.search_counted(queue.counted(), query, rounds),
                None => Ok(Vec::new()),
            };
            let (device, surfaces) = (&self.device, ("surfaces", &shared.surfaces));
            let shadows = &shared.shadows;
            let tell = |pass: Ready, queue: &Queue, at: u64| {
                pass.after_word((&queue.counter, 0), (&self.counts, 8 * *slot + at))
            };
            let closest = search(queue, Query::Closest, needs.rounds[0])?;
            let locate = device.through("locate", queue, None, surfaces)?;
            let light = vec![
                tell(locate, queue, 0),
                device.through("light", queue, Some(shadows), surfaces)?,
                tell(device.count(shadows)?, shadows, 4),
            ];
            let any = search(shadows, Query::Any, needs.rounds[1])?;
            let deposit = vec![
                device.through("deposit", shadows, None, ("sums", &self.sums))?,
                device.through("deposit", queue, None, ("sums", &self.sums))?,
            ];
            let reflect = vec![
                device.through("reflect", queue, Some(next), surfaces)?,
                device.count(next)?,
            ];
            self.push(Span::Closest, bounce, closest);
            self.push(Span::Light, bounce, light);
            self.push(Span::Any, bounce, any);
            self.push(Span::Deposit, bounce, deposit);
            self.push(Span::Reflect, bounce, reflect);
            *slot += 1;
        }
        Ok(())
    }

    /// The parts, in the order in which they run, each with the bounce that it belongs to; of each
    /// batch all.
    pub fn spans(&self) -> impl ExactSizeIterator<Item = (Span, u32)> {
        self.parts.iter().map(|part| (part.span, part.bounce))
    }

    /// Runs a frame, and gives the seconds of each part; `timer` has a span for each.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn time(&self, timer: &Timer) -> Result<Vec<f64>, GpuError> {
        let count = u32::try_from(self.parts.len()).expect("few");
        timer.time(self.gpu, 0..count, |span, encoder, queries| {
            let part = &self.parts[span as usize];
            record([part].into_iter(), span, encoder, queries);
        })
    }

    /// Runs a frame, and gives the seconds from its first pass to the end of its last; `timer`
    /// has one span.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn time_whole(&self, timer: &Timer) -> Result<f64, GpuError> {
        let seconds = timer.time(self.gpu, 0..1, |span, encoder, queries| {
            record(self.parts.iter(), span, encoder, queries);
        })?;
        Ok(seconds[0])
    }

    /// The picture of the last frame.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn sums(&self) -> Result<Sums, GpuError> {
        self.device.read_sums(&self.sums)
    }

    /// Rays of each bounce of the last frame, all batches together: those that ask for the
    /// nearest triangle, and those to lamps.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn rays(&self) -> Result<Vec<[u64; 2]>, GpuError> {
        let bounces = self.batches.iter().map(|batch| batch.bounces.len());
        let counts: Vec<[u32; 2]> = self.gpu.read(&self.counts, bounces.clone().sum())?;
        let mut all = vec![[0; 2]; bounces.clone().max().unwrap_or(0)];
        let numbers = bounces.flat_map(|bounces| 0..bounces);
        for (bounce, counts) in numbers.zip(counts) {
            for (sum, count) in all[bounce].iter_mut().zip(counts) {
                *sum += u64::from(count);
            }
        }
        Ok(all)
    }
}

impl Shared {
    fn new(device: &Device<'_>, batches: &[Batch]) -> Result<Self, GpuError> {
        let gpu = device.gpu;
        let needs = || batches.iter().flat_map(|batch| &batch.bounces);
        let rays = needs().map(|needs| needs.rays).max().unwrap_or(0);
        let shadows = needs().map(|needs| needs.shadows).max().unwrap_or(0);
        let bytes = super::queue::BYTES * (2 * u64::from(rays) + u64::from(shadows));
        if bytes > MEMORY {
            return Err(GpuError::Limit {
                adapter: gpu.name.clone(),
                what: "queues of rays",
                needed: bytes,
                limit: MEMORY,
            });
        }
        Ok(Self {
            queues: [Queue::new(gpu, rays)?, Queue::new(gpu, rays)?],
            shadows: Queue::new(gpu, shadows)?,
            surfaces: device.surfaces(rays)?,
        })
    }

    fn bytes(&self) -> u64 {
        let queues = self.queues.iter().chain([&self.shadows]);
        let rays: u64 = queues.map(|queue| u64::from(queue.capacity)).sum();
        super::queue::BYTES * rays + self.surfaces.size()
    }
}

/// Records the passes of some parts as one span.
fn record<'p>(
    parts: impl Iterator<Item = &'p Part> + Clone,
    span: u32,
    encoder: &mut wgpu::CommandEncoder,
    queries: Option<&Queries>,
) {
    let passes = parts.flat_map(|part| &part.passes);
    let count = passes.clone().count();
    for (at, pass) in passes.enumerate() {
        let writes = queries.and_then(|q| q.writes(span, at, count));
        pass.record(encoder, writes);
    }
}
