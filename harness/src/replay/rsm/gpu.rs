//! A GPU leg of a frame of indirect light: every stage from the spec's input, then all of the
//! device's own.

mod first;
mod own;

use triptych_gpu::error::GpuError;
use triptych_gpu::rsm::Stages;
use triptych_spec::abuffer::NOTHING;
use triptych_spec::bound::Bounded;
use triptych_spec::rsm::{Colour, Gbuffer, Setting, blur};

use super::kernel::of_coarse;
use super::spec::{RsmFrame, RsmRun, composed};
use crate::compare::rsm as judge;
use crate::dump::FrameArrays;
use crate::replay::judged::Judged;
use crate::replay::leg::Leg;
use crate::replay::rows::Rows;

/// One GPU leg of one scene.
pub type RsmLeg<'a> = Leg<'a, RsmRun>;

impl RsmLeg<'_> {
    /// Adds a row for each stage from the spec's input, and one for all of them end to end;
    /// gives what it made of the frames in the latter.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn run(&self, rows: &mut Rows) -> Result<Vec<FrameArrays>, GpuError> {
        self.each(rows)?;
        self.end_to_end(rows)
    }

    /// Adds a row for each stage from the spec's input.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn each(&self, rows: &mut Rows) -> Result<(), GpuError> {
        let mut tally = Judged::default();
        for frame in &self.spec.value.frames {
            let mut stages = self.stages(frame)?;
            self.seen(frame, &mut stages, &mut tally)?;
            self.lit(frame, &mut stages, &mut tally)?;
            self.made(frame, &mut stages, &mut tally)?;
        }
        tally.rows(&self.spec.label, &self.label(), rows);
        self.left_out(rows);
        Ok(())
    }

    fn stages<'s>(&'s self, frame: &RsmFrame) -> Result<Stages<'s>, GpuError> {
        let setting = self.spec.value.setting(frame);
        Stages::new(&self.adapter.gpu, self.adapter.kernels(self.path), &setting)
    }

    /// What eye and lamp see, and where.
    fn seen(
        &self,
        frame: &RsmFrame,
        stages: &mut Stages<'_>,
        tally: &mut Judged,
    ) -> Result<(), GpuError> {
        let RsmFrame { frame, times, .. } = frame;
        let seen = stages.gbuffer(&triangles(&frame.seen))?;
        let judged = self.beside(&frame.seen, seen, |a, b| judge::surfaces(a, b));
        tally.add("gbuffer", judged, times.gbuffer, stages.time);
        if self.runs("rsm") {
            let map = &frame.rsm;
            let (seen, intensity) = stages.rsm(&triangles(&map.seen))?;
            let judged = self.beside(&map.seen, seen, |a, b| judge::surfaces(a, b));
            tally.add("rsm", judged, times.rsm, stages.time);
            let judged = self.beside(&map.intensity, intensity, |a, b| {
                judge::colours("intensities", a, b, |_| None)
            });
            tally.part("rsm", judged);
        }
        if self.runs("place") {
            let places = stages.place(&frame.seen.surfaces)?;
            let light = &self.spec.value.setup.lamp.view;
            let judged = self.beside(&frame.places, places, |a, b| {
                judge::places(light, &frame.seen.surfaces, a, b)
            });
            tally.add("place", judged, times.place, stages.time);
        }
        Ok(())
    }

    /// Direct light, buffer A and buffer B.
    fn lit(
        &self,
        of: &RsmFrame,
        stages: &mut Stages<'_>,
        tally: &mut Judged,
    ) -> Result<(), GpuError> {
        let RsmFrame { frame, times, .. } = of;
        let (seen, places) = (&frame.seen.surfaces, &frame.places);
        let lights = frame.rsm.lights();
        if self.runs("direct") {
            let (lit, light) = stages.direct(seen, places, &frame.rsm.seen.keys)?;
            let judged = self.beside(&frame.direct.lit, lit, |a, b| judge::lit(a, b));
            tally.add("direct", judged, times.direct, stages.time);
            let judged = self.beside(&frame.direct.light, light, |a, b| pixels(a, b));
            tally.part("direct", judged);
        }
        if self.runs("gather") {
            let all = stages.gather(seen, places, &lights)?;
            let judged = self.beside(&frame.all, all, |a, b| pixels(a, b));
            tally.add("gather", judged, times.gather, stages.time);
        }
        if self.runs("block") {
            let found = stages.block(seen, places, &lights)?;
            let setting = self.spec.value.setting(of);
            let place = |pixel| word(of_coarse(&setting, frame, pixel));
            let (bits, light) = ((found.bits, found.rays), found.light);
            let judged = self.beside(&frame.blocked, bits, |a, (bits, rays)| {
                judge::blocked(a, (bits, *rays), place)
            });
            tally.add("block", judged, times.block, stages.time);
            let judged = self.beside(&frame.blocked.light, light, |a, b| {
                judge::colours("pixels of buffer B", a, b, |at| Some(place(at)))
            });
            tally.part("block", judged);
        }
        Ok(())
    }

    /// The picture of the spec's numbers, each rounded once.
    fn made(
        &self,
        of: &RsmFrame,
        stages: &mut Stages<'_>,
        tally: &mut Judged,
    ) -> Result<(), GpuError> {
        let RsmFrame { frame, times, .. } = of;
        let setting = self.spec.value.setting(of);
        let seen = &frame.seen.surfaces;
        if self.runs("blur") {
            let input = rounded(&frame.blocked.light);
            let Setting {
                model, parameters, ..
            } = &setting;
            let expected = blur(model, &frame.coarse, &exact(&input), parameters);
            let blurred = stages.blur(seen, &input)?;
            let place = |pixel| word(of_coarse(&setting, frame, pixel));
            let judged = self.beside(&expected, blurred, |a, b| {
                judge::colours("pixels of buffer B", a, b, |at| Some(place(at)))
            });
            tally.add("blur", judged, times.blur, stages.time);
        }
        let [direct, all, blurred] =
            [&frame.direct.light, &frame.all, &frame.blurred].map(|c| rounded(c));
        let light = [exact(&direct), exact(&all)];
        let light = light.each_ref().map(Vec::as_slice);
        let expected = composed(&setting, frame, light, &exact(&blurred));
        let picture = stages.compose(seen, [&direct, &all], &blurred)?;
        let judged = self.beside(&expected, picture, |a, b| pixels(a, b));
        tally.add("compose", judged, times.compose, stages.time);
        Ok(())
    }
}

