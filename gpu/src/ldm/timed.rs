//! Maps that are set up once and built and asked many times, each timed.
//!
//! Kernels run unchecked, as an engine has them, so only ours may, and only on what a checked
//! run has been through: that run also tells how many keys there are.

use triptych_spec::grid::Blockers;
use triptych_spec::ldm::{Falloff, Layers, Maps, Receiver};

use super::Open;
use super::batch;
use super::device::Device;
use super::light::{ASKED, asking, fading, lists};
use super::lists::{Batch, COUNT, FILL, LONGEST};
use crate::context::Gpu;
use crate::dispatch::Ready;
use crate::error::GpuError;
use crate::kernel::Kernels;
use crate::lists::{LONG, TILE, long_passes};
use crate::timer::Timer;

/// What is timed, in the order of all results here.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Span {
    /// Keys of every pixel.
    Count,
    /// Where every list ends.
    Scan,
    /// Keys into their lists.
    Fill,
    /// Lists in order.
    Sort,
    /// What of every receiver's directions is open.
    Occlusion,
}

impl Span {
    /// All of them.
    pub const ALL: [Self; 5] = [
        Self::Count,
        Self::Scan,
        Self::Fill,
        Self::Sort,
        Self::Occlusion,
    ];
}

/// Buffers and passes, ready to run.
pub struct Timed<'g> {
    device: Device<'g>,
    batches: Vec<Batch>,
    spans: [Vec<Ready>; 5],
    opened: wgpu::Buffer,
    receivers: usize,
    /// Bytes of all that a build reads or writes.
    pub bytes: u64,
}

impl<'g> Timed<'g> {
    /// Sets everything up for lists that a checked run made.
    ///
    /// # Errors
    /// Limits by name, and whatever the device reports.
    pub fn new(
        gpu: &'g Gpu,
        kernels: &'g Kernels,
        (maps, blockers): (&'g Maps, &Blockers),
        layers: &Layers,
        (receivers, falloff): (&[Receiver], Falloff),
    ) -> Result<Self, GpuError> {
        let device = Device::new(gpu, kernels, maps, blockers, u64::MAX)?;
        let packed: Vec<_> = receivers.iter().map(super::Receiver::from).collect();
        let own = gpu.upload("receivers", &packed)?;
        let opened = gpu.storage("what is open", 8 * receivers.len() as u64)?;
        let mut timed = Self {
            batches: Vec::new(),
            spans: [const { Vec::new() }; 5],
            receivers: receivers.len(),
            bytes: device.bytes(),
            opened,
            device,
        };
        timed.spans[Span::Count as usize].push(timed.device.sizes()?);
        for span in timed.device.batches_of(layers) {
            timed.add(span, layers)?;
        }
        timed.ask(&own, falloff)?;
        Ok(timed)
    }

    /// Room and passes for a batch.
    fn add(&mut self, span: batch::Span, layers: &Layers) -> Result<(), GpuError> {
        let device = &self.device;
        let gpu = device.gpu;
        let own = &layers.offsets[span.pixels.start as usize..=span.pixels.end as usize];
        let total = own[own.len() - 1] - own[0];
        let longest = own.windows(2).map(|run| run[1] - run[0]).max().unwrap_or(0);
        let offsets = gpu.storage("offsets of pixels", 4 * (u64::from(span.len()) + 1))?;
        let keys = gpu.storage("keys of pixels", 4 * u64::from(total))?;
        let tiles = 4 * u64::from(span.len().div_ceil(TILE));
        let sums = gpu.storage("sums of tiles", tiles)?;
        let more = if longest > LONG { keys.size() } else { 0 };
        let merged = gpu.storage("keys of pixels", more)?;
        self.bytes += offsets.size() + keys.size() + sums.size() + more;
        let mut named = vec![
            ("counts", &offsets),
            ("offsets", &offsets),
            ("listed", &keys),
            ("merged", &merged),
            ("sums", &sums),
        ];
        let mut count = device.draw(COUNT, (&span, 0), &named)?;
        if !count.is_empty() {
            let first = count.remove(0).after_clearing(offsets.clone());
            count.insert(0, first);
        }
        let told = span.told(device.told);
        let mut sort = vec![device.each("layers_sort", told, &named)?];
        let fill = device.draw(FILL, (&span, total), &named)?;
        let scan = device.scan(&span, &named)?;
        let mut swapped = false;
        for (entry, run) in long_passes(LONGEST, longest) {
            let told = super::Told {
                items: total,
                run,
                ..told
            };
            sort.push(device.each(entry, told, &named)?);
            (named[2].1, named[3].1) = (named[3].1, named[2].1);
            swapped = !swapped;
        }
        for (at, passes) in [count, scan, fill, sort].into_iter().enumerate() {
            self.spans[at].extend(passes);
        }
        self.batches.push(Batch {
            keys: if swapped { merged } else { keys },
            offsets,
            total,
            longest,
            span,
        });
        Ok(())
    }

    fn ask(&mut self, receivers: &wgpu::Buffer, falloff: Falloff) -> Result<(), GpuError> {
        let told = fading(self.device.told, falloff);
        let items = u32::try_from(self.receivers).expect("fewer than 2^32");
        let named = [("receivers", receivers), ("opened", &self.opened)];
        let mut passes = Vec::new();
        for batch in &self.batches {
            let named = [&named[..], &lists(batch)].concat();
            for told in asking(batch, batch.span.maps.clone(), told, items, ASKED) {
                let pass = self.device.each("occlusion", told, &named)?;
                passes.push(match passes.is_empty() {
                    true => pass.after_clearing(self.opened.clone()),
                    false => pass,
                });
            }
        }
        self.spans[Span::Occlusion as usize] = passes;
        Ok(())
    }

    /// Runs all spans once, in their order, and gives the seconds of each; `timer` has five.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn time(&self, timer: &Timer) -> Result<Vec<f64>, GpuError> {
        timer.time(self.device.gpu, 0..5, |at, encoder, queries| {
            let passes = &self.spans[at as usize];
            for (number, pass) in passes.iter().enumerate() {
                let writes = queries.and_then(|q| q.writes(at, number, passes.len()));
                pass.record(encoder, writes);
            }
        })
    }

    /// What the last run found open.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn opened(&self) -> Result<Vec<Open>, GpuError> {
        self.device.gpu.read(&self.opened, self.receivers)
    }

    /// The lists that the last run left.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn layers(&self) -> Result<Layers, GpuError> {
        self.device.read(&self.batches)
    }
}
