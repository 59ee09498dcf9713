//! Pictures, which depend neither on the order of tasks nor on how rays are searched, where the
//! world is, or in which order its triangles are.

use std::collections::BTreeSet;

use proptest::prelude::*;
use triptych_spec::camera::Camera;
use triptych_spec::dispatch::{Lamp, Ray, Shot, Sums, Tracer, deposit, follow, primary, render};
use triptych_spec::grid::Blockers;
use triptych_spec::grid::exact::Time;
use triptych_spec::grid::hit::crossing;
use triptych_spec::grid::lattice::{EXTENT, Point};
use triptych_spec::grid::ray::Ray as Way;

use super::adapters::deposited;
use super::worlds::{Plain, place};
use super::{Scene, plains, scenes};
use crate::config;

/// Looks at every triangle.
struct All<'a>(&'a Blockers);

impl All<'_> {
    fn met(&self, way: Way) -> Vec<(Time, u32)> {
        let rows = (0..).take(self.0.triangles.len());
        let met = |row: u32| Some((crossing(&way, self.0.corners(row))?, row));
        rows.filter_map(met).collect()
    }
}

impl Tracer for All<'_> {
    fn closest(&self, way: Way) -> Option<u32> {
        let first = self.met(way).into_iter().min()?;
        way.moves().then_some(first.1)
    }
    fn blocked(&self, way: Way) -> bool {
        self.closest(way).is_some()
    }
}

/// A frame whose next ray is whichever `take` says of those that are left.
fn in_order(scene: &Scene, mut take: impl FnMut(usize) -> usize) -> Sums {
    let mut sums = Sums::new(scene.world.eye.size);
    let mut left: Vec<Ray> = primary(&scene.world.eye).collect();
    while !left.is_empty() {
        let ray = left.swap_remove(take(left.len()));
        if let Shot::Light(light) = follow(&scene.world, &scene.tracer(), &ray, &mut left) {
            deposit(&mut sums, ray.pixel, light);
        }
    }
    sums
}

/// Whether two triangles are first on some ray's way at one time, so that their order decides.
fn ties(scene: &Scene) -> bool {
    let all = All(&scene.world.blockers);
    let tied = |ray: &Ray| {
        let met = all.met(ray.way);
        let first = met.iter().map(|(time, _)| *time).min();
        met.iter().filter(|(time, _)| Some(*time) == first).count() > 1
    };
    scene
        .bounces()
        .iter()
        .any(|bounce| bounce.rays.iter().any(tied))
}

/// How far worlds are moved at most.
const BY: i32 = 4096;

/// The same, but for what is too near the lattice's border to be moved.
fn inner(mut plain: Plain) -> Plain {
    let most = EXTENT - BY;
    let kept = |p: Point| p.map(|c| c.clamp(-most, most));
    plain.triangles = plain.triangles.iter().map(|t| t.map(kept)).collect();
    plain
        .lamps
        .iter_mut()
        .for_each(|lamp| lamp.position = kept(lamp.position));
    plain.camera.eye = plain
        .camera
        .eye
        .map(|c| c.clamp(-f64::from(most), f64::from(most)));
    plain
}

fn moved(plain: &Plain, by: Point) -> Plain {
    let point = |p: Point| [0, 1, 2].map(|i| p[i] + by[i]);
    let real = |p: [f64; 3]| [0, 1, 2].map(|i| p[i] + f64::from(by[i]));
    let lamp = |lamp: &Lamp| Lamp {
        position: point(lamp.position),
        ..*lamp
    };
    Plain {
        triangles: plain.triangles.iter().map(|t| t.map(point)).collect(),
        lamps: plain.lamps.iter().map(lamp).collect(),
        camera: Camera {
            eye: real(plain.camera.eye),
            target: real(plain.camera.target),
            ..plain.camera
        },
        ..plain.clone()
    }
}

proptest! {
    #![proptest_config(config(64))]

    #[test]
    fn no_order_of_tasks_matters(scene in scenes(), seed in any::<usize>()) {
        let expected = render(&scene.world, &scene.tracer());
        prop_assert_eq!(&in_order(&scene, |left| left - 1), &expected);
        let mut state = seed;
        let any = |left: usize| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (state >> 33) % left
        };
        prop_assert_eq!(&in_order(&scene, any), &expected);
        let mut sums = Sums::new(scene.world.eye.size);
        for bounce in scene.bounces() {
            let shadows: Vec<Ray> = bounce.shadows.iter().map(|(ray, _)| *ray).collect();
            deposited(&scene, &bounce.rays, &bounce.met, &mut sums);
            deposited(&scene, &shadows, &bounce.blocked, &mut sums);
        }
        prop_assert_eq!(&sums, &expected);
    }

    #[test]
    fn no_way_of_searching_matters(scene in scenes()) {
        let all = All(&scene.world.blockers);
        prop_assert_eq!(render(&scene.world, &all), render(&scene.world, &scene.tracer()));
    }

    #[test]
    fn worlds_may_be_moved(plain in plains(), by in place(BY)) {
        let plain = inner(plain);
        let (Some(scene), Some(other)) = (plain.scene(), moved(&plain, by).scene()) else {
            return Ok(());
        };
        let pictures = [&scene, &other].map(|scene| render(&scene.world, &scene.tracer()));
        prop_assert_eq!(&pictures[0], &pictures[1]);
    }

    #[test]
    fn no_order_of_triangles_matters(plain in plains()) {
        let mut turned = plain.clone();
        turned.triangles.reverse();
        turned.materials.reverse();
        let (Some(scene), Some(other)) = (plain.scene(), turned.scene()) else {
            return Ok(());
        };
        prop_assume!(!ties(&scene));
        let pictures = [&scene, &other].map(|scene| render(&scene.world, &scene.tracer()));
        prop_assert_eq!(&pictures[0], &pictures[1]);
    }

    /// A pixel has one ray a bounce, and no more bounces than mirrors and one.
    #[test]
    fn rays_are_as_few_as_they_may_be(scene in scenes()) {
        let bounces = scene.bounces();
        prop_assert!(bounces.len() <= scene.world.depth as usize + 1);
        for bounce in bounces {
            let pixels: BTreeSet<u32> = bounce.rays.iter().map(|ray| ray.pixel).collect();
            prop_assert_eq!(pixels.len(), bounce.rays.len());
            prop_assert!(bounce.shadows.len() <= bounce.rays.len() * scene.world.lamps.len());
        }
    }
}
