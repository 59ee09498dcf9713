//! What an adapter can do at most, measured: bytes copied, and atomics in the pattern in
//! which lists are built. The fraction of a bound that `triptych bench` gives is of these.

use crate::context::Gpu;
use crate::error::GpuError;
use crate::frame::{Frame, WORKGROUP};
use crate::kernel::{Kernels, Pipeline};
use crate::timer::Timer;

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
    timer: Timer,
    passes: [(wgpu::ComputePipeline, wgpu::BindGroup, u32); 2],
    counter: wgpu::Buffer,
    bytes: u64,
}

impl<'g> Ceiling<'g> {
    /// Sets up the measurement.
    ///
    /// # Errors
    /// An adapter without timestamps, or without the memory; what the device refuses.
    pub fn new(gpu: &'g Gpu, kernels: &Kernels) -> Result<Self, GpuError> {
        let bytes = COPIED.min(gpu.binding_limit() / ITEM * ITEM);
        let items = u32::try_from(bytes / ITEM).expect("fewer than 2^32 items in 128 MiB");
        let counter = gpu.filled("counter", 1, 0)?;
        let copy = [
            ("source", gpu.storage("source", bytes)?),
            ("copied", gpu.storage("copied", bytes)?),
        ];
        let exchange = [
            ("counter", counter.clone()),
            ("heads", gpu.storage("heads", 4 * u64::from(HEADS))?),
            ("links", gpu.storage("links", 4 * u64::from(INSERTED))?),
        ];
        let pass = |entry, buffers: &[(&'static str, wgpu::Buffer)], items: u32| {
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
            Ok::<_, GpuError>((pipeline.clone(), group, items.div_ceil(WORKGROUP)))
        };
        Ok(Self {
            timer: Timer::new(gpu, 2)?,
            passes: [
                pass("copy", &copy, items)?,
                pass("exchange", &exchange, INSERTED)?,
            ],
            gpu,
            counter,
            bytes,
        })
    }

    /// Measures once.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn measure(&self) -> Result<Rates, GpuError> {
        let mut encoder = self.gpu.encoder();
        encoder.clear_buffer(&self.counter, 0, None);
        for (span, (pipeline, group, groups)) in (0..).zip(&self.passes) {
            let writes = self.timer.writes(span, 0, 1);
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
                label: None,
                timestamp_writes: writes.map(crate::timer::Writes::compute),
            });
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, group, &[]);
            pass.dispatch_workgroups(ROW.min(*groups), groups.div_ceil(ROW), 1);
        }
        let seconds = self.timer.submit(self.gpu, encoder)?;
        Ok(Rates {
            bytes: 2.0 * self.bytes as f64 / seconds[0],
            atomics: 2.0 * f64::from(INSERTED) / seconds[1],
        })
    }
}
