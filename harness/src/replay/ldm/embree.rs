//! Embree's say: a vote on the lists of sampled pixels, and what is open over sampled receivers,
//! by rays in the same directions and by rays in random ones.
//!
//! Rays in the same directions tell what the maps' resolution costs; random ones, what the number
//! of directions costs beside. Neither has a bound that the spec could be held to, so their
//! distances are told, not judged.

use std::f64::consts::TAU;

use triptych_spec::grid::ray::Ray;
use triptych_spec::ldm::{Falloff, Map, WEIGHT_BITS, weight};

use super::setup::{Asker, Setup};
use super::spec::LdmRun;
use crate::compare::embree::{MapVote, Sampled, compare_maps};
use crate::dispatch::share;
use crate::embree::rays::{RayAnswers, RayScene};
use crate::embree::{EmbreeError, Hit};
use crate::generate::Random;
use crate::vector::{add, length, normalize};

/// Pixels whose lists are voted on, about, over all rotations.
const PIXELS: u64 = 1 << 15;

/// Pairs of a triangle and a map that are looked at for them, about.
const TRIANGLES: u64 = 1 << 24;

/// Rays in the maps' directions, about, and as many random ones.
const RAYS: usize = 1 << 19;

/// Random rays of a receiver.
pub const SAMPLES: u32 = 256;

/// What Embree makes of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Seen {
    /// Its vote on the lists.
    pub vote: MapVote,
    /// How far the spec's openness is from that of rays.
    pub off: Option<Off>,
}

/// How far the spec's openness is from that of rays, over some receivers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Off {
    /// How many receivers.
    pub receivers: usize,
    /// From rays in the same directions: root of the mean square, and the largest.
    pub same: [f64; 2],
    /// From random rays, the same.
    pub random: [f64; 2],
    /// Root of the mean variance of what those rays say, which is part of `random`.
    pub noise: f64,
}

/// Asks Embree of all rotations.
///
/// # Errors
/// The first error that Embree reports.
pub fn ask(run: &LdmRun, seed: u64) -> Result<Seen, EmbreeError> {
    let scene = RayScene::new(&run.setup.blockers)?;
    Ok(Seen {
        vote: vote(run, &scene)?,
        off: off(run, seed, &scene)?,
    })
}

/// The vote on as many maps, evenly, and on as many pixels of each, evenly, as there is time for.
fn vote(run: &LdmRun, scene: &RayScene) -> Result<MapVote, EmbreeError> {
    let all: u64 = run.turns.iter().map(|t| t.maps.maps.len() as u64).sum();
    let triangles = run.setup.blockers.triangles.len().max(1) as u64;
    let maps = (TRIANGLES / triangles).clamp(1, all.max(1));
    let mut total = MapVote::default();
    let mut number = 0;
    for turn in &run.turns {
        let mut sampled = Vec::new();
        for (map, of) in turn.maps.maps.iter().enumerate() {
            // The multiples of all / maps fall on as many of them.
            let chosen = number * maps / all != (number + 1) * maps / all;
            number += 1;
            if chosen {
                let pixels = f64::from(of.size.width) * f64::from(of.size.height);
                let share = pixels * maps as f64 / PIXELS as f64;
                #[expect(
                    clippy::cast_possible_truncation,
                    clippy::cast_sign_loss,
                    reason = "at most the side of a map"
                )]
                let stride = libm::ceil(libm::sqrt(share)) as u32;
                let stride = stride.clamp(1, of.size.width.min(of.size.height));
                sampled.push(Sampled { map, stride });
            }
        }
        let (maps, layers) = (&turn.maps, &turn.layers);
        let blockers = &run.setup.blockers;
        let first = number - turn.maps.maps.len() as u64;
        let mut vote = compare_maps(maps, layers, blockers, &sampled, scene)?;
        for wrong in &mut vote.first {
            wrong.map += usize::try_from(first).expect("at most 4096 maps");
        }
        total.add(vote);
    }
    Ok(total)
}