/// Colours of the picture's pixels.
fn pixels(spec: &[Colour], seen: &[[f32; 3]]) -> crate::compare::Judgement {
    judge::colours("pixels", spec, seen, |pixel| Some(word(pixel)))
}

/// The triangle that each pixel sees, or [`NOTHING`].
fn triangles(seen: &Gbuffer) -> Vec<u32> {
    let surfaces = seen.surfaces.iter();
    surfaces
        .map(|s| s.map_or(NOTHING, |s| s.triangle))
        .collect()
}

/// Inputs of a stage: the spec's numbers, rounded once, and within what `f32` can say.
pub fn rounded(colours: &[Colour]) -> Vec<[f32; 3]> {
    #[expect(clippy::cast_possible_truncation, reason = "rounding is meant")]
    let single = |c: &Colour| c.map(|c| c.value.min(f64::from(f32::MAX)) as f32);
    colours.iter().map(single).collect()
}

/// Numbers that a stage is given, and that are therefore exact.
fn exact(colours: &[[f32; 3]]) -> Vec<Colour> {
    let exact = |c: &f32| Bounded {
        value: f64::from(*c),
        bound: 0.0,
    };
    colours.iter().map(|c| c.each_ref().map(exact)).collect()
}

fn word(pixel: usize) -> u32 {
    u32::try_from(pixel).expect("pictures have fewer than 2^32 pixels")
}
