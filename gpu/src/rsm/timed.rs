//! A frame that is set up once and run many times, each part timed.
//!
//! It starts from snapped triangles and from the blockers' corners, and ends with the picture;
//! nothing goes to the host in between. Kernels run unchecked, as an engine has them, so only
//! ours may, and only where a checked run has been.

use triptych_spec::rsm::Setting;
use triptych_spec::vertex::Primitives;

use super::Made;
use super::device::Device;
use super::records::{Light, Place, Surface};
use super::setup::room;
use crate::context::Gpu;
use crate::error::GpuError;
use crate::grid::{Room, Shape};
use crate::kernel::Kernels;
use crate::raster::{self, Path, Rasterizer};
use crate::ready::Ready;
use crate::timer::{Queries, Timer, Writes};

/// What is timed, in the order of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Span {
    /// What the eye sees: both passes of stage opaque, and stage gbuffer.
    Eye,
    /// The same of the light, with stage rsm.
    Map,
    /// The blockers' cells: stages count, scan and fill, and the bricks.
    Cells,
    /// Stages place and direct.
    Direct,
    /// Stage gather.
    Gather,
    /// Stage block, its rays' search among it.
    Block,
    /// Stages blur and compose.
    Compose,
}

/// What is recorded.
pub(super) enum Step {
    /// A pass of a rasterizer, the eye's or the lamp's.
    Raster(usize, raster::Ready),
    Pass(Ready),
    /// A buffer is set to zeros.
    Clear(wgpu::Buffer),
    /// A buffer becomes another one's copy.
    Copy(wgpu::Buffer, wgpu::Buffer),
}

impl Step {
    fn is_pass(&self) -> bool {
        matches!(self, Self::Raster(..) | Self::Pass(_))
    }
}

