//! A frame that is set up once and run many times, each part timed.
//!
//! It starts from snapped triangles and from the blockers' corners, and ends with the picture;
//! nothing goes to the host in between. Kernels run unchecked, as an engine has them, so only
//! ours may, and only where a checked run has been.

use triptych_spec::abuffer::NOTHING;
use triptych_spec::grid::trace::Query;
use triptych_spec::rsm::Setting;
use triptych_spec::scene::Size;
use triptych_spec::vertex::Primitives;

use super::device::Device;
use super::records::{Light, Place, Surface};
use super::{Made, Parameters};
use crate::context::Gpu;
use crate::dispatch::Ready;
use crate::error::GpuError;
use crate::frame::{Band, Frame};
use crate::grid::{self, Hit, Room, Shape, TRACED};
use crate::kernel::Kernels;
use crate::raster::{self, Path, Rasterizer};
use crate::timer::Timer;

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
enum Step {
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
    gpu: &'g Gpu,
    device: Device<'g>,
    rasterizers: [Rasterizer<'g>; 2],
    buffers: Vec<(&'static str, wgpu::Buffer)>,
    spans: Vec<(Span, Vec<Step>)>,
    /// Rays of a frame.
    pub rays: u32,
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

    fn named(&self) -> Vec<(&str, &wgpu::Buffer)> {
        self.buffers.iter().map(|(name, b)| (*name, b)).collect()
    }

    fn buffer(&self, name: &str) -> &wgpu::Buffer {
        let found = self.buffers.iter().find(|(own, _)| *own == name);
        &found.expect("made by `room`").1
    }

    fn pass(
        &self,
        entry: &str,
        told: Parameters,
        view: &wgpu::Buffer,
        more: &[(&str, &wgpu::Buffer)],
    ) -> Result<Step, GpuError> {
        let named = [more, &self.named()].concat();
        Ok(Step::Pass(self.device.ready(entry, told, view, &named)?))
    }

    /// What the eye sees, or the lamp.
    fn see(&mut self, which: usize, span: Span, drawn: &Primitives) -> Result<(), GpuError> {
        let size = drawn.size;
        let pixels = size.width * size.height;
        let rasterizer = &self.rasterizers[which];
        let band = Band::whole(size);
        let frame: Frame = rasterizer.frame(band);
        let nothing = self.gpu.filled("nothing", pixels, NOTHING)?;
        let key = match span {
            Span::Eye => self.gpu.filled("keys", pixels, NOTHING)?,
            _ => self.buffer("keys").clone(),
        };
        let prim = self.gpu.filled("nearest", pixels, NOTHING)?;
        let mut steps = vec![
            Step::Copy(nothing.clone(), key.clone()),
            Step::Copy(nothing, prim.clone()),
        ];
        let named = [("opaque_key", &key), ("opaque_prim", &prim)];
        let work = rasterizer.work(band, |_| true)?;
        for stage in ["opaque_nearest", "opaque_first"] {
            let passes = rasterizer.ready("abuffer", stage, frame, &work, &named)?;
            steps.extend(passes.into_iter().map(|pass| Step::Raster(which, pass)));
        }
        let sources = self.gpu.upload("sources", &drawn.source)?;
        let given = [("nearest", &prim), ("sources", &sources)];
        let (entry, view) = match span {
            Span::Eye => ("gbuffer", &self.device.eye),
            _ => ("rsm", &self.device.lamp),
        };
        steps.push(self.pass(entry, self.device.of(size), view, &given)?);
        self.spans.push((span, steps));
        Ok(())
    }

    /// Stages place, direct and gather.
    fn light(&mut self) -> Result<(), GpuError> {
        let size = self.device.eye_size();
        let told = self.device.of(size);
        let direct = vec![
            self.pass("place", told, &self.device.lamp, &[])?,
            self.pass("direct", told, &self.device.lamp, &[])?,
        ];
        let gather = self.rows("gather", size)?;
        self.spans.push((Span::Direct, direct));
        self.spans.push((Span::Gather, gather));
        Ok(())
    }

    fn rows(&self, entry: &str, size: Size) -> Result<Vec<Step>, GpuError> {
        let told = self.device.by_rows(size);
        told.map(|told| self.pass(entry, told, &self.device.eye, &[]))
            .collect()
    }

    /// Stage block, after which every ray is done.
    fn block(&mut self, room: &Room<'_>, shape: Shape) -> Result<(), GpuError> {
        let eye = self.device.eye.clone();
        let told = Parameters {
            items: pairs(&self.device)?,
            ..self.device.told
        };
        let mut steps = vec![
            Step::Clear(self.buffer("bits").clone()),
            Step::Clear(self.buffer("asked").clone()),
            self.pass("block_rays", told, &eye, &[])?,
        ];
        for (_, steps) in &self.spans {
            self.run(steps)?;
        }
        self.run(&steps)?;
        let asked: Vec<u32> = self.gpu.read(self.buffer("asked"), 1)?;
        self.rays = asked[0];
        let searched = [self.buffer("rays"), self.buffer("hits")];
        for _ in 0..=shape.entries / grid::STEPS + 1 {
            let search = room.search(searched, self.rays, Query::Any, 1)?;
            let search: Vec<Step> = search.into_iter().map(Step::Pass).collect();
            self.run(&search)?;
            steps.extend(search);
            if self.all_traced()? {
                break;
            }
        }
        let found = Parameters {
            items: self.rays,
            ..told
        };
        steps.push(self.pass("block_bits", found, &eye, &[])?);
        steps.extend(self.rows("block_sum", self.device.coarse_size())?);
        self.spans.push((Span::Block, steps));
        Ok(())
    }

    fn all_traced(&self) -> Result<bool, GpuError> {
        let hits: Vec<Hit> = self.gpu.read(self.buffer("hits"), self.rays as usize)?;
        Ok(hits.iter().all(|hit| hit.state == TRACED))
    }

    /// Stages blur and compose; without blockers there is nothing to be averaged.
    fn compose(&mut self, blocked: bool) -> Result<(), GpuError> {
        let mut steps = Vec::new();
        if blocked {
            let told = self.device.of(self.device.coarse_size());
            steps.push(self.pass("blur", told, &self.device.eye, &[])?);
        }
        let told = self.device.of(self.device.eye_size());
        steps.push(self.pass("compose", told, &self.device.eye, &[])?);
        self.spans.push((Span::Compose, steps));
        Ok(())
    }

    fn run(&self, steps: &[Step]) -> Result<(), GpuError> {
        let mut encoder = self.gpu.encoder();
        for step in steps {
            self.record(step, &mut encoder, None);
        }
        self.gpu.submit(encoder)
    }

    fn record(
        &self,
        step: &Step,
        encoder: &mut wgpu::CommandEncoder,
        writes: Option<crate::timer::Writes<'_>>,
    ) {
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
        queries: Option<&crate::timer::Queries>,
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

/// Room for all that stages hand on.
fn room(device: &Device<'_>) -> Result<Vec<(&'static str, wgpu::Buffer)>, GpuError> {
    let (eye, map) = (device.eye_size(), device.map_size());
    let coarse = device.coarse_size();
    let words = u32::try_from(coarse.pixels() * device.given.words()).expect("at most 2^25");
    let pairs = u64::from(pairs(device)?);
    let colours = |what, size| device.room::<[f32; 4]>(what, size);
    Ok(vec![
        ("seen", device.room::<Surface>("surfaces", eye)?),
        ("places", device.room::<Place>("places", eye)?),
        ("keys", device.room::<u32>("keys", map)?),
        ("weights", device.weights.clone()),
        ("lights", device.room::<Light>("lights", map)?),
        ("intensities", colours("intensities", map)?),
        ("lit", colours("direct light", eye)?),
        ("all_light", colours("buffer A", eye)?),
        // The first frame would show it if they were not cleared.
        ("bits", device.gpu.filled("bits", words, u32::MAX)?),
        ("blocked", colours("buffer B", coarse)?),
        ("blurred", colours("buffer B, averaged", coarse)?),
        ("picture", colours("picture", eye)?),
        ("asked", device.gpu.storage("number of rays", 4)?),
        ("rays", device.gpu.storage("rays", 32 * pairs)?),
        ("hits", device.gpu.storage("hits", 16 * pairs)?),
    ])
}

/// Pairs of a pixel of buffer B and a texel; all may have a ray.
fn pairs(device: &Device<'_>) -> Result<u32, GpuError> {
    let kernel = u64::from(device.given.side()).pow(2);
    let pairs = device.coarse_size().pixels() as u64 * kernel;
    u32::try_from(pairs).map_err(|_| GpuError::Limit {
        adapter: device.gpu.name.clone(),
        what: "rays",
        needed: pairs,
        limit: u32::MAX.into(),
    })
}
