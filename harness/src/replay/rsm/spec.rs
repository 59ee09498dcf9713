//! The spec's side: every stage of every frame.

use std::time::Duration;

use triptych_spec::rsm::{
    Blocked, Coarse, Colour, DARK, Frame, Setting, block, blur, compose, direct, gather, gbuffer,
    place, rsm,
};

use super::setup::{Parts, Setup};
use crate::plan::RsmPlan;
use crate::replay::rows::Spot;
use crate::replay::spec::timed;
use crate::report::Picture;
use crate::scene::Loaded;

/// Most triangles that rays may be held against: pairs of a pixel of buffer B and a texel of
/// its kernel, times the longest list. More take a quarter of an hour, on one core.
pub const WORK_MAX: u64 = 1 << 34;

/// Everything that the spec says about a scene with indirect light.
pub struct RsmRun {
    /// What all frames share.
    pub setup: Setup,
    /// The frames.
    pub frames: Vec<RsmFrame>,
    /// Linear colour where nothing is seen.
    pub background: [f32; 3],
}

/// A frame.
pub struct RsmFrame {
    /// What it is made of.
    pub parts: Parts,
    /// What every stage gave.
    pub frame: Frame,
    /// Time of each stage, in the registry's order.
    pub times: Times,
}

/// Time of each stage.
#[derive(Clone, Copy, Debug, Default)]
pub struct Times {
    /// The blockers' cells.
    pub grid: Duration,
    /// Stage gbuffer.
    pub gbuffer: Duration,
    /// Stage rsm.
    pub rsm: Duration,
    /// Stage place.
    pub place: Duration,
    /// Stage direct.
    pub direct: Duration,
    /// Stage gather.
    pub gather: Duration,
    /// Stage block.
    pub block: Duration,
    /// Stage blur.
    pub blur: Duration,
    /// Stage compose.
    pub compose: Duration,
}

impl RsmRun {
    /// Runs all stages of all frames, but for those that the plan leaves out, which would
    /// give the same.
    ///
    /// # Errors
    /// One line for a scene beyond the limits of the spec.
    pub fn new(loaded: &Loaded, skip: bool) -> Result<Self, String> {
        let plan = RsmPlan::new(loaded, skip);
        let setup = Setup::new(loaded)?;
        let background = loaded.scene.background;
        let frame = |number| {
            let (parts, grid) = timed(|| setup.parts(loaded, number));
            let parts = parts?;
            within(&setup, &parts)?;
            let setting = setting(&setup, &parts, background);
            let (frame, times) = render(&setting, &plan);
            let times = Times { grid, ..times };
            Ok(RsmFrame {
                parts,
                frame,
                times,
            })
        };
        let frames = (0..setup.frames)
            .map(frame)
            .collect::<Result<_, String>>()?;
        Ok(Self {
            setup,
            frames,
            background,
        })
    }

    /// What a frame's stages are given.
    pub fn setting<'s>(&'s self, frame: &'s RsmFrame) -> Setting<'s> {
        setting(&self.setup, &frame.parts, self.background)
    }

    /// A time of all frames together.
    pub fn time(&self, of: impl Fn(&Times) -> Duration) -> Duration {
        self.frames.iter().map(|frame| of(&frame.times)).sum()
    }

    /// Which pixels differ, and why; `None` if none does.
    pub fn causes(&self, spots: &[Spot]) -> Option<Picture> {
        super::pictures::causes(self, spots)
    }

    /// A frame's picture with its indirect light as if nothing were in its way.
    pub fn unblocked(&self, frame: &RsmFrame) -> Vec<Colour> {
        let dark = vec![DARK; frame.frame.coarse.size.pixels()];
        let all = [&frame.frame.direct.light[..], &frame.frame.all];
        composed(&self.setting(frame), &frame.frame, all, &dark)
    }
}

/// Stage compose, of other light.
pub(super) fn composed(
    setting: &Setting<'_>,
    frame: &Frame,
    light: [&[Colour]; 2],
    blurred: &[Colour],
) -> Vec<Colour> {
    let Setting {
        model,
        parameters,
        background,
        ..
    } = setting;
    let coarse = (&frame.coarse, blurred);
    compose(model, &frame.seen, light, coarse, parameters, *background)
}

fn setting<'s>(setup: &'s Setup, parts: &'s Parts, background: [f32; 3]) -> Setting<'s> {
    Setting {
        model: &parts.model,
        eye: &setup.eye,
        lamp: &setup.lamp,
        blockers: &parts.blockers,
        grid: &parts.grid,
        parameters: setup.parameters,
        background,
    }
}

/// Refuses rays that would take too long.
fn within(setup: &Setup, parts: &Parts) -> Result<(), String> {
    let lists = parts.grid.offsets.windows(2).map(|w| w[1] - w[0]);
    let longest = u64::from(lists.max().unwrap_or(0));
    let side = u64::from(setup.parameters.side());
    let coarse = setup.parameters.coarse(setup.eye.size).pixels() as u64;
    let rays = coarse * side * side;
    match rays.saturating_mul(longest) > WORK_MAX {
        false => Ok(()),
        true => Err(format!(
            "{rays} rays at most and a list of {longest} triangles: their product is at most \
             {WORK_MAX}; use a smaller kernel, a larger divisor or simpler blockers"
        )),
    }
}

/// [`Frame::render`], with the time of each stage, and without those that change nothing.
fn render(setting: &Setting<'_>, plan: &RsmPlan) -> (Frame, Times) {
    let Setting {
        model,
        eye,
        lamp,
        blockers,
        grid,
        parameters,
        ..
    } = setting;
    let (seen, at_gbuffer) = timed(|| gbuffer(model, eye, parameters));
    let (rsm, at_rsm) = timed(|| rsm(model, lamp, parameters));
    let (places, at_place) = timed(|| place(&lamp.view, &seen));
    let (lights, size) = (rsm.lights(), rsm.seen.size);
    let (direct, at_direct) =
        timed(|| direct(model, &seen, &places, lamp, &rsm.seen.keys, parameters));
    let (all, at_gather) = timed(|| gather(model, &seen, &places, &lights, size, parameters));
    let coarse = Coarse::new(&seen, parameters);
    let cells = (*grid, *blockers);
    let (blocked, at_block) = match plan.skipped("block") {
        None => timed(|| block(model, &seen, &places, &lights, size, cells, parameters)),
        Some(_) => (nothing(&coarse, parameters.words()), Duration::ZERO),
    };
    let (blurred, at_blur) = match plan.skipped("blur") {
        None => timed(|| blur(model, &coarse, &blocked.light, parameters)),
        Some(_) => (blocked.light.clone(), Duration::ZERO),
    };
    let mut frame = Frame {
        seen,
        rsm,
        places,
        direct,
        all,
        blocked,
        coarse,
        blurred,
        picture: Vec::new(),
    };
    let light = [&frame.direct.light[..], &frame.all];
    let (picture, at_compose) = timed(|| composed(setting, &frame, light, &frame.blurred));
    frame.picture = picture;
    let times = Times {
        grid: Duration::ZERO,
        gbuffer: at_gbuffer,
        rsm: at_rsm,
        place: at_place,
        direct: at_direct,
        gather: at_gather,
        block: at_block,
        blur: at_blur,
        compose: at_compose,
    };
    (frame, times)
}

/// Buffer B where nothing is blocked, and no ray is asked for.
fn nothing(coarse: &Coarse, words: usize) -> Blocked {
    Blocked {
        size: coarse.size,
        bits: vec![0; coarse.size.pixels() * words],
        rays: 0,
        light: vec![DARK; coarse.size.pixels()],
    }
}