/// A frame that is set up.
pub struct Timed<'g> {
    pub(super) gpu: &'g Gpu,
    pub(super) device: Device<'g>,
    pub(super) rasterizers: [Rasterizer<'g>; 2],
    pub(super) buffers: Vec<(&'static str, wgpu::Buffer)>,
    pub(super) spans: Vec<(Span, Vec<Step>)>,
    /// Rays of a frame.
    pub rays: u32,
    /// Bytes of the buffers that its stages share, the blockers and their grid among them;
    /// without the triangles that are drawn.
    pub bytes: u64,
}

/// What a frame is made of, and how.
#[derive(Clone, Copy)]
pub struct Work<'a> {
    /// The scene.
    pub setting: Setting<'a>,
    /// Snapped triangles of the eye's view, and of the lamp's.
    pub drawn: [&'a Primitives; 2],
    /// Who decides coverage.
    pub path: Path,
    /// What the blockers' cells need; `None` without blockers.
    pub cells: Option<Shape>,
}

impl<'g> Timed<'g> {
    /// Sets everything up, and finds out how many rays there are, and when the last is done.
    ///
    /// # Errors
    /// Limits by name, and whatever the device reports.
    pub fn new(gpu: &'g Gpu, kernels: &'g Kernels, work: &Work<'_>) -> Result<Self, GpuError> {
        let device = Device::new(gpu, kernels, &work.setting)?;
        let draw = |of: &Primitives| {
            let colours = vec![[0.0; 4]; of.prims.len()];
            Rasterizer::new(gpu, kernels, work.path, of, &colours)
        };
        let rasterizers = [draw(work.drawn[0])?, draw(work.drawn[1])?];
        let buffers = room(&device)?;
        let mut timed = Self {
            gpu,
            device,
            rasterizers,
            bytes: buffers.iter().map(|(_, buffer)| buffer.size()).sum(),
            buffers,
            spans: Vec::new(),
            rays: 0,
        };
        timed.see(0, Span::Eye, work.drawn[0])?;
        timed.see(1, Span::Map, work.drawn[1])?;
        let cells = match work.cells {
            None => None,
            Some(shape) => {
                let (blockers, axes) = (work.setting.blockers, &work.setting.grid.axes);
                let room = Room::new(gpu, kernels, blockers, axes, shape)?;
                timed.bytes += room.bytes(true);
                let build = room.build(shape)?.into_iter().map(Step::Pass).collect();
                timed.spans.push((Span::Cells, build));
                Some((room, shape))
            }
        };
        timed.light()?;
        if let Some((room, shape)) = &cells {
            timed.block(room, *shape)?;
        }
        timed.compose(cells.is_some())?;
        Ok(timed)
    }

    pub(super) fn run(&self, steps: &[Step]) -> Result<(), GpuError> {
        let mut encoder = self.gpu.encoder();
        for step in steps {
            self.record(step, &mut encoder, None);
        }
        self.gpu.submit(encoder)
    }

    fn record(&self, step: &Step, encoder: &mut wgpu::CommandEncoder, writes: Option<Writes<'_>>) {
        match step {
            Step::Raster(which, pass) => pass.record(&self.rasterizers[*which], encoder, writes),
            Step::Pass(pass) => pass.record(encoder, writes),
            Step::Clear(buffer) => encoder.clear_buffer(buffer, 0, None),
            Step::Copy(from, to) => encoder.copy_buffer_to_buffer(from, 0, to, 0, None),
        }
    }

    /// The parts, in the order in which they run.
    pub fn spans(&self) -> impl Iterator<Item = Span> {
        self.spans.iter().map(|(span, _)| *span)
    }

    /// Runs a frame, and gives the seconds of each part; `timer` has a span for each.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn time(&self, timer: &Timer) -> Result<Vec<f64>, GpuError> {
        let count = u32::try_from(self.spans.len()).expect("few");
        timer.time(self.gpu, 0..count, |span, encoder, queries| {
            let steps = &self.spans[span as usize].1;
            self.record_all(&[steps], span, encoder, queries);
        })
    }

    /// Runs a frame, and gives the seconds from its first pass to the end of its last; `timer`
    /// has one span.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn time_whole(&self, timer: &Timer) -> Result<f64, GpuError> {
        let all: Vec<&Vec<Step>> = self.spans.iter().map(|(_, steps)| steps).collect();
        let seconds = timer.time(self.gpu, 0..1, |span, encoder, queries| {
            self.record_all(&all, span, encoder, queries);
        })?;
        Ok(seconds[0])
    }

    fn record_all(
        &self,
        parts: &[&Vec<Step>],
        span: u32,
        encoder: &mut wgpu::CommandEncoder,
        queries: Option<&Queries>,
    ) {
        let steps = || parts.iter().copied().flatten();
        let passes = steps().filter(|step| step.is_pass()).count();
        let mut at = 0;
        for step in steps() {
            let writes = queries
                .filter(|_| step.is_pass())
                .and_then(|q| q.writes(span, at, passes));
            self.record(step, encoder, writes);
            at += usize::from(step.is_pass());
        }
    }

    /// What the last frame made.
    ///
    /// # Errors
    /// Rays that were not all asked, or not done; whatever the device reports.
    pub fn made(&self) -> Result<Made, GpuError> {
        let (eye, map) = (self.device.eye_size(), self.device.map_size());
        let coarse = self.device.coarse_size();
        let asked: Vec<u32> = self.gpu.read(self.buffer("asked"), 1)?;
        if asked[0] != self.rays || !self.all_traced()? {
            return Err(GpuError::Endless {
                adapter: self.gpu.name.clone(),
                stage: "block",
            });
        }
        let surfaces: Vec<Surface> = self.gpu.read(self.buffer("seen"), eye.pixels())?;
        let lights: Vec<Light> = self.gpu.read(self.buffer("lights"), map.pixels())?;
        let places: Vec<Place> = self.gpu.read(self.buffer("places"), eye.pixels())?;
        let lit: Vec<[f32; 4]> = self.gpu.read(self.buffer("lit"), eye.pixels())?;
        let words = coarse.pixels() * self.device.given.words();
        let colours = |name: &str, size| self.device.colours(self.buffer(name), size);
        Ok(Made {
            seen: surfaces.into_iter().map(Surface::unpacked).collect(),
            lights: lights.into_iter().map(Light::unpacked).collect(),
            keys: self.gpu.read(self.buffer("keys"), map.pixels())?,
            intensities: colours("intensities", map)?,
            places: places.into_iter().map(Place::unpacked).collect(),
            lit: lit.iter().map(|c| c[3] != 0.0).collect(),
            direct: colours("lit", eye)?,
            all: colours("all_light", eye)?,
            bits: self.gpu.read(self.buffer("bits"), words)?,
            blocked: colours("blocked", coarse)?,
            blurred: colours("blurred", coarse)?,
            picture: colours("picture", eye)?,
        })
    }
}
