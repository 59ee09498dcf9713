//! Stages cover and build of a whole target, set up once and run many times, each timed.
//!
//! Where an adapter binds less than all fragments take, they run in bands of rows, one
//! after another in the same buffers; the seconds of a stage are those of all its bands.

use super::buffers::{self, Buffers};
use crate::error::GpuError;
use crate::frame::{Band, Frame};
use crate::raster::{Attempts, Need, Rasterizer, Ready};
use crate::timer::Timer;

/// Bytes of a fragment in the stream.
const STREAMED: u64 = 16;

/// A stage, in the order of all results here.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Every fragment of every triangle, as a stream.
    Cover,
    /// The fragments of transparent triangles in lists, whatever lies in front.
    Build,
}

/// Both stages, ready to run.
pub struct Stages<'r, 'g> {
    rasterizer: &'r Rasterizer<'g>,
    buffers: Buffers,
    stream: wgpu::Buffer,
    /// What runs, in this order; `None` empties lists and counter.
    spans: Vec<(Option<Stage>, Vec<Ready>)>,
}

impl<'r, 'g> Stages<'r, 'g> {
    /// Sets both up, with room for the fragments of each row, of which there are `rows`.
    ///
    /// # Errors
    /// A single row that is too much, by name; WGSL errors; what the device refuses.
    pub fn new(
        rasterizer: &'r Rasterizer<'g>,
        rows: &[u32],
        is_opaque: impl Fn(u32) -> bool,
    ) -> Result<Self, GpuError> {
        let (gpu, size) = (rasterizer.gpu, rasterizer.size);
        let lists = buffers::need(gpu);
        let need = Need {
            node: lists.node + STREAMED,
            ..lists
        };
        let attempts = Attempts::new(gpu, size, need, None);
        let bands: Vec<(Band, u32)> = attempts.with_rows(rows.iter().copied()).collect();
        let most = |of: fn(&(Band, u32)) -> u32| bands.iter().map(of).max().unwrap_or(0);
        let pixels = most(|(band, _)| band.rows) * size.width;
        let capacity = most(|(_, fragments)| *fragments);
        let mut stages = Self {
            rasterizer,
            buffers: Buffers::empty(gpu, pixels, capacity, None)?,
            stream: gpu.storage("stream", STREAMED * u64::from(capacity))?,
            spans: Vec::new(),
        };
        for (band, _) in bands {
            let frame = Frame {
                capacity,
                depth_test: 0,
                ..rasterizer.frame(band)
            };
            stages.add(band, frame, &is_opaque)?;
        }
        Ok(stages)
    }

    /// Adds the spans of a band.
    fn add(
        &mut self,
        band: Band,
        frame: Frame,
        is_opaque: impl Fn(u32) -> bool,
    ) -> Result<(), GpuError> {
        let rasterizer = self.rasterizer;
        let named = self.buffers.named();
        let streamed = [("counter", &self.buffers.counter), ("stream", &self.stream)];
        let all = rasterizer.work(band, |_| true)?;
        let transparent = rasterizer.work(band, |prim| !is_opaque(prim))?;
        let cover = rasterizer.ready("raster", "cover", frame, &all, &streamed)?;
        let build = rasterizer.ready("abuffer", "build", frame, &transparent, &named)?;
        let mut spans = Vec::new();
        for (stage, passes) in [(Stage::Cover, cover), (Stage::Build, build)] {
            // What has no passes has no times.
            if !passes.is_empty() {
                let clear = rasterizer.ready_per_pixel("nearest", "clear_lists", frame, &named)?;
                spans.extend([(None, vec![clear]), (Some(stage), passes)]);
            }
        }
        self.spans.extend(spans);
        Ok(())
    }

    /// How many spans a timer of these stages needs.
    pub fn spans(&self) -> u32 {
        u32::try_from(self.spans.len()).expect("four a band")
    }

    /// Runs each stage once and gives how many fragments it counted.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn count(&self) -> Result<[u64; 2], GpuError> {
        let gpu = self.rasterizer.gpu;
        let mut counted = [0; 2];
        for (stage, passes) in &self.spans {
            let mut encoder = gpu.encoder();
            for pass in passes {
                pass.record(self.rasterizer, &mut encoder, None);
            }
            gpu.submit(encoder)?;
            if let Some(stage) = stage {
                let band = gpu.read::<u32>(&self.buffers.counter, 1)?[0];
                counted[*stage as usize] += u64::from(band);
            }
        }
        Ok(counted)
    }

    /// Runs each stage once and gives its seconds; emptying the lists is not among them.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn time(&self, timer: &Timer) -> Result<[f64; 2], GpuError> {
        let gpu = self.rasterizer.gpu;
        let all = timer.time(gpu, 0..self.spans(), |span, encoder, queries| {
            let passes = &self.spans[span as usize].1;
            for (at, pass) in passes.iter().enumerate() {
                let writes = queries.and_then(|q| q.writes(span, at, passes.len()));
                pass.record(self.rasterizer, encoder, writes);
            }
        })?;
        let mut seconds = [0.0; 2];
        for ((stage, _), taken) in self.spans.iter().zip(all) {
            if let Some(stage) = stage {
                seconds[*stage as usize] += taken;
            }
        }
        Ok(seconds)
    }
}
