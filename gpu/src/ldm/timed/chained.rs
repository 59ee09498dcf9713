//! The paper's linked lists, built and put in order as stage `chain` does.

use triptych_spec::abuffer::EOL;
use triptych_spec::grid::Blockers;
use triptych_spec::ldm::{Layers, Maps};

use super::timed;
use crate::abuffer::PROGRESS;
use crate::context::Gpu;
use crate::error::GpuError;
use crate::kernel::Kernels;
use crate::ldm::batch::{Span, spans};
use crate::ldm::device::Device;
use crate::ldm::{Chains, Link};
use crate::ready::Ready;
use crate::timer::Timer;

/// What is timed, in the order of all results here.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ChainSpan {
    /// Heads, counter and progress as they are before, and every key into its list.
    Link,
    /// Lists in order.
    Sort,
}

impl ChainSpan {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::Link, Self::Sort];
}

/// Lists of a batch of maps.
struct Pool {
    heads: wgpu::Buffer,
    nodes: wgpu::Buffer,
    counter: wgpu::Buffer,
    /// Lists, and entries that there is room for.
    pixels: u32,
    capacity: u32,
}

/// Buffers and passes, ready to run.
pub struct TimedChains<'g> {
    device: Device<'g>,
    pools: Vec<Pool>,
    spans: [Vec<Ready>; 2],
    /// Bytes of all that a build reads or writes.
    pub bytes: u64,
}

impl<'g> TimedChains<'g> {
    /// Sets everything up for lists that a checked run made, in runs, and for which a checked run
    /// of stage `chain` took so many `turns`.
    ///
    /// # Errors
    /// Limits by name, and whatever the device reports.
    pub fn new(
        gpu: &'g Gpu,
        kernels: &'g Kernels,
        (maps, blockers): (&'g Maps, &Blockers),
        layers: &Layers,
        turns: u32,
    ) -> Result<Self, GpuError> {
        let device = Device::new(gpu, kernels, maps, blockers, u64::MAX)?;
        let batches = spans(maps, device.room / PROGRESS);
        let longest = batches.iter().map(Span::len).max().unwrap_or(0);
        let ends = gpu.filled("ends of lists", longest, EOL)?;
        let mut chains = Self {
            pools: Vec::new(),
            spans: [vec![device.sizes()?], Vec::new()],
            bytes: device.bytes() + ends.size(),
            device,
        };
        for span in batches {
            let own = |pixel: u32| layers.offsets[pixel as usize];
            let capacity = own(span.pixels.end) - own(span.pixels.start);
            chains.add(&span, &ends, (capacity, turns))?;
        }
        Ok(chains)
    }

    /// Room and passes for a batch.
    fn add(
        &mut self,
        span: &Span,
        ends: &wgpu::Buffer,
        (capacity, turns): (u32, u32),
    ) -> Result<(), GpuError> {
        let device = &self.device;
        let gpu = device.gpu;
        let pixels = u64::from(span.len());
        let heads = gpu.storage("heads", 4 * pixels)?;
        let nodes = gpu.storage("entries of lists", 8 * u64::from(capacity))?;
        let counter = gpu.storage("counter", 4)?;
        let progress = gpu.storage("progress of pixels", PROGRESS * pixels)?;
        for buffer in [&heads, &nodes, &counter, &progress] {
            self.bytes += buffer.size();
        }
        let named = [
            ("heads", &heads),
            ("nodes", &nodes),
            ("counter", &counter),
            ("progress", &progress),
        ];
        let mut link = device.draw(["chain", "chain_large"], (span, capacity), &named)?;
        // Before a pass that is not the span's first, and so within its time.
        let first = link
            .remove(0)
            .after_copying(ends.clone(), heads.clone())
            .after_clearing(counter.clone())
            .after_clearing(progress.clone());
        link.insert(0, first);
        self.spans[ChainSpan::Link as usize].extend(link);
        let told = span.told(device.told);
        for _ in 0..turns {
            let pass = device.each("chain_sort", told, &named)?;
            self.spans[ChainSpan::Sort as usize].push(pass);
        }
        self.pools.push(Pool {
            heads,
            nodes,
            counter,
            pixels: span.len(),
            capacity,
        });
        Ok(())
    }

    /// Runs both spans once, in their order, and gives the seconds of each; `timer` has two.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn time(&self, timer: &Timer) -> Result<Vec<f64>, GpuError> {
        timed(self.device.gpu, &self.spans, timer)
    }

    /// The lists that the last run left, all batches as one.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn chains(&self) -> Result<Chains, GpuError> {
        let gpu = self.device.gpu;
        let mut all = Chains::default();
        for pool in &self.pools {
            let base = u32::try_from(all.links.len()).unwrap_or(EOL);
            let links: Vec<Link> = gpu.read(&pool.nodes, pool.capacity as usize)?;
            let own = Chains {
                heads: gpu.read(&pool.heads, pool.pixels as usize)?,
                links,
                attempts: gpu.word(&pool.counter, 0)?.into(),
            };
            all.append(own, base);
        }
        Ok(all)
    }
}
