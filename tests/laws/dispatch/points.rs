//! Points that rays meet, and directions into which mirrors send them, from their definitions.

use proptest::prelude::*;
use triptych_spec::dispatch::{
    Carried, Met, OFFSET, WEIGHT_ONE, intersect, locate, mirrored, reflect, units, weighted,
};
use triptych_spec::grid::lattice::Point;
use triptych_spec::rsm::Face;

use super::extremes::aimed;
use super::worlds::place;
use crate::config;

fn wide(p: Point) -> [i128; 3] {
    p.map(i128::from)
}

fn dot(a: [i128; 3], b: [i128; 3]) -> i128 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn minus(a: Point, b: Point) -> [i128; 3] {
    [0, 1, 2].map(|i| i128::from(a[i]) - i128::from(b[i]))
}

/// The cross product of two edges.
fn normal([a, b, c]: [Point; 3]) -> [i128; 3] {
    let (u, v) = (minus(b, a), minus(c, a));
    let part = |j: usize, k: usize| u[j] * v[k] - u[k] * v[j];
    [part(1, 2), part(2, 0), part(0, 1)]
}

/// Any, and such as have products that end in halves.
fn weights() -> impl Strategy<Value = [u32; 3]> {
    let weight = || prop_oneof![0..=WEIGHT_ONE, (0..=256_u32).prop_map(|w| w * 128)];
    [weight(), weight(), weight()]
}

fn unit(v: [f64; 3]) -> [f64; 3] {
    let length = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
    v.map(|c| c / length)
}

