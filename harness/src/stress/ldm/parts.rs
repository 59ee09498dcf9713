//! What is open, and which part of its error comes from where.
//!
//! Four answers for each asker: by the maps; by Embree's rays in the maps' directions on the
//! lattice, from the lattice's points; by rays in these directions among the triangles as the files
//! have them, from points that lie on them; and by random rays there. The first three have the same
//! weights. From one to the next, one thing changes at a time:
//!
//! - maps to rays on the lattice: **resolution**, which is a pixel's width and the band of a
//!   point's own surface that comes of it, and, far below that, sub-pixels and keys;
//! - rays on the lattice to rays among what the files have: **quantisation** of vertices, of points
//!   and of the steps that these are moved off their faces by, and of the rays' directions;
//! - rays in these directions to random ones: **directions**, which is how well so many stand for
//!   all, and the rounding of weights to 19 bits. Random rays have noise, which is told.
//!
//! The three add up to the whole, asker by asker. Their RMSEs do not: errors cancel.

use std::f64::consts::TAU;

use rayon::prelude::*;
use triptych_spec::ldm::{WEIGHT_BITS, weight};

use super::exact::{Around, Exact, From};
use crate::embree::rays::{RayAnswers, RayScene};
use crate::generate::Random;
use crate::replay::ldm::{Asker, LdmRun, passes, same};
use crate::vector::{add, normalize, scale};

/// Random rays of an asker.
pub const SAMPLES: u32 = 4096;

/// Root of the mean square, and the largest.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Error {
    /// Root of the mean square.
    pub rmse: f64,
    /// The largest.
    pub most: f64,
}

/// The errors of what is open, over all askers; all from 0 to about 1.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Parts {
    /// Askers whose triangles have an area.
    pub askers: u64,
    /// Maps against random rays.
    pub whole: Error,
    /// The part of the number of directions.
    pub directions: Error,
    /// The part of rounding to the lattice.
    pub quantisation: Error,
    /// The part of pixels.
    pub resolution: Error,
    /// Root of the mean variance of the random rays' means, in `whole` and in `directions`.
    pub noise: f64,
    /// The largest difference between the whole and the sum of its parts; rounding of `f64`.
    pub rest: f64,
}

/// Of one asker: whole, directions, quantisation, resolution, and the variance.
type One = [f64; 5];

impl Parts {
    /// Of all askers of a run.
    ///
    /// # Errors
    /// What Embree reports, in one line.
    pub(super) fn of(run: &LdmRun, exact: &Exact, seed: u64) -> Result<Self, String> {
        let scene = RayScene::new(&run.setup.blockers).map_err(|e| e.to_string())?;
        let askers = run.setup.receivers.par_iter().enumerate();
        let found: Vec<Option<One>> = askers
            .map(|(at, asker)| {
                let from = exact.from(&run.setup, asker);
                from.map(|from| one(run, (at, asker), (exact, &from), (&scene, seed)))
            })
            .collect();
        scene.check().map_err(|e| e.to_string())?;
        let found: Vec<One> = found.into_iter().flatten().collect();
        let error = |i: usize| Error::of(found.iter().map(|one| one[i]));
        let variance: f64 = found.iter().map(|one| one[4]).sum();
        let rest = |one: &One| (one[0] - (one[1] + one[2] + one[3])).abs();
        Ok(Self {
            askers: found.len() as u64,
            whole: error(0),
            directions: error(1),
            quantisation: error(2),
            resolution: error(3),
            noise: (variance / found.len().max(1) as f64).sqrt(),
            rest: found.iter().map(rest).fold(0.0, f64::max),
        })
    }
}

impl Error {
    fn of(all: impl Iterator<Item = f64>) -> Self {
        let (mut squares, mut count, mut most) = (0.0, 0.0, 0.0_f64);
        for off in all {
            squares += off * off;
            count += 1.0;
            most = most.max(off.abs());
        }
        Self {
            rmse: (squares / f64::max(count, 1.0)).sqrt(),
            most,
        }
    }
}

fn one(
    run: &LdmRun,
    (at, asker): (usize, &Asker),
    (exact, from): (&Exact, &From),
    (scene, seed): (&RayScene, u64),
) -> One {
    let around = exact.around(from);
    let maps = run.turns.iter().flat_map(|turn| &turn.maps.maps);
    let directions = run.setup.directions * run.setup.rotations;
    let own = run.openness[at].value;
    let rounded = same(&run.setup, maps, directions, asker, scene);
    let unrounded = in_directions(run, asker, &around);
    let (random, variance) = at_random(run, asker, (from, &around), seed);
    [
        own - random,
        unrounded - random,
        rounded - unrounded,
        own - rounded,
        variance,
    ]
}

/// What is open by a ray in each map's direction, with the spec's weights.
fn in_directions(run: &LdmRun, asker: &Asker, around: &Around) -> f64 {
    let maps = run.turns.iter().flat_map(|turn| &turn.maps.maps);
    let directions = run.setup.directions * run.setup.rotations;
    let parts = maps.map(|map| {
        let weight = weight(map, asker.receiver.normal);
        if weight == 0 {
            return 0.0;
        }
        let way = scale(map.direction, f64::from(weight.signum()));
        let steps = around.closest(way).map(|(steps, _)| steps);
        f64::from(weight.unsigned_abs()) * passes(run.setup.falloff, steps)
    });
    parts.sum::<f64>() * 2.0 / f64::from(directions) / f64::from(1_u32 << WEIGHT_BITS)
}

/// The mean of random rays, as likely as the cosine with the normal, and the variance of that
/// mean. A ray is the normal and a point of the unit sphere.
fn at_random(
    run: &LdmRun,
    asker: &Asker,
    (from, around): (&From, &Around),
    seed: u64,
) -> (f64, f64) {
    let mut random = Random::new(seed.wrapping_mul(1 << 32).wrapping_add(asker.pixel.into()));
    let (mut sum, mut squares) = (0.0, 0.0);
    for _ in 0..SAMPLES {
        let up = random.signed();
        let (sin, cos) = libm::sincos(TAU * random.unit());
        let out = libm::sqrt(1.0 - up * up);
        let way = normalize(add(from.normal, [out * cos, out * sin, up]));
        let steps = around.closest(way).map(|(steps, _)| steps);
        let part = passes(run.setup.falloff, steps);
        sum += part;
        squares += part * part;
    }
    let count = f64::from(SAMPLES);
    let mean = sum / count;
    let variance = (squares / count - mean * mean).max(0.0) / (count - 1.0);
    (mean, variance)
}
