//! Embree's say: a vote on every ray that stage `block` asks for, the picture that its answers
//! make of the same samples, and the picture without noise.
//!
//! The reference is the same light transport with the same kernel: every pixel asks for itself
//! (divisor 1), nothing is blurred, and Embree says what is blocked. Where it cannot be trusted
//! near an edge it still says something, and that is taken: there is one ray in thousands of
//! these.

use std::time::{Duration, Instant};

use triptych_spec::bound::Bounded;
use triptych_spec::grid::ray::Ray;
use triptych_spec::grid::trace::Query;
use triptych_spec::rsm::{Colour, Frame, Light, Setting, blur};

use super::kernel::{of_coarse, pairs};
use super::spec::{RsmFrame, RsmRun, composed};
use crate::compare::embree::{RayVote, compare_rays};
use crate::dispatch::share;
use crate::embree::EmbreeError;
use crate::embree::rays::{RayAnswers, RayScene};

/// Pixels of a piece of work.
const PIXELS: usize = 64;

/// Rays that are gathered before they are judged.
const BATCH: usize = 1 << 16;

/// What Embree makes of a frame.
pub struct Seen {
    /// Its vote on the rays of stage `block`.
    pub vote: RayVote,
    /// The picture of the same samples, of as many pixels of buffer B and as much blur.
    pub picture: Vec<[f64; 3]>,
    /// The picture without noise.
    pub reference: Vec<[f64; 3]>,
    /// How long the rays of stage `block` took, on all cores.
    pub time: Duration,
}

/// Asks Embree of a frame.
///
/// # Errors
/// The first error that Embree reports.
pub fn ask(run: &RsmRun, frame: &RsmFrame) -> Result<Seen, EmbreeError> {
    ask_of(&RayScene::new(&frame.parts.blockers)?, run, frame)
}

/// The same of any observation.
pub(super) fn ask_of<E: RayAnswers>(
    scene: &E,
    run: &RsmRun,
    frame: &RsmFrame,
) -> Result<Seen, EmbreeError> {
    let setting = run.setting(frame);
    let lights = frame.frame.rsm.lights();
    let asked = Asked {
        setting: &setting,
        frame: &frame.frame,
        lights: &lights,
        scene,
    };
    let start = Instant::now();
    let coarse = asked.coarse()?;
    let time = start.elapsed();
    Ok(Seen {
        vote: asked.vote()?,
        picture: asked.picture(&coarse),
        reference: asked.reference()?,
        time,
    })
}

/// The picture without noise of a frame that is drawn up to its direct light.
///
/// # Errors
/// The first error that Embree reports.
pub fn reference(setting: &Setting<'_>, frame: &Frame) -> Result<Vec<[f64; 3]>, EmbreeError> {
    let asked = Asked {
        setting,
        frame,
        lights: &frame.rsm.lights(),
        scene: &RayScene::new(setting.blockers)?,
    };
    asked.reference()
}

struct Asked<'a, E> {
    setting: &'a Setting<'a>,
    frame: &'a Frame,
    lights: &'a [Option<Light>],
    scene: &'a E,
}

impl<E: RayAnswers> Asked<'_, E> {
    /// Compares Embree's answers to the rays of stage `block` with the spec's.
    fn vote(&self) -> Result<RayVote, EmbreeError> {
        let mut total = RayVote::default();
        let mut rays: Vec<Ray> = Vec::new();
        let pixels = self.frame.coarse.size.pixels();
        for pixel in 0..pixels {
            let at = of_coarse(self.setting, self.frame, pixel);
            let asked = pairs(self.setting, self.frame, self.lights, at);
            rays.extend(asked.map(|pair| pair.ray));
            if rays.len() >= BATCH || pixel + 1 == pixels {
                let Setting { grid, blockers, .. } = self.setting;
                let mut vote = compare_rays(grid, blockers, &rays, Query::Any, self.scene)?;
                let before = usize::try_from(total.rays).expect("rays that were held");
                vote.first.iter_mut().for_each(|first| first.ray += before);
                total.add(vote);
                rays.clear();
            }
        }
        Ok(total)
    }

    /// What Embree says is kept away from each pixel of buffer B.
    fn coarse(&self) -> Result<Vec<[f64; 3]>, EmbreeError> {
        let pixels = self.frame.coarse.size.pixels();
        self.each(pixels, |pixel| {
            let at = of_coarse(self.setting, self.frame, pixel);
            self.sum(at, |blocked| blocked)
        })
    }

    /// The light of those texels of a pixel's kernel whose rays are blocked, or are not.
    fn sum(&self, pixel: usize, counts: impl Fn(bool) -> bool) -> [f64; 3] {
        let all = pairs(self.setting, self.frame, self.lights, pixel);
        let given = all.filter(|pair| counts(self.scene.occluded(&pair.ray)));
        given.fold([0.0; 3], |sum, pair| {
            [0, 1, 2].map(|i| sum[i] + pair.light[i])
        })
    }

    /// Works on pixels side by side. The result does not depend on how many threads do.
    fn each(
        &self,
        pixels: usize,
        of: impl Fn(usize) -> [f64; 3] + Sync,
    ) -> Result<Vec<[f64; 3]>, EmbreeError> {
        let pixel = |pixel| {
            let colour = of(pixel);
            self.scene.check().map(|()| colour)
        };
        let found = share::runs(pixels, PIXELS, |pixels| pixels.map(pixel).collect());
        found.into_iter().collect()
    }

    /// The spec's stages after `block`, of what Embree says is blocked.
    fn picture(&self, coarse: &[[f64; 3]]) -> Vec<[f64; 3]> {
        let Setting {
            model, parameters, ..
        } = self.setting;
        let light: Vec<Colour> = coarse.iter().map(|c| c.map(exact)).collect();
        let blurred = blur(model, &self.frame.coarse, &light, parameters);
        let all = [&self.frame.direct.light[..], &self.frame.all];
        values(&composed(self.setting, self.frame, all, &blurred))
    }

    /// The picture of every pixel's own rays.
    fn reference(&self) -> Result<Vec<[f64; 3]>, EmbreeError> {
        let pixels = self.frame.seen.surfaces.len();
        self.each(pixels, |pixel| {
            let Some(surface) = &self.frame.seen.surfaces[pixel] else {
                return self.setting.background.map(f64::from);
            };
            let indirect = self.sum(pixel, |blocked| !blocked);
            let direct = self.frame.direct.light[pixel];
            let colour = self.setting.model.colours[surface.triangle as usize];
            [0, 1, 2].map(|i| (direct[i].value + indirect[i]) * f64::from(colour[i]))
        })
    }
}

fn exact(value: f64) -> Bounded {
    Bounded { value, bound: 0.0 }
}

/// Colours without their bounds.
pub fn values(colours: &[Colour]) -> Vec<[f64; 3]> {
    let value = |colour: &Colour| colour.map(|channel| channel.value);
    colours.iter().map(value).collect()
}

/// Root of the mean square of the difference, over all channels of all pixels.
pub(super) fn rmse(a: &[[f64; 3]], b: &[[f64; 3]]) -> f64 {
    let apart = a.iter().flatten().zip(b.iter().flatten());
    let sum: f64 = apart.map(|(a, b)| (a - b) * (a - b)).sum();
    (sum / (3 * a.len()).max(1) as f64).sqrt()
}