/// How far openness is from that of rays; `None` if nobody asks.
fn off(run: &LdmRun, seed: u64, scene: &RayScene) -> Result<Option<Off>, EmbreeError> {
    let maps: usize = run.turns.iter().map(|t| t.maps.maps.len()).sum();
    let receivers = &run.setup.receivers;
    let most = RAYS / maps.max(SAMPLES as usize);
    let stride = receivers.len().div_ceil(most.max(1)).max(1);
    let chosen: Vec<usize> = (stride / 2..receivers.len()).step_by(stride).collect();
    let one = |&at: &usize| {
        let asker = &receivers[at];
        let own = run.openness[at].value;
        let maps = run.turns.iter().flat_map(|turn| &turn.maps.maps);
        let directions = run.setup.directions * run.setup.rotations;
        let same = same(&run.setup, maps, directions, asker, scene);
        let (random, variance) = random(&run.setup, asker, (seed, SAMPLES), scene);
        scene.check().map(|()| [own - same, own - random, variance])
    };
    let found: Vec<Result<[f64; 3], EmbreeError>> = share::map(&chosen, 16, one);
    let found = found.into_iter().collect::<Result<Vec<_>, _>>()?;
    if found.is_empty() {
        return Ok(None);
    }
    let count = found.len() as f64;
    let of = |i: usize| {
        let squares: f64 = found.iter().map(|f| f[i] * f[i]).sum();
        let largest = found.iter().map(|f| f[i].abs()).fold(0.0, f64::max);
        [(squares / count).sqrt(), largest]
    };
    let variance: f64 = found.iter().map(|f| f[2]).sum();
    Ok(Some(Off {
        receivers: found.len(),
        same: of(0),
        random: of(1),
        noise: (variance / count).sqrt(),
    }))
}

/// What is open by a ray in each map's direction, with the spec's weights, of a set of so many
/// directions.
pub fn same<'m>(
    setup: &Setup,
    maps: impl Iterator<Item = &'m Map>,
    directions: u32,
    asker: &Asker,
    scene: &RayScene,
) -> f64 {
    let receiver = &asker.receiver;
    let passes = |map: &Map| {
        let weight = weight(map, receiver.normal);
        let side = f64::from(weight.signum());
        if weight == 0 {
            return 0.0;
        }
        let ray = Ray::along(receiver.point, map.direction.map(|c| side * c));
        f64::from(weight.unsigned_abs()) * passed(setup.falloff, &ray, scene)
    };
    let sum: f64 = maps.map(passes).sum();
    sum * 2.0 / f64::from(directions) / f64::from(1_u32 << WEIGHT_BITS)
}

/// The mean of random rays, as likely as the cosine with the normal, and the variance of that
/// mean. A ray is the normal and a point of the unit sphere.
pub fn random(
    setup: &Setup,
    asker: &Asker,
    (seed, samples): (u64, u32),
    scene: &RayScene,
) -> (f64, f64) {
    let normal = normalize(asker.receiver.normal.map(f64::from));
    let mut random = Random::new(seed.wrapping_mul(1 << 32).wrapping_add(asker.pixel.into()));
    let (mut sum, mut squares) = (0.0, 0.0);
    for _ in 0..samples {
        let up = random.signed();
        let (sin, cos) = libm::sincos(TAU * random.unit());
        let out = libm::sqrt(1.0 - up * up);
        let way = add(normal, [out * cos, out * sin, up]);
        let part = passed(setup.falloff, &Ray::along(asker.receiver.point, way), scene);
        sum += part;
        squares += part * part;
    }
    let count = f64::from(samples);
    let mean = sum / count;
    let variance = (squares / count - mean * mean).max(0.0) / (count - 1.0);
    (mean, variance)
}

/// Which part of what comes along a ray passes.
fn passed(falloff: Falloff, ray: &Ray, scene: &RayScene) -> f64 {
    if falloff == Falloff::None {
        return f64::from(u8::from(!scene.occluded(ray)));
    }
    let steps = |hit: Hit| f64::from(hit.t) * length(ray.direction.map(f64::from));
    passes(falloff, scene.closest(ray).map(steps))
}

/// Which part passes by what is first met, so many steps away.
pub fn passes(falloff: Falloff, steps: Option<f64>) -> f64 {
    match (steps, falloff) {
        (None, _) => 1.0,
        (Some(_), Falloff::None) => 0.0,
        (Some(steps), Falloff::Distance { most, power }) => {
            let part = steps / f64::from(most);
            match part < 1.0 {
                true if power == 0 => 0.0,
                true => libm::pow(part, f64::from(power)),
                false => 1.0,
            }
        }
    }
}

impl std::fmt::Display for Off {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            f,
            "openness of {} receivers against rays in the same directions: RMSE {:.2e}, at most \
             {:.2e}; against {SAMPLES} random rays each: {:.2e}, of which noise {:.2e}, at most {:.2e}",
            self.receivers, self.same[0], self.same[1], self.random[0], self.noise, self.random[1],
        )
    }
}
