//! How long passes take: by the device's clock where it can be believed.
//!
//! llvmpipe answers timestamps around compute passes with moments of its rasteriser's
//! queue: it copies 256 MiB in no time at all. So a clock is tried before it is used.

use std::time::Instant;

use crate::context::Gpu;
use crate::error::GpuError;

/// Who says how long something takes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Clock {
    /// The device: timestamps around passes.
    Device,
    /// The host, and why: each span is submitted by itself, and the time until the device
    /// is idle is taken, so that it holds what a submission costs.
    Host(String),
}

/// Times spans of passes.
pub struct Timer {
    spans: u32,
    /// The device's clock; `None`: the host's.
    queries: Option<Queries>,
}

/// Room for the timestamps of all spans.
pub(crate) struct Queries {
    set: wgpu::QuerySet,
    ticks: wgpu::Buffer,
    /// Nanoseconds of a tick.
    period: f64,
}

/// What a pass notes of a span.
#[derive(Clone, Copy)]
pub(crate) struct Writes<'t> {
    set: &'t wgpu::QuerySet,
    begin: Option<u32>,
    end: Option<u32>,
}

impl Timer {
    /// A timer of `spans` spans.
    ///
    /// # Errors
    /// What the device refuses.
    pub fn new(gpu: &Gpu, clock: &Clock, spans: u32) -> Result<Self, GpuError> {
        let queries = match clock {
            Clock::Device => Some(Queries::new(gpu, spans)?),
            Clock::Host(_) => None,
        };
        Ok(Self { spans, queries })
    }

    /// Runs spans in this order, all of them each once, and gives the seconds of each by
    /// its number: from the beginning of its first pass to the end of its last. `record`
    /// records a span, each pass with what [`Queries::writes`] says of it.
    pub(crate) fn time(
        &self,
        gpu: &Gpu,
        order: impl Iterator<Item = u32>,
        mut record: impl FnMut(u32, &mut wgpu::CommandEncoder, Option<&Queries>),
    ) -> Result<Vec<f64>, GpuError> {
        if let Some(queries) = &self.queries {
            let mut encoder = gpu.encoder();
            for span in order {
                record(span, &mut encoder, Some(queries));
            }
            return queries.submit(gpu, encoder, self.spans);
        }
        let mut seconds = vec![0.0; self.spans as usize];
        for span in order {
            let mut encoder = gpu.encoder();
            record(span, &mut encoder, None);
            let start = Instant::now();
            gpu.submit(encoder)?;
            seconds[span as usize] = start.elapsed().as_secs_f64();
        }
        Ok(seconds)
    }
}

impl Queries {
    fn new(gpu: &Gpu, spans: u32) -> Result<Self, GpuError> {
        let set = gpu.device.create_query_set(&wgpu::QuerySetDescriptor {
            label: Some("timestamps"),
            ty: wgpu::QueryType::Timestamp,
            count: 2 * spans,
        });
        let size = 16 * u64::from(spans);
        let ticks = gpu.make("timestamps", size, |device| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("timestamps"),
                size,
                usage: wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC,
                mapped_at_creation: false,
            })
        })?;
        gpu.check()?;
        Ok(Self {
            set,
            ticks,
            period: f64::from(gpu.queue.get_timestamp_period()),
        })
    }

    /// What pass `pass` of the `passes` of a span is to note; the inner ones nothing.
    pub(crate) fn writes(&self, span: u32, pass: usize, passes: usize) -> Option<Writes<'_>> {
        let writes = Writes {
            set: &self.set,
            begin: (pass == 0).then_some(2 * span),
            end: (pass + 1 == passes).then_some(2 * span + 1),
        };
        (writes.begin.is_some() || writes.end.is_some()).then_some(writes)
    }

    fn submit(
        &self,
        gpu: &Gpu,
        mut encoder: wgpu::CommandEncoder,
        spans: u32,
    ) -> Result<Vec<f64>, GpuError> {
        encoder.resolve_query_set(&self.set, 0..2 * spans, &self.ticks, 0);
        gpu.submit(encoder)?;
        let ticks: Vec<u64> = gpu.read(&self.ticks, 2 * spans as usize)?;
        let seconds = |span: &[u64]| span[1].saturating_sub(span[0]) as f64 * self.period * 1e-9;
        Ok(ticks.chunks_exact(2).map(seconds).collect())
    }
}

impl<'t> Writes<'t> {
    pub(crate) fn compute(self) -> wgpu::ComputePassTimestampWrites<'t> {
        wgpu::ComputePassTimestampWrites {
            query_set: self.set,
            beginning_of_pass_write_index: self.begin,
            end_of_pass_write_index: self.end,
        }
    }

    pub(crate) fn render(self) -> wgpu::RenderPassTimestampWrites<'t> {
        wgpu::RenderPassTimestampWrites {
            query_set: self.set,
            beginning_of_pass_write_index: self.begin,
            end_of_pass_write_index: self.end,
        }
    }
}
