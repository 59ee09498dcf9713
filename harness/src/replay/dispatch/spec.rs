//! The spec's side: every ray of every bounce.

use std::ops::Range;
use std::time::Duration;

use triptych_spec::dispatch::{
    Carried, Met, Ray, Searched, Sums, Tracer, World, behind, deposit, intersect, light, locate,
    primary, reflect,
};
use triptych_spec::rsm::{Colour, Surface};

use super::setup::Setup;
use crate::dispatch::share;
use crate::replay::spec::timed;
use crate::replay::work::{self, Meter, WORK_MAX};
use crate::scene::{Loaded, Mistake};

/// Everything that the spec says about a scene with rays in queues.
pub struct DispatchRun {
    /// What rays are traced in.
    pub setup: Setup,
    /// Rays that have seen as many mirrors, none first.
    pub bounces: Vec<Bounce>,
    /// The picture.
    pub sums: Sums,
    /// How far each pixel of an `f32` evaluation may be from it, in light.
    pub bounds: Vec<[f64; 3]>,
    /// Time of each stage.
    pub times: Times,
}

/// Rays that have seen as many mirrors, in the order of the queue.
#[derive(Clone, Debug, Default)]
pub struct Bounce {
    /// Those that ask for the nearest surface.
    pub rays: Vec<Ray>,
    /// What they meet.
    pub met: Vec<Met>,
    /// The point of each, where there is one.
    pub surfaces: Vec<Option<Surface>>,
    /// Shadow rays, lamp by lamp of each point.
    pub shadows: Vec<Ray>,
    /// The light that each brings, with its bound.
    pub lights: Vec<Colour>,
    /// Whether it reaches its lamp.
    pub lit: Vec<bool>,
}

/// Time of each stage.
#[derive(Clone, Copy, Debug, Default)]
pub struct Times {
    /// Stage primary.
    pub primary: Duration,
    /// Stage intersect, of both kinds of rays.
    pub intersect: Duration,
    /// Stage locate.
    pub locate: Duration,
    /// Stage light.
    pub light: Duration,
    /// Stage reflect.
    pub reflect: Duration,
    /// Stage deposit.
    pub deposit: Duration,
}

impl DispatchRun {
    /// Traces everything, bounce after bounce.
    ///
    /// # Errors
    /// One line for a scene beyond the limits, with the key to change.
    pub fn new(loaded: &Loaded) -> Result<Self, Mistake> {
        let setup = Setup::new(loaded)?;
        let size = setup.world.eye.size;
        let mut run = Self {
            setup,
            bounces: Vec::new(),
            sums: Sums::new(size),
            bounds: vec![[0.0; 3]; size.pixels()],
            times: Times::default(),
        };
        let meter = Meter::new(WORK_MAX);
        let (mut rays, time) = timed(|| primary(&run.setup.world.eye).collect::<Vec<Ray>>());
        run.times.primary = time;
        // As many times as there are mirrors on the way at most, and once more.
        while !rays.is_empty() {
            rays = run.bounce(rays, &meter)?;
        }
        Ok(run)
    }

    /// Traces a bounce's rays; those of the next.
    fn bounce(&mut self, rays: Vec<Ray>, meter: &Meter) -> Result<Vec<Ray>, Mistake> {
        let world = &self.setup.world;
        let tracer = self.setup.tracer();
        let times = &mut self.times;
        within(&self.setup, meter, &rays)?;
        let (met, time) = timed(|| answers(&tracer, &rays));
        times.intersect += time;
        let (surfaces, time) = timed(|| surfaces(world, &rays, &met));
        times.locate += time;
        let (shadows, time) = timed(|| shadows(world, &rays, &surfaces));
        times.light += time;
        let (shadows, lights): (Vec<Ray>, Vec<Colour>) = shadows.into_iter().unzip();
        within(&self.setup, meter, &shadows)?;
        let (reached, time) = timed(|| answers(&tracer, &shadows));
        times.intersect += time;
        let (mirrored, time) = timed(|| mirrored(world, &rays, &surfaces));
        times.reflect += time;
        let bounce = Bounce {
            lit: reached.iter().map(|met| *met == Met::Nothing).collect(),
            rays,
            met,
            surfaces,
            shadows,
            lights,
        };
        let ((), time) = timed(|| bounce.deposit(world, &mut self.sums));
        times.deposit += time;
        bounce.bound(world, &mut self.bounds);
        self.bounces.push(bounce);
        Ok(mirrored)
    }

    /// Rays of all kinds and bounces.
    pub fn rays(&self) -> u64 {
        let of = |bounce: &Bounce| (bounce.rays.len() + bounce.shadows.len()) as u64;
        self.bounces.iter().map(of).sum()
    }
}

impl Setup {
    /// The spec's tracer.
    pub fn tracer(&self) -> Searched<'_> {
        Searched {
            grid: &self.grid,
            blockers: &self.world.blockers,
        }
    }
}

