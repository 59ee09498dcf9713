//! What an adapter can do at most, measured: bytes copied, and atomics in the pattern in
//! which lists are built. The fraction of a bound that `triptych bench` gives is of these.

use std::time::Instant;

use crate::context::Gpu;
use crate::error::GpuError;
use crate::frame::{Frame, WORKGROUP};
use crate::kernel::{Kernels, Pipeline};
use crate::timer::{Clock, Queries, Timer, Writes};

/// Bytes that are read, and as many that are written; more than any cache holds, and the
/// most that every WebGPU device binds.
const COPIED: u64 = 128 << 20;

/// Bytes of a copied item.
const ITEM: u64 = 16;

/// Insertions, and the heads that they go to: a picture of a million pixels, four layers.
const INSERTED: u32 = 1 << 22;
const HEADS: u32 = 1 << 20;

/// Workgroups in a row of a dispatch.
const ROW: u32 = 1 << 12;

/// The device's clock is tried on copies that take the host at least so many seconds,
/// of which it must account for half: the rest is what submitting and waiting cost.
const TRIED: f64 = 0.1;

/// Copies beyond which no device needs more to be tried.
const COPIES_MAX: usize = 1 << 14;

/// Rates of one run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rates {
    /// Bytes read and written per second.
    pub bytes: f64,
    /// Atomics per second, two for each insertion.
    pub atomics: f64,
}

/// A measurement that is set up.
pub struct Ceiling<'g> {
    gpu: &'g Gpu,
    clock: Clock,
    timer: Timer,
    copy: Dispatch,
    exchange: Dispatch,
    counter: wgpu::Buffer,
    bytes: u64,
}

/// A kernel, what it binds, and its workgroups.
struct Dispatch(wgpu::ComputePipeline, wgpu::BindGroup, u32);

impl<'g> Ceiling<'g> {
    /// Sets up the measurement, and tries the device's clock.
    ///
    /// # Errors
    /// An adapter without the memory; what the device refuses.
    pub fn new(gpu: &'g Gpu, kernels: &Kernels) -> Result<Self, GpuError> {
        let bytes = COPIED.min(gpu.binding_limit() / ITEM * ITEM);
        let items = u32::try_from(bytes / ITEM).expect("fewer than 2^32 items in 128 MiB");
        let counter = gpu.filled("counter", 1, 0)?;
        let copied = [
            ("source", gpu.storage("source", bytes)?),
            ("copied", gpu.storage("copied", bytes)?),
        ];
        let exchanged = [
            ("counter", counter.clone()),
            ("heads", gpu.storage("heads", 4 * u64::from(HEADS))?),
            ("links", gpu.storage("links", 4 * u64::from(INSERTED))?),
        ];
        let copy = Dispatch::new(gpu, kernels, "copy", &copied, items)?;
        let exchange = Dispatch::new(gpu, kernels, "exchange", &exchanged, INSERTED)?;
        let clock = try_clock(gpu, &copy)?;
        Ok(Self {
            gpu,
            timer: Timer::new(gpu, &clock, 2)?,
            clock,
            copy,
            exchange,
            counter,
            bytes,
        })
    }

    /// The clock that can be believed.
    pub fn clock(&self) -> &Clock {
        &self.clock
    }

    /// Measures once.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn measure(&self) -> Result<Rates, GpuError> {
        let mut encoder = self.gpu.encoder();
        encoder.clear_buffer(&self.counter, 0, None);
        self.gpu.submit(encoder)?;
        let seconds = self.timer.time(self.gpu, 0..2, |span, encoder, queries| {
            let dispatch = [&self.copy, &self.exchange][span as usize];
            dispatch.record(encoder, queries.and_then(|q| q.writes(span, 0, 1)));
        })?;
        Ok(Rates {
            bytes: 2.0 * self.bytes as f64 / seconds[0],
            atomics: 2.0 * f64::from(INSERTED) / seconds[1],
        })
    }
}

impl Dispatch {
    fn new(
        gpu: &Gpu,
        kernels: &Kernels,
        entry: &str,
        buffers: &[(&str, wgpu::Buffer)],
        items: u32,
    ) -> Result<Self, GpuError> {
        let frame = Frame {
            width: HEADS,
            capacity: INSERTED,
            items,
            ..Frame::default()
        };
        let frame = gpu.uniform("frame", &frame)?;
        let kernel = kernels.compute(gpu, "ceiling", entry)?;
        let mut named = vec![("frame", &frame)];
        named.extend(buffers.iter().map(|(name, buffer)| (*name, buffer)));
        let group = kernel.bind(gpu, &named);
        let Pipeline::Compute(pipeline) = &kernel.pipeline else {
            unreachable!("Kernels::compute makes compute pipelines");
        };
        Ok(Self(pipeline.clone(), group, items.div_ceil(WORKGROUP)))
    }

    fn record(&self, encoder: &mut wgpu::CommandEncoder, writes: Option<Writes<'_>>) {
        let Self(pipeline, group, groups) = self;
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: None,
            timestamp_writes: writes.map(Writes::compute),
        });
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, group, &[]);
        pass.dispatch_workgroups(ROW.min(*groups), groups.div_ceil(ROW), 1);
    }
}

/// The device's clock if it accounts for copies, of which there are ever more until the
/// host notices.
fn try_clock(gpu: &Gpu, copy: &Dispatch) -> Result<Clock, GpuError> {
    if !gpu.has_timestamps() {
        return Ok(Clock::Host("it has no timestamps".to_owned()));
    }
    let timer = Timer::new(gpu, &Clock::Device, 1)?;
    let mut copies = 1;
    loop {
        let run = || {
            let start = Instant::now();
            let record = |span, encoder: &mut wgpu::CommandEncoder, queries: Option<&Queries>| {
                for number in 0..copies {
                    let writes = queries.and_then(|q| q.writes(span, number, copies));
                    copy.record(encoder, writes);
                }
            };
            let device = timer.time(gpu, 0..1, record)?[0];
            Ok::<_, GpuError>((device, start.elapsed().as_secs_f64()))
        };
        // The first time, memory is touched and kernels are made ready.
        run()?;
        let (device, host) = run()?;
        if host < TRIED && copies < COPIES_MAX {
            copies *= 2;
        } else if device >= 0.5 * host {
            return Ok(Clock::Device);
        } else {
            let [device, host] = [device, host].map(|seconds| 1000.0 * seconds);
            let reason = format!("its timestamps say {device:.3} ms of what takes {host:.0} ms");
            return Ok(Clock::Host(reason));
        }
    }
}
