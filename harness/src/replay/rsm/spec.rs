//! The spec's side: every stage of every frame.

use std::time::Duration;

use triptych_spec::rsm::{
    Blocked, Coarse, Colour, DARK, Frame, Rsm, Setting, blur, compose, direct, place,
};

use super::limits::Limits;
use super::setup::{Parts, Setup};
use super::shared::{blocked, gathered};
use crate::plan::RsmPlan;
use crate::replay::pieces;
use crate::replay::rows::Spot;
use crate::replay::spec::timed;
use crate::report::Picture;
use crate::scene::{Loaded, Mistake};

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
    /// One line for a scene beyond the limits of the spec, with the key to change.
    pub fn new(loaded: &Loaded, skip: bool) -> Result<Self, Mistake> {
        let plan = RsmPlan::new(loaded, skip);
        let setup = Setup::new(loaded)?;
        let background = loaded.scene.background;
        let mut limits = Limits::new(&setup);
        let part = |number| {
            let (parts, grid) = timed(|| setup.parts(loaded, number));
            let parts = parts?;
            limits.add(&setup, &parts)?;
            Ok((parts, grid))
        };
        let parts = (0..setup.frames).map(part);
        let parts = parts.collect::<Result<Vec<_>, Mistake>>()?;
        let frame = |(parts, grid)| {
            let setting = setting(&setup, &parts, background);
            let (frame, times) = render(&setting, &plan, &limits)?;
            let times = Times { grid, ..times };
            Ok(RsmFrame {
                parts,
                frame,
                times,
            })
        };
        let frames = parts.into_iter().map(frame);
        let frames = frames.collect::<Result<_, Mistake>>()?;
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

/// [`Frame::render`], with the time of each stage, and without those that change nothing.
///
/// # Errors
/// Rays of stage `block` that would take too long.
fn render(
    setting: &Setting<'_>,
    plan: &RsmPlan,
    limits: &Limits,
) -> Result<(Frame, Times), Mistake> {
    let Setting {
        model,
        eye,
        lamp,
        blockers,
        grid,
        parameters,
        ..
    } = setting;
    let mut times = Times::default();
    let (seen, at) = timed(|| pieces::gbuffer(model, eye, parameters));
    times.gbuffer = at;
    let (rsm, at) = timed(|| {
        let seen = pieces::gbuffer(model, &lamp.view, parameters);
        Rsm::lit(model, lamp, seen, parameters)
    });
    times.rsm = at;
    let (places, at) = timed(|| place(&lamp.view, &seen));
    times.place = at;
    let (lights, size) = (rsm.lights(), rsm.seen.size);
    let (direct, at) = timed(|| direct(model, &seen, &places, lamp, &rsm.seen.keys, parameters));
    times.direct = at;
    let (all, at) = timed(|| gathered(model, &seen, &places, &lights, size, parameters));
    times.gather = at;
    let coarse = Coarse::new(&seen, parameters);
    let mut frame = Frame {
        seen,
        rsm,
        places,
        direct,
        all,
        blocked: nothing(&coarse, parameters.words()),
        coarse,
        blurred: Vec::new(),
        picture: Vec::new(),
    };
    if plan.skipped("block").is_none() {
        limits.rays(setting, &frame, &lights)?;
        let Frame { seen, places, .. } = &frame;
        let cells = (*grid, *blockers);
        (frame.blocked, times.block) =
            timed(|| blocked(model, seen, places, &lights, size, cells, parameters));
    }
    (frame.blurred, times.blur) = match plan.skipped("blur") {
        None => timed(|| blur(model, &frame.coarse, &frame.blocked.light, parameters)),
        Some(_) => (frame.blocked.light.clone(), Duration::ZERO),
    };
    let light = [&frame.direct.light[..], &frame.all];
    let (picture, at) = timed(|| composed(setting, &frame, light, &frame.blurred));
    (frame.picture, times.compose) = (picture, at);
    Ok((frame, times))
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