impl Bounce {
    /// What the bounce's rays bring: the background along those that meet nothing, then the lamps' light.
    pub fn deposits<'a>(&'a self, world: &'a World) -> impl Iterator<Item = (u32, [f32; 3])> + 'a {
        let missed = self.rays.iter().zip(&self.met).filter_map(|(ray, met)| {
            let Carried::Weight(weight) = ray.carried else {
                return None;
            };
            (*met == Met::Nothing).then(|| (ray.pixel, behind(world, weight)))
        });
        let lit = self.shadows.iter().zip(&self.lit);
        let lit = lit.filter_map(|(ray, lit)| match ray.carried {
            Carried::Light(light) if *lit => Some((ray.pixel, light)),
            _ => None,
        });
        missed.chain(lit)
    }

    /// What the bounce alone brings to a picture.
    pub fn sums(&self, world: &World) -> Sums {
        let mut sums = Sums::new(world.eye.size);
        self.deposit(world, &mut sums);
        sums
    }

    fn deposit(&self, world: &World, sums: &mut Sums) {
        for (pixel, light) in self.deposits(world) {
            deposit(sums, pixel, light);
        }
    }

    /// Adds up how far light may be off: the bound of each lamp's, and of the background the rounding of a
    /// product; beside these, each is rounded to a unit on both sides.
    fn bound(&self, world: &World, bounds: &mut [[f64; 3]]) {
        let mut add = |pixel: u32, light: [f64; 3]| {
            for (sum, bound) in bounds[pixel as usize].iter_mut().zip(light) {
                *sum += bound + UNIT;
            }
        };
        for (ray, met) in self.rays.iter().zip(&self.met) {
            if let (Met::Nothing, Carried::Weight(weight)) = (met, ray.carried) {
                add(
                    ray.pixel,
                    behind(world, weight).map(|c| ROUNDED * f64::from(c)),
                );
            }
        }
        for ((ray, light), lit) in self.shadows.iter().zip(&self.lights).zip(&self.lit) {
            if *lit {
                // The spec's own was rounded to f32 as well.
                add(ray.pixel, light.map(|c| c.bound + ROUNDED * c.value));
            }
        }
    }
}

/// Rays of a piece of work.
const RAYS: usize = 64;

/// A unit of a picture's sums.
const UNIT: f64 = 1.0 / (1_u32 << triptych_spec::dispatch::UNIT_BITS) as f64;

/// A rounding to `f32` on each side.
const ROUNDED: f64 = 2.0 * triptych_spec::bound::U;

/// Stage intersect.
fn answers(tracer: &(impl Tracer + Sync), rays: &[Ray]) -> Vec<Met> {
    share::map(rays, RAYS, |ray| intersect(tracer, ray))
}

/// Stage locate.
fn surfaces(world: &World, rays: &[Ray], met: &[Met]) -> Vec<Option<Surface>> {
    let of = |at: usize| match met[at] {
        Met::Triangle(triangle) => Some(locate(world, rays[at].way, triangle)),
        Met::Nothing | Met::Something => None,
    };
    share::runs(rays.len(), RAYS, |run| run.map(of).collect())
}

/// Rays of a run with the points that they meet.
fn located<'a>(
    rays: &'a [Ray],
    surfaces: &'a [Option<Surface>],
    run: Range<usize>,
) -> impl Iterator<Item = (&'a Ray, &'a Surface)> {
    let both = rays[run.clone()].iter().zip(&surfaces[run]);
    both.filter_map(|(ray, surface)| Some((ray, surface.as_ref()?)))
}

/// Stage light.
fn shadows(world: &World, rays: &[Ray], surfaces: &[Option<Surface>]) -> Vec<(Ray, Colour)> {
    share::runs(rays.len(), RAYS, |run| {
        let all = located(rays, surfaces, run);
        all.flat_map(|(ray, surface)| light(world, ray, surface))
            .collect()
    })
}

/// Stage reflect.
fn mirrored(world: &World, rays: &[Ray], surfaces: &[Option<Surface>]) -> Vec<Ray> {
    share::runs(rays.len(), RAYS, |run| {
        let all = located(rays, surfaces, run);
        all.filter_map(|(ray, surface)| reflect(world, ray, surface))
            .collect()
    })
}

/// Refuses rays that would take too long.
fn within(setup: &Setup, meter: &Meter, rays: &[Ray]) -> Result<(), Mistake> {
    let most = work::most(&setup.grid).total();
    let takes = match (rays.len() as u64).checked_mul(most) {
        // Where no rays could exceed a part of the limit, these need not be counted.
        Some(all) if all <= WORK_MAX / 128 => meter.takes(all),
        _ => share::all(rays.len(), RAYS, |at| {
            meter.takes(work::of(&setup.grid, rays[at].way).total())
        }),
    };
    match takes {
        true => Ok(()),
        false => Err(Mistake::of(
            "size",
            format!(
                "the rays pass more than {WORK_MAX} cells and triangles in their lists, the limit; use a \
                 smaller picture, fewer lamps or mirrors, or simpler meshes"
            ),
        )),
    }
}