fn cosine(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

proptest! {
    #![proptest_config(config(512))]

    /// The nearest point of the lattice, in the triangle's box before it is moved, and then in
    /// front of the face on the side that the ray comes from.
    #[test]
    fn points_are_where_rays_meet_triangles((scene, rays) in aimed()) {
        for ray in &rays {
            let Met::Triangle(triangle) = intersect(&scene.tracer(), ray) else { continue };
            let corners = scene.world.model.corners(triangle);
            let surface = locate(&scene.world, ray.way, triangle);
            let n = normal(corners);
            prop_assert_eq!(dot(n, wide(ray.way.direction)).signum(), -i128::from(surface.side));
            prop_assert!(dot(n, minus(surface.point, corners[0])) * i128::from(surface.side) > 0);
            let longest = n.iter().map(|c| c.abs()).max().unwrap();
            let axis = n.iter().position(|c| c.abs() == longest).unwrap();
            let mut point = surface.point;
            let step = i32::try_from(n[axis].signum()).unwrap() * surface.side;
            point[axis] -= step * OFFSET.cast_signed();
            let facing = dot(n, wide(ray.way.direction));
            let height = dot(n, minus(corners[0], ray.way.origin)) * facing.signum();
            let facing = facing.abs();
            for i in 0..3 {
                let sides = corners.map(|corner| corner[i]);
                prop_assert!(sides.iter().min().unwrap() <= &point[i]);
                prop_assert!(&point[i] <= sides.iter().max().unwrap());
                // Within half a step of the exact point; halves go up.
                let way = i128::from(point[i] - ray.way.origin[i]) * facing;
                let off = 2 * (way - i128::from(ray.way.direction[i]) * height);
                prop_assert!(-facing < off && off <= facing, "{} of {}", off, facing);
            }
        }
    }

    /// Where the true normal mirrors a direction to, but for what 14 bits of it and 23 of the
    /// result may be off.
    #[test]
    fn mirrors_are_tilted_no_more_than_stated(corners in [place(1 << 20), place(1 << 20), place(1 << 20)], d in place(1 << 24)) {
        let face = Face::new(corners);
        prop_assume!(face.coarse != [0; 3] && d != [0; 3]);
        let n = unit(face.normal.map(|c| c as f64));
        let way = d.map(f64::from);
        let along = cosine(n, way);
        let expected = unit([0, 1, 2].map(|i| way[i] - 2.0 * along * n[i]));
        let made = mirrored(face.coarse, d);
        let longest = made.iter().map(|c| c.abs()).max().unwrap();
        prop_assert!(longest <= 1 << 23);
        let made = unit(made.map(f64::from));
        let apart = unit_apart(made, expected);
        let tilt = 2.0 * 3.0_f64.sqrt() / f64::from(1 << 15);
        let rounding = 3.0_f64.sqrt() / f64::from(1 << 22);
        prop_assert!(apart <= tilt + rounding, "{} over {}", apart, tilt + rounding);
    }

    /// Mirror rays start where the ray was seen, leave to that side, and are weaker by what the mirror
    /// keeps; those that are missing have a reason.
    #[test]
    fn mirror_rays_leave((scene, rays) in aimed()) {
        for ray in &rays {
            let Met::Triangle(triangle) = intersect(&scene.tracer(), ray) else { continue };
            let surface = locate(&scene.world, ray.way, triangle);
            let (mirror, Carried::Weight(weight)) = (scene.world.mirrors[triangle as usize], ray.carried) else {
                unreachable!("rays here carry weights");
            };
            let n = normal(scene.world.model.corners(triangle));
            let weight = weighted(weight, mirror);
            match reflect(&scene.world, ray, &surface) {
                Some(sent) => {
                    prop_assert_eq!((sent.pixel, sent.depth), (ray.pixel, ray.depth + 1));
                    prop_assert!(sent.depth <= scene.world.depth);
                    prop_assert_eq!(sent.carried, Carried::Weight(weight));
                    prop_assert_eq!(sent.way.origin, surface.point);
                    prop_assert!(dot(n, wide(sent.way.direction)) * i128::from(surface.side) > 0);
                }
                None if weight == [0; 3] || ray.depth >= scene.world.depth => {}
                None => {
                    // So flat that the tilt of the mirror may have led through it.
                    let way = unit(ray.way.direction.map(f64::from));
                    let flat = cosine(unit(n.map(|c| c as f64)), way).abs();
                    prop_assert!(flat <= 1.1e-4 + 1e-6, "{}", flat);
                }
            }
        }
    }

    /// A mirror direction is rounded once, to 23 bits, halves up.
    #[test]
    fn mirror_directions_are_rounded_once(corners in [place(1 << 20), place(1 << 20), place(1 << 20)], d in place(1 << 24)) {
        let coarse = Face::new(corners).coarse;
        prop_assume!(coarse != [0; 3] && d != [0; 3]);
        let made = mirrored(coarse, d);
        let (n, d) = (wide(coarse), wide(d));
        let exact = [0, 1, 2].map(|i| dot(n, n) * d[i] - 2 * dot(n, d) * n[i]);
        let longest = exact.iter().map(|c| c.abs()).max().unwrap();
        let mut unit = 1;
        while unit << 23 <= longest {
            unit *= 2;
        }
        for (made, exact) in made.into_iter().zip(exact) {
            let off = 2 * (i128::from(made) * unit - exact);
            prop_assert!(-unit < off && off <= unit, "{} of {}", off, unit);
        }
    }

    #[test]
    fn weights_are_rounded_once(a in weights(), b in weights()) {
        prop_assert_eq!(weighted(a, [WEIGHT_ONE; 3]), a);
        prop_assert_eq!(weighted(a, b), weighted(b, a));
        for (w, (a, b)) in weighted(a, b).into_iter().zip(a.into_iter().zip(b)) {
            let exact = f64::from(a) * f64::from(b) / f64::from(WEIGHT_ONE);
            let off = f64::from(w) - exact;
            prop_assert!(-0.5 < off && off <= 0.5);
            prop_assert!(w <= a.min(b));
        }
    }

    /// Any number up to the most that a lamp may give.
    #[test]
    fn light_is_rounded_to_the_nearest_unit(bits in 0..=1_048_576.0_f32.to_bits()) {
        let light = f32::from_bits(bits);
        let exact = f64::from(light) * f64::from(1 << 24);
        let off = units(light) as f64 - exact;
        prop_assert!(-0.5 < off && off <= 0.5, "{} units off {}", off, light);
    }
}

/// The length of the difference.
fn unit_apart(a: [f64; 3], b: [f64; 3]) -> f64 {
    let d: [f64; 3] = [0, 1, 2].map(|i| a[i] - b[i]);
    cosine(d, d).sqrt()
}
