//! All stages, each from the device's own results.
//!
//! The device's points, places and intensities may differ from the spec's within bounds, and
//! what is decided on them may differ too. So the picture is held against that of the spec from
//! the device's own surfaces, places and lights, whose bounds run on from stage to stage: no
//! pixel goes unjudged.

use triptych_gpu::error::GpuError;
use triptych_gpu::rsm::{Colours, Stages};
use triptych_spec::rsm::{
    Blocked, Coarse, Colour, DARK, Gbuffer, Light, Place, Setting, Surface, block, blur, compose,
    direct, gather,
};

use super::tally::Tally;
use super::{RsmFrame, RsmLeg, of_coarse, pixels, triangles, word};
use crate::compare::Judgement;
use crate::compare::rsm as judge;
use crate::replay::rows::Rows;
use crate::row::Class;

/// Why a device's own results are not followed.
const DAMAGED: &str =
    "the device's own surfaces, lights or places are wrong: see the stages before";

/// What a device made before it came to light: points, texels as lights, places.
struct Given {
    seen: Vec<Option<Surface>>,
    lights: Vec<Option<Light>>,
    places: Vec<Option<Place>>,
}

/// What it made of that.
struct Made {
    lit: Vec<bool>,
    bits: Vec<u32>,
    rays: u64,
    picture: Colours,
}

impl RsmLeg<'_> {
    /// Adds rows for all stages from the device's own results: which pixels are lit, which
    /// texels are blocked, and the picture. Gives its pictures.
    pub(super) fn end_to_end(&self, rows: &mut Rows) -> Result<Vec<Colours>, GpuError> {
        let (stage, label) = ("end to end", self.label());
        let mut tally = Tally::default();
        let mut pictures = Vec::new();
        for frame in &self.spec.value.frames {
            let mut stages = self.stages(frame)?;
            let Some(given) = self.given(frame, &mut stages)? else {
                let reason = DAMAGED.to_owned();
                rows.skip(stage, &self.spec.label, &label, Class::Interval, reason);
                return Ok(Vec::new());
            };
            let made = self.made_of(frame, &mut stages, &given)?;
            let (lit, blocked, picture) = self.expected(frame, &given);
            let judged = self.beside(lit, &made.lit, |a, b| judge::lit(a, b));
            tally.part(stage, judged);
            let setting = self.spec.value.setting(frame);
            let place = |pixel| word(of_coarse(&setting, &frame.frame, pixel));
            let judged = self.beside(blocked, &made, |a, made| {
                judge::blocked(a, (&made.bits, made.rays), place)
            });
            tally.part(stage, judged);
            let judged = self.beside(picture, &made.picture, |a, b| Judgement {
                note: "from the device's own surfaces, lights and places".to_owned(),
                ..pixels(a, b)
            });
            tally.part(stage, judged);
            pictures.push(made.picture);
        }
        tally.rows(&self.spec.label, &label, rows);
        Ok(pictures)
    }

    /// What the device sees by itself; `None` if that is not what it may see.
    fn given(&self, of: &RsmFrame, stages: &mut Stages<'_>) -> Result<Option<Given>, GpuError> {
        let frame = &of.frame;
        let seen = stages.gbuffer(&triangles(&frame.seen))?;
        if judge::surfaces(&frame.seen, &seen).differ() > 0 {
            return Ok(None);
        }
        if !self.runs("rsm") {
            return Ok(Some(Given {
                lights: frame.rsm.lights(),
                places: vec![None; seen.len()],
                seen,
            }));
        }
        let (texels, intensities) = stages.rsm(&triangles(&frame.rsm.seen))?;
        let near = judge::surfaces(&frame.rsm.seen, &texels);
        let bright = judge::colours("intensities", &frame.rsm.intensity, &intensities, |_| None);
        let finite = intensities
            .iter()
            .flatten()
            .all(|c| c.is_finite() && *c >= 0.0);
        let places = stages.place(&seen)?;
        let light = &self.spec.value.setup.lamp.view;
        let own = Gbuffer {
            surfaces: seen,
            ..frame.seen.clone()
        };
        let expected = triptych_spec::rsm::place(light, &own);
        let placed = judge::places(light, &own.surfaces, &expected, &places);
        let wrong = [near, bright, placed]
            .iter()
            .any(|judged| judged.differ() > 0);
        if wrong || !finite {
            return Ok(None);
        }
        let light = |(surface, intensity): (Option<Surface>, [f32; 3])| {
            surface.map(|surface| Light { surface, intensity })
        };
        Ok(Some(Given {
            seen: own.surfaces,
            lights: texels.into_iter().zip(intensities).map(light).collect(),
            places,
        }))
    }

    fn made_of(
        &self,
        of: &RsmFrame,
        stages: &mut Stages<'_>,
        given: &Given,
    ) -> Result<Made, GpuError> {
        let frame = &of.frame;
        let Given {
            seen,
            lights,
            places,
        } = given;
        let dark = |pixels: usize| vec![[0.0; 3]; pixels];
        let (lit, direct) = match self.runs("direct") {
            true => stages.direct(seen, places, &frame.rsm.seen.keys)?,
            false => (vec![false; seen.len()], dark(seen.len())),
        };
        let all = match self.runs("gather") {
            true => stages.gather(seen, places, lights)?,
            false => dark(seen.len()),
        };
        let (bits, rays, light) = match self.runs("block") {
            true => {
                let found = stages.block(seen, places, lights)?;
                (found.bits, found.rays, found.light)
            }
            false => {
                let Blocked { bits, light, .. } = &frame.blocked;
                (bits.clone(), 0, dark(light.len()))
            }
        };
        let blurred = match self.runs("blur") {
            true => stages.blur(seen, &light)?,
            false => light,
        };
        Ok(Made {
            picture: stages.compose(seen, [&direct, &all], &blurred)?,
            lit,
            bits,
            rays,
        })
    }

    /// The spec from the same surfaces, lights and places.
    fn expected(&self, of: &RsmFrame, given: &Given) -> (Vec<bool>, Blocked, Vec<Colour>) {
        let setting = self.spec.value.setting(of);
        let Setting {
            model,
            lamp,
            parameters,
            background,
            ..
        } = &setting;
        let seen = Gbuffer {
            surfaces: given.seen.clone(),
            ..of.frame.seen.clone()
        };
        let Given { lights, places, .. } = given;
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
