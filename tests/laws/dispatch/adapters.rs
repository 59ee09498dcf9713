//! Random worlds on every adapter, with words and with native integers: each stage from the
//! spec's input gives its rays to the bit, and light within its bounds; so do whole frames.

use proptest::prelude::*;
use triptych_gpu::dispatch::{Appended, Frame, Overflow, Room, Stages, Timed};
use triptych_gpu::grid::Shape;
use triptych_gpu::timer::{Clock, Timer};
use triptych_spec::bound::Bounded;
use triptych_spec::dispatch::{Carried, Met, Ray, Sums, UNIT_BITS, deposit, primary};
use triptych_spec::rsm::Colour;

use super::{Bounce, Scene, scenes};
use crate::adapters::devices;
use crate::config;

pub type Verdict = Result<(), TestCaseError>;

const ZERO: Bounded = Bounded {
    value: 0.0,
    bound: 0.0,
};

/// What tells a ray of a bounce from the others: its pixel, and where it goes.
fn key(ray: &Ray) -> (u32, [i32; 3], [i32; 3]) {
    (ray.pixel, ray.way.origin, ray.way.direction)
}

fn sorted(rays: &[Ray]) -> Vec<Ray> {
    let mut rays = rays.to_vec();
    rays.sort_by_key(key);
    rays
}

/// The same rays, whose light is within its bounds.
fn lit(expected: &[(Ray, Colour)], observed: &[Ray]) -> Verdict {
    let mut expected: Vec<&(Ray, Colour)> = expected.iter().collect();
    expected.sort_by_key(|(ray, _)| key(ray));
    prop_assert_eq!(expected.len(), observed.len());
    for ((ray, light), observed) in expected.into_iter().zip(sorted(observed)) {
        let plain = |ray: &Ray| (ray.way, ray.pixel, ray.depth);
        prop_assert_eq!(plain(ray), plain(&observed));
        let Carried::Light(brought) = observed.carried else {
            return Err(TestCaseError::fail("a ray to a lamp carries light"));
        };
        for (light, brought) in light.iter().zip(brought) {
            prop_assert!(
                light.admits(f64::from(brought)),
                "{} for {:?}",
                brought,
                light
            );
        }
    }
    Ok(())
}

/// What rays that met nothing bring, by the spec.
pub fn deposited(scene: &Scene, rays: &[Ray], met: &[Met], sums: &mut Sums) {
    for (ray, met) in rays.iter().zip(met) {
        if *met != Met::Nothing {
            continue;
        }
        let light = match ray.carried {
            Carried::Light(light) => light,
            Carried::Weight(weight) => [0, 1, 2].map(|i| {
                let part = f64::from(weight[i]) / 32768.0;
                #[expect(clippy::cast_possible_truncation, reason = "rounding is meant")]
                let light = (f64::from(scene.world.background[i]) * part) as f32;
                light
            }),
        };
        deposit(sums, ray.pixel, light);
    }
}

fn rays_of(shadows: &[(Ray, Colour)]) -> Vec<Ray> {
    shadows.iter().map(|(ray, _)| *ray).collect()
}

/// Each stage from the spec's input.
pub fn agrees(scene: &Scene, bounce: &Bounce, stages: &mut Stages) -> Verdict {
    let shadows = rays_of(&bounce.shadows);
    let both = [&bounce.rays[..], &shadows].concat();
    let met = [&bounce.met[..], &bounce.blocked].concat();
    prop_assert_eq!(&stages.intersect(&both).unwrap(), &met);
    let seen = stages.locate(&bounce.rays, &bounce.met).unwrap();
    prop_assert_eq!(&seen, &bounce.seen);
    for capacity in [None, Some(1)] {
        let lights = stages.light(&bounce.rays, &seen, capacity).unwrap();
        lit(&bounce.shadows, &lights.rays)?;
        let room = capacity.unwrap_or_else(|| u32::try_from(bounce.rays.len()).unwrap());
        overflowed(&lights, room)?;
        let mirrors = stages.reflect(&bounce.rays, &seen, capacity).unwrap();
        prop_assert_eq!(sorted(&mirrors.rays), sorted(&bounce.mirrors));
        overflowed(&mirrors, room)?;
    }
    let mut sums = Sums::new(scene.world.eye.size);
    deposited(scene, &both, &met, &mut sums);
    prop_assert_eq!(stages.deposit(&both, &met).unwrap(), sums);
    Ok(())
}

/// With too little room, some of all rays are stored, and all are counted.
fn overflowed(appended: &Appended, room: u32) -> Verdict {
    let all = appended.rays.len();
    prop_assert_eq!(appended.overflows.len(), usize::from(all > room as usize));
    for Overflow {
        capacity,
        attempts,
        rays,
        ..
    } in &appended.overflows
    {
        prop_assert_eq!((*attempts as usize, *capacity), (all, room));
        prop_assert_eq!(rays.len(), room as usize);
        prop_assert!(rays.iter().all(|ray| appended.rays.contains(ray)));
    }
    Ok(())
}

