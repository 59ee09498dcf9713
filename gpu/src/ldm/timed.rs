//! Maps that are set up once and built and asked many times, each timed.
//!
//! Kernels run unchecked, as an engine has them, so only ours may, and only on what a checked
//! run has been through: that run also tells how many keys there are.

mod chained;

use triptych_spec::grid::Blockers;
use triptych_spec::ldm::{Falloff, Layers, Maps, Receiver, Sky};

use super::batch;
use super::device::Device;
use super::light::{ASKED, asking, fading, lists, padded, runs};
use super::lists::{Batch, COUNT, FILL, LONGEST};
use super::{Open, Told};
use crate::context::Gpu;
use crate::error::GpuError;
use crate::kernel::Kernels;
use crate::lists::{LONG, TILE, long_passes};
use crate::ready::Ready;
use crate::timer::Timer;

pub use chained::{ChainSpan, TimedChains};

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
    /// What of every receiver's directions is open, or lets light through.
    Ask,
}

impl Span {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Count, Self::Scan, Self::Fill, Self::Sort, Self::Ask];
}

/// What receivers ask.
#[derive(Clone, Copy)]
pub enum Question<'q> {
    /// Stage `occlusion`.
    Occlusion(Falloff),
    /// Stage `environment`: the sky of each map, and which maps are asked.
    Environment(&'q [Sky], &'q [bool]),
}

/// Buffers and passes, ready to run.
pub struct Timed<'g> {
    device: Device<'g>,
    batches: Vec<Batch>,
    spans: [Vec<Ready>; 5],
    /// What was asked for, of each receiver.
    answers: wgpu::Buffer,
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
        (receivers, question): (&[Receiver], Question<'_>),
    ) -> Result<Self, GpuError> {
        let device = Device::new(gpu, kernels, maps, blockers, u64::MAX)?;
        let packed: Vec<_> = receivers.iter().map(super::Receiver::from).collect();
        let own = gpu.upload("receivers", &packed)?;
        let size = match question {
            Question::Occlusion(_) => size_of::<Open>(),
            Question::Environment(..) => size_of::<[f32; 4]>(),
        };
        let answers = gpu.storage("what is open", (size * receivers.len()) as u64)?;
        let mut timed = Self {
            batches: Vec::new(),
            spans: [const { Vec::new() }; 5],
            receivers: receivers.len(),
            bytes: device.bytes(),
            answers,
            device,
        };
        timed.spans[Span::Count as usize].push(timed.device.sizes()?);
        for span in timed.device.batches_of(layers) {
            timed.add(span, layers)?;
        }
        timed.ask(&own, question)?;
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
            let told = Told {
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

    fn ask(&mut self, receivers: &wgpu::Buffer, question: Question<'_>) -> Result<(), GpuError> {
        let items = u32::try_from(self.receivers).expect("fewer than 2^32");
        let device = &self.device;
        let (entry, name, told, skies) = match question {
            Question::Occlusion(falloff) => {
                let told = fading(device.told, falloff);
                ("occlusion", "opened", told, None)
            }
            Question::Environment(skies, _) => {
                let skies: Vec<[[f32; 4]; 2]> = skies.iter().map(padded).collect();
                let skies = device.gpu.upload("skies of maps", &skies)?;
                ("environment", "light", device.told, Some(skies))
            }
        };
        let asked = |map: u32| match question {
            Question::Occlusion(_) => true,
            Question::Environment(_, lit) => lit[map as usize],
        };
        let mut named = vec![("receivers", receivers), (name, &self.answers)];
        named.extend(skies.iter().map(|skies| ("skies", skies)));
        let mut passes = Vec::new();
        for batch in &self.batches {
            let named = [&named[..], &lists(batch)].concat();
            for maps in runs(batch.span.maps.clone(), asked) {
                for told in asking(batch, maps, told, items, ASKED) {
                    passes.push(device.each(entry, told, &named)?);
                }
            }
        }
        if passes.is_empty() {
            // A span has a pass, by which it is timed.
            let none = Told { items: 0, ..told };
            passes.push(device.each("layers_larges", none, &[])?);
        }
        let first = passes.remove(0).after_clearing(self.answers.clone());
        passes.insert(0, first);
        self.spans[Span::Ask as usize] = passes;
        Ok(())
    }

    /// Runs all spans once, in their order, and gives the seconds of each; `timer` has five.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn time(&self, timer: &Timer) -> Result<Vec<f64>, GpuError> {
        timed(self.device.gpu, &self.spans, timer)
    }

    /// What the last run found open, if it asked for that.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn opened(&self) -> Result<Vec<Open>, GpuError> {
        self.device.gpu.read(&self.answers, self.receivers)
    }

    /// The light that the last run summed up, if it asked for that; the fourth numbers mean
    /// nothing, and nothing is divided by the number of directions.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn light(&self) -> Result<Vec<[f32; 4]>, GpuError> {
        self.device.gpu.read(&self.answers, self.receivers)
    }

    /// The lists that the last run left.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn layers(&self) -> Result<Layers, GpuError> {
        self.device.read(&self.batches)
    }
}

/// Runs spans of passes once, in their order, and gives the seconds of each.
fn timed(gpu: &Gpu, spans: &[Vec<Ready>], timer: &Timer) -> Result<Vec<f64>, GpuError> {
    let count = u32::try_from(spans.len()).expect("few");
    timer.time(gpu, 0..count, |at, encoder, queries| {
        let passes = &spans[at as usize];
        for (number, pass) in passes.iter().enumerate() {
            let writes = queries.and_then(|q| q.writes(at, number, passes.len()));
            pass.record(encoder, writes);
        }
    })
}
