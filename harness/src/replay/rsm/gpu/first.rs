//! What a device starts a frame from: what eye and lamp see, and the blockers' cells.

use triptych_gpu::error::GpuError;
use triptych_gpu::rsm::Stages;
use triptych_spec::rsm::{Gbuffer, Light, Surface, View};

use super::own::STAGE;
use super::{RsmFrame, RsmLeg};
use crate::compare::grid::{self as lists, Runs};
use crate::compare::rsm as judge;
use crate::dump::FrameArrays;
use crate::replay::judged::Judged;
use crate::replay::visible::{Visible, visible};

impl RsmLeg<'_> {
    /// The blockers' cells; `false` if no search may follow them.
    pub(super) fn cells(
        &self,
        of: &RsmFrame,
        stages: &mut Stages<'_>,
        tally: &mut Judged,
    ) -> Result<bool, GpuError> {
        if !self.runs("block") {
            return Ok(true);
        }
        let grid = &of.parts.grid;
        let [offsets, prims] = stages.cells(|offsets| *offsets == grid.offsets)?;
        let judged = self.beside(&grid.offsets, &offsets, |a, b| lists::offsets(a, b));
        let sound = judged.differ() == 0;
        tally.part(STAGE, judged);
        if !sound {
            return Ok(false);
        }
        let runs = Runs {
            offsets: &grid.offsets,
            prims: &grid.prims,
        };
        let judged = self.beside(runs, &prims, |a, b| lists::entries(*a, b));
        let sound = judged.differ() == 0;
        tally.part(STAGE, judged);
        Ok(sound)
    }

    /// What the device sees by itself, and the lamp's keys; `None` if that is not what it may
    /// see, and then nothing is made of it.
    pub(super) fn first(
        &self,
        of: &RsmFrame,
        stages: &mut Stages<'_>,
        own: &mut FrameArrays,
        tally: &mut Judged,
    ) -> Result<Option<Vec<u32>>, GpuError> {
        let frame = &of.frame;
        let setting = self.spec.value.setting(of);
        let Some(eye) = self.visible(of, (setting.eye, &frame.seen, "pixels"), tally)? else {
            return Ok(None);
        };
        own.seen = stages.gbuffer(&eye.triangles)?;
        let judged = self.beside(&frame.seen, &own.seen, |a, b| judge::surfaces(a, b));
        if !tally.may_follow(STAGE, judged) {
            return Ok(None);
        }
        if !self.runs("rsm") {
            own.lights = frame.rsm.lights();
            own.places = vec![None; own.seen.len()];
            return Ok(Some(frame.rsm.seen.keys.clone()));
        }
        let view = &setting.lamp.view;
        let Some(lamp) = self.visible(of, (view, &frame.rsm.seen, "texels"), tally)? else {
            return Ok(None);
        };
        let (texels, intensities) = stages.rsm(&lamp.triangles)?;
        own.places = stages.place(&own.seen)?;
        let light = |(surface, intensity): (&Option<Surface>, &[f32; 3])| {
            surface.map(|surface| Light {
                surface,
                intensity: *intensity,
            })
        };
        own.lights = texels.iter().zip(&intensities).map(light).collect();
        let near = self.beside(&frame.rsm.seen, texels, |a, b| judge::surfaces(a, b));
        let bright = self.beside(&frame.rsm.intensity, intensities, |a, b| {
            judge::colours("intensities", a, b, |_| None)
        });
        let seen = Gbuffer {
            surfaces: own.seen.clone(),
            ..frame.seen.clone()
        };
        let expected = triptych_spec::rsm::place(view, &seen);
        let placed = self.beside(expected, &own.places, |a, b| {
            judge::places(view, &own.seen, a, b)
        });
        // Each has its say.
        let sound = [near, bright, placed].map(|judged| tally.may_follow(STAGE, judged));
        Ok((sound == [true; 3]).then_some(lamp.keys))
    }

    /// Which triangle each pixel of a view sees, by the device's own drawing of snapped
    /// triangles; `None` if it is another.
    fn visible(
        &self,
        of: &RsmFrame,
        (view, spec, unit): (&View, &Gbuffer, &'static str),
        tally: &mut Judged,
    ) -> Result<Option<Visible>, GpuError> {
        let seen = visible((self.adapter, self.path), view, &of.parts.model)?;
        let judged = self.beside(spec, &seen, |spec, seen| {
            judge::visible(unit, spec, &seen.keys, &seen.triangles)
        });
        let sound = judged.differ() == 0;
        tally.part(STAGE, judged);
        Ok(sound.then_some(seen))
    }
}