/// A picture of a frame's own rays to the bit, and within the spec's bounds.
pub fn follows(scene: &Scene, expected: &[Bounce], frame: &Frame) -> Verdict {
    prop_assert_eq!(expected.len(), frame.bounces.len());
    let size = scene.world.eye.size;
    let mut sums = Sums::new(size);
    let mut bounds = vec![[ZERO; 3]; size.pixels()];
    for (expected, made) in expected.iter().zip(&frame.bounces) {
        prop_assert_eq!(sorted(&made.rays), sorted(&expected.rays));
        lit(&expected.shadows, &made.shadows.rays)?;
        let bounce = scene.bounce(made.rays.clone());
        prop_assert_eq!(&made.met, &bounce.met);
        prop_assert_eq!(&made.seen, &bounce.seen);
        let blocked = made.shadows.rays.iter();
        let blocked: Vec<Met> = blocked
            .map(|ray| triptych_spec::dispatch::intersect(&scene.tracer(), ray))
            .collect();
        prop_assert_eq!(&made.blocked, &blocked);
        deposited(scene, &made.rays, &made.met, &mut sums);
        deposited(scene, &made.shadows.rays, &made.blocked, &mut sums);
        bound(scene, expected, &mut bounds);
    }
    prop_assert_eq!(&frame.sums, &sums);
    for (pixel, bounds) in bounds.iter().enumerate() {
        for (bound, light) in bounds.iter().zip(sums.light(pixel)) {
            prop_assert!(
                bound.admits(light),
                "pixel {}: {} for {:?}",
                pixel,
                light,
                bound
            );
        }
    }
    Ok(())
}

/// Adds what a bounce brings to each pixel, with half a unit for rounding.
fn bound(scene: &Scene, bounce: &Bounce, bounds: &mut [[Bounded; 3]]) {
    let half = f64::from(1_u32 << (UNIT_BITS + 1)).recip();
    let mut add = |pixel: u32, light: [Bounded; 3]| {
        for (sum, light) in bounds[pixel as usize].iter_mut().zip(light) {
            sum.value += light.value;
            sum.bound += light.bound + half;
        }
    };
    for ((ray, light), met) in bounce.shadows.iter().zip(&bounce.blocked) {
        if *met == Met::Nothing {
            add(ray.pixel, *light);
        }
    }
    for (ray, met) in bounce.rays.iter().zip(&bounce.met) {
        if let (Met::Nothing, Carried::Weight(weight)) = (met, ray.carried) {
            add(
                ray.pixel,
                [0, 1, 2].map(|i| {
                    let part = f64::from(weight[i]) / 32768.0;
                    Bounded::once(f64::from(scene.world.background[i]) * part)
                }),
            );
        }
    }
}

proptest! {
    #![proptest_config(config(48))]

    #[test]
    fn random_stages(scene in scenes()) {
        let bounces = scene.bounces();
        for (gpu, kernels) in devices() {
            for kernels in kernels {
                let mut stages = Stages::new(gpu, kernels, &scene.world, &scene.grid).unwrap();
                let rays: Vec<Ray> = primary(&scene.world.eye).collect();
                prop_assert_eq!(stages.primary().unwrap(), rays);
                for bounce in &bounces {
                    agrees(&scene, bounce, &mut stages)?;
                }
            }
        }
    }

    #[test]
    fn whole_frames(scene in scenes(), tight in any::<bool>()) {
        let bounces = scene.bounces();
        let room = match tight {
            true => Room { pixels: Some(7), shadows: Some(2), mirrors: Some(1) },
            false => Room::default(),
        };
        for (gpu, kernels) in devices() {
            for kernels in kernels {
                let mut stages = Stages::new(gpu, kernels, &scene.world, &scene.grid).unwrap();
                let frame = stages.frame(room).unwrap();
                follows(&scene, &bounces, &frame)?;
                let axes = &scene.grid.axes;
let shape = Shape::checked(gpu, kernels, &scene.world.blockers, axes).unwrap();
let cells = shape.map(|shape| (axes, shape));
                let timed = Timed::new(gpu, kernels, &scene.world, cells, &frame.batches).unwrap();
                let timer = Timer::new(gpu, &Clock::Host(String::new()), 1).unwrap();
                // What a frame leaves does not change the next.
                for _ in 0..2 {
                    timed.time_whole(&timer).unwrap();
                    prop_assert_eq!(&timed.sums().unwrap(), &frame.sums);
                    let counts = bounces.iter().map(|b| [b.rays.len(), b.shadows.len()]);
                    let counts: Vec<_> = counts.map(|c| c.map(|c| c as u64)).collect();
                    prop_assert_eq!(timed.rays().unwrap(), counts);
                }
            }
        }
    }
}
