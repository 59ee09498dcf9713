//! All stages, each from the device's own results.
//!
//! It starts from snapped triangles and from the blockers' corners. Which triangles eye and lamp
//! see, and the blockers' cells, are exact. The device's points, places and intensities may
//! differ from the spec's within bounds, and what is decided on them may differ too. So the
//! picture is held against that of the spec from the device's own surfaces, places and lights,
//! whose bounds run on from stage to stage: no pixel goes unjudged.

use triptych_gpu::error::GpuError;
use triptych_gpu::rsm::Stages;
use triptych_spec::rsm::{
    Blocked, Coarse, Colour, DARK, Gbuffer, Setting, block, blur, compose, direct, gather,
};

use super::{RsmFrame, RsmLeg, of_coarse, pixels, word};
use crate::compare::rsm as judge;
use crate::dump::FrameArrays;
use crate::replay::judged::Judged;
use crate::replay::rows::Rows;
use crate::row::Class;

/// What the rows are about.
pub(super) const STAGE: &str = "end to end";

/// Why intensities are not followed.
const BEYOND: &str = "an intensity of the device is no finite number: nothing bounds what follows";

/// How far a frame came.
enum End {
    /// To its picture.
    Picture,
    /// To something wrong, which its row tells.
    Wrong,
    /// To a light as bright as `f32` cannot say.
    Beyond,
}

impl RsmLeg<'_> {
    /// Adds rows for all stages from the device's own results: what eye and lamp see, the
    /// blockers' cells, which pixels are lit, which texels are blocked, and the picture. Gives
    /// all of them, frame by frame, as far as they came.
    pub(super) fn end_to_end(&self, rows: &mut Rows) -> Result<Vec<FrameArrays>, GpuError> {
        let label = self.label();
        let mut tally = Judged::default();
        let mut frames = Vec::new();
        let mut end = End::Picture;
        for frame in &self.spec.value.frames {
            let mut own = FrameArrays::default();
            end = self.whole(frame, &mut own, &mut tally)?;
            frames.push(own);
            if !matches!(end, End::Picture) {
                break;
            }
        }
        tally.rows(&self.spec.label, &label, rows);
        if matches!(end, End::Beyond) {
            let reason = BEYOND.to_owned();
            rows.skip(STAGE, &self.spec.label, &label, Class::Interval, reason);
        }
        Ok(frames)
    }

    fn whole(
        &self,
        frame: &RsmFrame,
        own: &mut FrameArrays,
        tally: &mut Judged,
    ) -> Result<End, GpuError> {
        let mut stages = self.stages(frame)?;
        if !self.cells(frame, &mut stages, tally)? {
            return Ok(End::Wrong);
        }
        let Some(keys) = self.first(frame, &mut stages, own, tally)? else {
            return Ok(End::Wrong);
        };
        let lights = own.lights.iter().flatten();
        let finite = |c: &f32| c.is_finite() && *c >= 0.0;
        if !lights.flat_map(|light| &light.intensity).all(finite) {
            return Ok(End::Beyond);
        }
        let rays = self.rest(&mut stages, own, &keys, frame)?;
        let (lit, blocked, picture) = self.expected(frame, own, &keys);
        let judged = self.beside(lit, &own.lit, |a, b| judge::lit(a, b));
        tally.part(STAGE, judged);
        let setting = self.spec.value.setting(frame);
        let place = |pixel| word(of_coarse(&setting, &frame.frame, pixel));
        let judged = self.beside(blocked, (&own.bits, rays), |a, (bits, rays)| {
            judge::blocked(a, (bits, *rays), place)
        });
        tally.part(STAGE, judged);
        let judged = self.beside(picture, &own.picture, |a, b| pixels(a, b));
        tally.part(STAGE, judged);
        Ok(End::Picture)
    }

    /// What it makes of that; gives how many rays it asked for.
    fn rest(
        &self,
        stages: &mut Stages<'_>,
        own: &mut FrameArrays,
        keys: &[u32],
        of: &RsmFrame,
    ) -> Result<u64, GpuError> {
        let frame = &of.frame;
        let (seen, places, lights) = (&own.seen, &own.places, &own.lights);
        let dark = |pixels: usize| vec![[0.0; 3]; pixels];
        (own.lit, own.direct) = match self.runs("direct") {
            true => stages.direct(seen, places, keys)?,
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
    fn expected(
        &self,
        of: &RsmFrame,
        own: &FrameArrays,
        keys: &[u32],
    ) -> (Vec<bool>, Blocked, Vec<Colour>) {
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
        let size = lamp.view.size;
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
