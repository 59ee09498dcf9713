//! When passes began and ended, by the device's own clock.

use crate::context::Gpu;
use crate::error::GpuError;

/// Room for the times of so many spans of passes.
pub struct Timer {
    set: wgpu::QuerySet,
    ticks: wgpu::Buffer,
    spans: u32,
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
    /// An adapter without timestamps, by its name; what the device refuses.
    pub fn new(gpu: &Gpu, spans: u32) -> Result<Self, GpuError> {
        if !gpu.has_timestamps() {
            return Err(GpuError::NoTimestamps {
                adapter: gpu.name.clone(),
            });
        }
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
            spans,
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

    /// Runs what was recorded, in which every span had its passes, and gives the seconds
    /// from the beginning of each span's first pass to the end of its last.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn submit(
        &self,
        gpu: &Gpu,
        mut encoder: wgpu::CommandEncoder,
    ) -> Result<Vec<f64>, GpuError> {
        encoder.resolve_query_set(&self.set, 0..2 * self.spans, &self.ticks, 0);
        gpu.submit(encoder)?;
        let ticks: Vec<u64> = gpu.read(&self.ticks, 2 * self.spans as usize)?;
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
