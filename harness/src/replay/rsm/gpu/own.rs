//! All stages, each from the device's own results.
//!
//! The device's points, places and intensities may differ from the spec's within bounds, and
//! what is decided on them may differ too. So the picture is held against that of the spec from
//! the device's own surfaces, places and lights, whose bounds run on from stage to stage: no
//! pixel goes unjudged.

use triptych_gpu::error::GpuError;
use triptych_gpu::rsm::Stages;
use triptych_spec::rsm::{
    Blocked, Coarse, Colour, DARK, Gbuffer, Light, Setting, Surface, block, blur, compose, direct,
    gather,
};

use super::tally::Tally;
use super::{RsmFrame, RsmLeg, of_coarse, pixels, triangles, word};
use crate::compare::Judgement;
use crate::compare::rsm as judge;
use crate::dump::FrameArrays;
use crate::replay::rows::Rows;
use crate::row::Class;

/// Why a device's own results are not followed.
const DAMAGED: &str =
    "the device's own surfaces, lights or places are wrong: see the stages before";

impl RsmLeg<'_> {
    /// Adds rows for all stages from the device's own results: which pixels are lit, which
    /// texels are blocked, and the picture. Gives all of them, frame by frame, as far as they
    /// came.
    pub(super) fn end_to_end(&self, rows: &mut Rows) -> Result<Vec<FrameArrays>, GpuError> {
        let (stage, label) = ("end to end", self.label());
        let mut tally = Tally::default();
        let mut frames = Vec::new();
        for frame in &self.spec.value.frames {
            let mut stages = self.stages(frame)?;
            let mut own = FrameArrays::default();
            let sound = self.first(frame, &mut stages, &mut own)?;
            if !sound {
                let reason = DAMAGED.to_owned();
                rows.skip(stage, &self.spec.label, &label, Class::Interval, reason);
                frames.push(own);
                return Ok(frames);
            }
            let rays = self.rest(frame, &mut stages, &mut own)?;
            let (lit, blocked, picture) = self.expected(frame, &own);
            let judged = self.beside(lit, &own.lit, |a, b| judge::lit(a, b));
            tally.part(stage, judged);
            let setting = self.spec.value.setting(frame);
            let place = |pixel| word(of_coarse(&setting, &frame.frame, pixel));
            let judged = self.beside(blocked, (&own.bits, rays), |a, (bits, rays)| {
                judge::blocked(a, (bits, *rays), place)
            });
            tally.part(stage, judged);
            let judged = self.beside(picture, &own.picture, |a, b| Judgement {
                note: "from the device's own surfaces, lights and places".to_owned(),
                ..pixels(a, b)
            });
            tally.part(stage, judged);
            frames.push(own);
        }
        tally.rows(&self.spec.label, &label, rows);
        Ok(frames)
    }

    /// What the device sees by itself; `false` if that is not what it may see, and then
    /// nothing is made of it.
    fn first(
        &self,
        of: &RsmFrame,
        stages: &mut Stages<'_>,
        own: &mut FrameArrays,
    ) -> Result<bool, GpuError> {
        let frame = &of.frame;
        own.seen = stages.gbuffer(&triangles(&frame.seen))?;
        if judge::surfaces(&frame.seen, &own.seen).differ() > 0 {
            return Ok(false);
        }
        if !self.runs("rsm") {
            own.lights = frame.rsm.lights();
            own.places = vec![None; own.seen.len()];
            return Ok(true);
        }
        let (texels, intensities) = stages.rsm(&triangles(&frame.rsm.seen))?;
        let near = judge::surfaces(&frame.rsm.seen, &texels);
        let bright = judge::colours("intensities", &frame.rsm.intensity, &intensities, |_| None);
        let finite = intensities
            .iter()
            .flatten()
            .all(|c| c.is_finite() && *c >= 0.0);
        own.places = stages.place(&own.seen)?;
        let light = &self.spec.value.setup.lamp.view;
        let seen = Gbuffer {
            surfaces: own.seen.clone(),
            ..frame.seen.clone()
        };
        let expected = triptych_spec::rsm::place(light, &seen);
        let placed = judge::places(light, &own.seen, &expected, &own.places);
        let wrong = [near, bright, placed]
            .iter()
            .any(|judged| judged.differ() > 0);
        let light = |(surface, intensity): (Option<Surface>, [f32; 3])| {
            surface.map(|surface| Light { surface, intensity })
        };
        own.lights = texels.into_iter().zip(intensities).map(light).collect();
        Ok(!wrong && finite)
    }

    /// What it makes of that; gives how many rays it asked for.
    fn rest(
        &self,
        of: &RsmFrame,
        stages: &mut Stages<'_>,
        own: &mut FrameArrays,
    ) -> Result<u64, GpuError> {
        let frame = &of.frame;
        let (seen, places, lights) = (&own.seen, &own.places, &own.lights);
        let dark = |pixels: usize| vec![[0.0; 3]; pixels];
        (own.lit, own.direct) = match self.runs("direct") {
            true => stages.direct(seen, places, &frame.rsm.seen.keys)?,
            false => (vec![false; seen.len()], dark(seen.len())),
        };
        own.all = match self.runs("gather") {
            true => stages.gather(seen, places, lights)?,
            false => dark(seen.len()),
        };
        let rays;
        (own.bits, rays, own.blocked) = match self.runs("block") {
            true => {
                let found = stages.block(seen, places, lights)?;
                (found.bits, found.rays, found.light)
            }
            false => {
                let Blocked { bits, light, .. } = &frame.blocked;
                (bits.clone(), 0, dark(light.len()))
            }
        };
        own.blurred = match self.runs("blur") {
            true => stages.blur(seen, &own.blocked)?,
            false => own.blocked.clone(),
        };
        own.picture = stages.compose(seen, [&own.direct, &own.all], &own.blurred)?;
        Ok(rays)
    }

    /// The spec from the same surfaces, lights and places.
    fn expected(&self, of: &RsmFrame, own: &FrameArrays) -> (Vec<bool>, Blocked, Vec<Colour>) {
        let setting = self.spec.value.setting(of);
        let Setting {
            model,
            lamp,
            parameters,
            background,
            ..
        } = &setting;
        let seen = Gbuffer {
            surfaces: own.seen.clone(),
            ..of.frame.seen.clone()
        };
        let FrameArrays { lights, places, .. } = own;
        let (keys, size) = (&of.frame.rsm.seen.keys, lamp.view.size);
        let direct = direct(model, &seen, places, lamp, keys, parameters);
        let all = gather(model, &seen, places, lights, size, parameters);
        let coarse = Coarse::new(&seen, parameters);
        let cells = (setting.grid, setting.blockers);
        let blocked = match self.runs("block") {
            true => block(model, &seen, places, lights, size, cells, parameters),
            false => Blocked {
                light: vec![DARK; coarse.size.pixels()],
                ..of.frame.blocked.clone()
            },
        };
        let blurred = blur(model, &coarse, &blocked.light, parameters);
        let light = [&direct.light[..], &all];
        let coarse = (&coarse, &blurred[..]);
        let picture = compose(model, &seen, light, coarse, parameters, *background);
        (direct.lit, blocked, picture)
    }
}
