//! What a timed frame records, part by part.

use triptych_spec::abuffer::NOTHING;
use triptych_spec::grid::trace::Query;
use triptych_spec::scene::Size;
use triptych_spec::vertex::Primitives;

use super::Parameters;
use super::device::Device;
use super::records::{Light, Place, Surface};
use super::timed::{Span, Step, Timed};
use crate::error::GpuError;
use crate::frame::{Band, Frame};
use crate::grid::{Hit, Room, Shape, TRACED};

impl Timed<'_> {
    pub(super) fn named(&self) -> Vec<(&str, &wgpu::Buffer)> {
        self.buffers.iter().map(|(name, b)| (*name, b)).collect()
    }

    pub(super) fn buffer(&self, name: &str) -> &wgpu::Buffer {
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
        Ok(Step::Pass(
            self.device.faces.ready(entry, told, view, &named)?,
        ))
    }

    /// What the eye sees, or the lamp.
    pub(super) fn see(
        &mut self,
        which: usize,
        span: Span,
        drawn: &Primitives,
    ) -> Result<(), GpuError> {
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
    pub(super) fn light(&mut self) -> Result<(), GpuError> {
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
    pub(super) fn block(&mut self, room: &Room<'_>, shape: Shape) -> Result<(), GpuError> {
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
        for _ in 0..room.rounds(shape) {
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

    pub(super) fn all_traced(&self) -> Result<bool, GpuError> {
        let hits: Vec<Hit> = self.gpu.read(self.buffer("hits"), self.rays as usize)?;
        Ok(hits.iter().all(|hit| hit.state == TRACED))
    }

    /// Stages blur and compose; without blockers there is nothing to be averaged.
    pub(super) fn compose(&mut self, blocked: bool) -> Result<(), GpuError> {
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
}

/// Room for all that stages hand on.
pub(super) fn room(device: &Device<'_>) -> Result<Vec<(&'static str, wgpu::Buffer)>, GpuError> {
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
