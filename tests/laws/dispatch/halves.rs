//! Points whose coordinates end in halves, or so near to them that `f32` cannot tell: a kernel's
//! quotients must be corrected there, in either direction.

use proptest::prelude::*;
use triptych_gpu::dispatch::Stages;
use triptych_spec::dispatch::{Carried, Lamp, Met, Ray, WEIGHT_ONE, intersect, light, locate};
use triptych_spec::grid::exact::{minus, triple};
use triptych_spec::grid::lattice::{EXTENT, Point};
use triptych_spec::grid::ray::Ray as Way;

use super::adapters::Verdict;
use super::worlds::{alone, place};
use crate::adapters::devices;
use crate::config;

/// What a kernel makes of rays that each meet the one triangle that there is.
fn located(triangle: [Point; 3], ways: &[Way]) -> Verdict {
    let scene = alone(vec![triangle]);
    let ray = |(pixel, way): (u32, &Way)| Ray {
        way: *way,
        pixel,
        depth: 0,
        carried: Carried::Weight([WEIGHT_ONE; 3]),
    };
    let rays: Vec<Ray> = (0..).zip(ways).map(ray).collect();
    let met: Vec<Met> = rays.iter().map(|r| intersect(&scene.tracer(), r)).collect();
    prop_assert!(met.iter().all(|met| *met == Met::Triangle(0)));
    let seen = rays
        .iter()
        .map(|ray| Some(locate(&scene.world, ray.way, 0)));
    let seen: Vec<_> = seen.collect();
    for (gpu, kernels) in devices() {
        for kernels in kernels {
            let mut stages = Stages::new(gpu, kernels, &scene.world, &scene.grid).unwrap();
            prop_assert_eq!(&stages.locate(&rays, &met).unwrap(), &seen, "{}", gpu.name);
        }
    }
    Ok(())
}

fn way(origin: Point, direction: Point) -> Way {
    Way {
        origin,
        direction,
        segment: false,
    }
}

proptest! {
    #![proptest_config(config(192))]

    /// A ray across the lattice meets an edge halfway between its ends, after some steps and a half,
    /// each as long as its direction.
    #[test]
    fn halves_go_up(o in place(1 << 23), k in 1..16_i32, less in 10..100_i32, v in place(1 << 15), c in place(1 << 22)) {
        let end = o.map(|c| -(c - c / less));
        let d = [0, 1, 2].map(|i| (2 * (end[i] - o[i]) / (2 * k + 1)) | 1);
        let twice = [0, 1, 2].map(|i| 2 * o[i] + d[i] * (2 * k + 1));
        let a = [0, 1, 2].map(|i| twice[i] / 2 + v[i]);
        let b = [0, 1, 2].map(|i| twice[i] - a[i]);
        prop_assume!([a, b].iter().flatten().all(|c| c.abs() <= EXTENT));
        let faces = triple(d, minus(b, a), minus(c, a)) != 0;
        prop_assume!(faces);
        located([a, b, c], &[way(o, d)])?;
    }

    /// A plane whose normal hardly leans to z: a step along z moves a point by a small part of 2^-24.
    #[test]
    fn what_is_nearly_half_is_told(at in place(1 << 20), e in (1 << 8..1 << 9_i32, 1 << 10..1 << 12_i32), far in 1 << 20..1 << 22_i32, near in -128..128_i32, lean in prop::sample::select(vec![-1, 1]), flip in prop::sample::select(vec![-1, 1])) {
        let e = [e.0 | 1, e.1 | 1, 0];
        let g = [lean, 0, 1 << 21];
        let plus = |p: Point, v: Point| [0, 1, 2].map(|i| p[i] + flip * v[i]);
        let way_in = [near, far, 17];
        let origin = plus(at, way_in.map(|c| -c));
        let direction = [0, 1, 2].map(|i| flip * (2 * way_in[i] + e[i] + i32::from(i == 2)));
        located([at, plus(at, e), plus(at, g)], &[way(origin, direction)])?;
    }

    /// A lamp that is as far off a face's plane as a point of the face is, across the lattice: whether
    /// it faces the lamp is told by integers alone.
    #[test]
    fn lamps_in_a_plane_are_told(corners in [place(EXTENT - 4), place(EXTENT - 4), place(EXTENT - 4)], from in place(1 << 23), by in -1..=1_i32) {
        let [a, b, c] = corners;
        let inside = [0, 1, 2].map(|i| a[i] - a[i] / 8 + b[i] / 16 + c[i] / 16);
        let direction = minus(inside, from);
        let mut scene = alone(vec![corners]);
        let ray = Ray {
            way: way(from, direction),
            pixel: 0,
            depth: 0,
            carried: Carried::Weight([WEIGHT_ONE; 3]),
        };
        prop_assume!(intersect(&scene.tracer(), &ray) == Met::Triangle(0));
        let seen = locate(&scene.world, ray.way, 0);
        let face = *scene.world.model.face(0);
        let axis = face.axis();
        for mut position in [b, c, [0, 1, 2].map(|i| i32::midpoint(b[i], c[i]))] {
            let up = i32::try_from(face.normal[axis].signum()).unwrap() * seen.side;
            position[axis] += up * (2 + by);
            scene.world.lamps.push(Lamp::new(position, [1.0; 3], 1 << 20, 1 << 20).unwrap());
        }
        let expected = light(&scene.world, &ray, &seen).count();
        for (gpu, kernels) in devices() {
            for kernels in kernels {
                let mut stages = Stages::new(gpu, kernels, &scene.world, &scene.grid).unwrap();
                let lights = stages.light(&[ray], &[Some(seen)], None).unwrap();
                prop_assert_eq!(lights.rays.len(), expected, "{}", gpu.name);
            }
        }
    }
}
