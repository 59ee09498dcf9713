//! Rays that no eye sends: grazing ones, from corners and from within triangles, across all of the
//! lattice. Every stage must decide as the spec does.

use proptest::prelude::*;
use triptych_gpu::dispatch::Stages;
use triptych_spec::dispatch::{Carried, Ray, WEIGHT_ONE};
use triptych_spec::grid::lattice::{Point, REACH};
use triptych_spec::grid::ray::Ray as Way;
use triptych_spec::scene::Size;

use super::Scene;
use super::adapters::agrees;
use super::worlds::{place, plains};
use crate::adapters::devices;
use crate::config;

const SIZE: Size = Size {
    width: 4,
    height: 4,
};

fn weight() -> impl Strategy<Value = u32> {
    prop_oneof![Just(0), Just(1), Just(WEIGHT_ONE), 0..=WEIGHT_ONE]
}

/// A place worth starting at or aiming at.
fn point(corners: Vec<[Point; 3]>) -> BoxedStrategy<Point> {
    let corner = (prop::sample::select(corners.clone()), 0..3_usize).prop_map(|(t, i)| t[i]);
    let beside = (corner.clone(), place(2)).prop_map(|(p, by)| [0, 1, 2].map(|i| p[i] + by[i]));
    let within = (prop::sample::select(corners), 0..=16_i64, 0..=16_i64).prop_map(|(t, u, v)| {
        let (u, v) = if u + v > 16 { (16 - u, 16 - v) } else { (u, v) };
        [0, 1, 2].map(|i| {
            let [a, b, c] = t.map(|p| i64::from(p[i]));
            i32::try_from(a + ((b - a) * u + (c - a) * v) / 16).unwrap()
        })
    });
    prop_oneof![2 => corner, 2 => beside, 4 => within, 2 => place(REACH)].boxed()
}

fn ray(corners: &[[Point; 3]]) -> impl Strategy<Value = Ray> + use<> {
    let [from, to, other] = [0; 3].map(|_| point(corners.to_vec()));
    // Halfway between two points, where coordinates end in halves.
    let halfway = prop_oneof![1 => Just(false), 1 => Just(true)];
    // Directions of few bits are as good as long ones.
    let coarser = prop_oneof![3 => Just(0_u32), 1 => 0..20_u32];
    let ends = (from, to, other, halfway);
    (ends, coarser, 0..8_u32, [weight(), weight(), weight()]).prop_map(
        |((from, to, other, halfway), coarser, depth, weight)| {
            let mut direction = [0, 1, 2].map(|i| (to[i] - from[i]) >> coarser);
            let twice = [0, 1, 2].map(|i| to[i] + other[i] - 2 * from[i]);
            if halfway && twice.iter().all(|c| c.abs() <= 2 * REACH) {
                direction = twice;
            }
            Ray {
                way: Way {
                    origin: from,
                    direction,
                    segment: false,
                },
                pixel: 0,
                depth,
                carried: Carried::Weight(weight),
            }
        },
    )
}

/// A world, and rays with a pixel of their own each.
pub fn aimed() -> impl Strategy<Value = (Scene, Vec<Ray>)> {
    let plain = plains().prop_filter_map("the camera has no picture", |mut plain| {
        plain.size = SIZE;
        Some((plain.scene()?, plain))
    });
    plain.prop_flat_map(|(scene, plain)| {
        let rays = prop::collection::vec(ray(&plain.triangles), SIZE.pixels());
        (Just(scene), rays).prop_map(|(scene, mut rays)| {
            for (pixel, ray) in (0..).zip(&mut rays) {
                ray.pixel = pixel;
            }
            (scene, rays)
        })
    })
}

proptest! {
    #![proptest_config(config(96))]

    #[test]
    fn any_ray((scene, rays) in aimed()) {
        let bounce = scene.bounce(rays);
        for (gpu, kernels) in devices() {
            for kernels in kernels {
                let mut stages = Stages::new(gpu, kernels, &scene.world, &scene.grid).unwrap();
                agrees(&scene, &bounce, &mut stages)?;
            }
        }
    }
}
