//! What is blocked.

use proptest::prelude::*;
use triptych_spec::bound::{Bounded, U};
use triptych_spec::grid::hit::crossing;
use triptych_spec::grid::ray::Ray;
use triptych_spec::rsm::{Colour, DARK, Frame, Light, Place};

use super::{Scene, agree, facing, given, scenes, worlds};
use crate::config;

/// The pixel of the picture that a pixel of buffer B is.
fn fine(scene: &Scene, pixel: usize) -> usize {
    let [width, eye] = [scene.parameters.coarse(scene.eye.size), scene.eye.size].map(|s| s.width);
    let (width, eye, divisor) = (
        width as usize,
        eye as usize,
        scene.parameters.divisor as usize,
    );
    pixel / width * divisor * eye + pixel % width * divisor
}

/// What free and blocked texels give a pixel, how many rays that took, and which are blocked.
fn brute(
    scene: &Scene,
    frame: &Frame,
    lights: &[Option<Light>],
    at: usize,
) -> ([[f64; 3]; 2], u64, Vec<usize>) {
    let (mut sums, mut rays, mut bits) = ([[0.0; 3]; 2], 0, Vec::new());
    let (Some(surface), Some(place)) = (frame.seen.surfaces[at], frame.places[at]) else {
        return (sums, rays, bits);
    };
    for (number, texel) in scene.kernel(place.texel) {
        let Some(light) = lights[texel] else {
            continue;
        };
        let (from, to) = (surface.point, light.surface.point);
        if !facing(&scene.model, &surface, to) || !facing(&scene.model, &light.surface, from) {
            continue;
        }
        rays += 1;
        let ray = Ray::between(from, to);
        let all = 0..u32::try_from(scene.blockers.triangles.len()).unwrap();
        let blocked = all
            .into_iter()
            .any(|t| crossing(&ray, scene.blockers.corners(t)).is_some());
        if blocked {
            bits.push(number);
        }
        let factor = given(
            &scene.model,
            &surface,
            &light.surface,
            scene.parameters.clamp,
        );
        for (sum, c) in sums[usize::from(blocked)].iter_mut().zip(light.intensity) {
            *sum += factor * f64::from(c);
        }
    }
    (sums, rays, bits)
}

proptest! {
    #![proptest_config(config(300))]

    /// Exactly those texels are blocked that a search of all blockers finds, as many rays
    /// are asked for as texels and pixels face each other, and A - B is what the others
    /// give.
    #[test]
    fn brute_force(scene in scenes()) {
        let frame = scene.frame();
        let lights = frame.rsm.lights();
        let side = scene.parameters.side() as usize;
        let mut total = 0;
        for pixel in 0..frame.blocked.size.pixels() {
            let at = fine(&scene, pixel);
            let ([free, blocked], rays, bits) = brute(&scene, &frame, &lights, at);
            let set: Vec<usize> = (0..side * side).filter(|n| frame.blocked.is_blocked(pixel, *n)).collect();
            prop_assert_eq!(set, bits);
            total += rays;
            for i in 0..3 {
                let (all, b) = (frame.all[at][i], frame.blocked.light[pixel][i]);
                let room = 1e-13 * (free[i] + blocked[i]);
                prop_assert!((b.value - blocked[i]).abs() <= room);
                prop_assert!((all.value - b.value - free[i]).abs() <= room);
                prop_assert!(all.value >= b.value, "before the blur nothing is negative");
                prop_assert!(all.bound >= b.bound);
            }
        }
        prop_assert_eq!(frame.blocked.rays, total);
    }

    /// Every texel's light is in A or not in the kernel, at every pixel.
    #[test]
    fn all_pixels(scene in scenes()) {
        let frame = scene.frame();
        let lights = frame.rsm.lights();
        for (at, all) in frame.all.iter().enumerate() {
            let ([free, blocked], ..) = brute(&scene, &frame, &lights, at);
            let sum = [0, 1, 2].map(|i| Bounded { value: free[i] + blocked[i], bound: 0.0 });
            prop_assert!(agree(all, &sum));
        }
    }

    /// Without blockers no ray is asked for, B is dark, and the picture is the one without
    /// shadows of indirect light.
    #[test]
    fn nothing_blocks(scene in scenes()) {
        let scene = scene.with(Vec::new());
        let frame = scene.frame();
        prop_assert_eq!(frame.blocked.rays, 0);
        prop_assert!(frame.blocked.bits.iter().all(|word| *word == 0));
        prop_assert!(frame.blocked.light.iter().chain(&frame.blurred).all(|c| *c == DARK));
        for (pixel, surface) in frame.seen.surfaces.iter().enumerate() {
            let colour = surface.map(|s| scene.model.colours[s.triangle as usize]);
            for i in 0..3 {
                let light = frame.direct.light[pixel][i].value + frame.all[pixel][i].value;
                let expected = match colour {
                    Some(colour) => light * f64::from(colour[i]),
                    None => [0.25, 0.5, 0.75][i],
                };
                prop_assert_eq!(frame.picture[pixel][i].value, expected);
            }
        }
    }

    /// A blocker right before a texel's surface, as large as its plane in the scene, blocks
    /// whatever the surface would light.
    #[test]
    fn walled_in(mut world in worlds()) {
        // The wall is the only light, a step of the world behind the blockers.
        let [l, h] = [-2 * super::R, 2 * super::R];
        let z = 8 - super::R;
        world.blockers = super::quad([[l, l, z], [l, h, z], [h, h, z], [h, l, z]]).to_vec();
        world.parameters.offset = 2;
        for (triangle, colour) in world.triangles.iter_mut().zip(&mut world.colours) {
            let wall = triangle.iter().all(|corner| corner[2] == -super::R);
            *colour = if wall { [1.0; 3] } else { [0.0; 3] };
            for corner in triangle.iter_mut().filter(|_| !wall) {
                corner[2] = corner[2].max(64 - super::R);
            }
        }
        let scene = world.scene([0; 3], 0);
        let frame = scene.frame();
        for pixel in 0..frame.blocked.size.pixels() {
            let (a, b) = (frame.all[fine(&scene, pixel)], frame.blocked.light[pixel]);
            prop_assert_eq!(a.map(|c| c.value), b.map(|c| c.value));
        }
    }

    /// A segment from a point to what it faces, and is faced by, meets neither's triangle:
    /// as blockers, a pixel's own and a texel's own block nothing.
    #[test]
    fn own_faces(scene in scenes()) {
        let frame = scene.frame();
        let lights: Vec<Light> = frame.rsm.lights().into_iter().flatten().collect();
        for surface in frame.seen.surfaces.iter().flatten() {
            for light in &lights {
                let (from, to) = (surface.point, light.surface.point);
                if facing(&scene.model, surface, to) && facing(&scene.model, &light.surface, from) {
                    for triangle in [surface.triangle, light.surface.triangle] {
                        let ray = Ray::between(from, to);
                        prop_assert_eq!(crossing(&ray, scene.model.corners(triangle)), None);
                    }
                }
            }
        }
    }

    /// Moving the world by integers and scaling it by a power of two changes nothing: all
    /// lengths are those of the lattice.
    #[test]
    fn moved(world in worlds(), by in super::place(1 << 20), power in -60..60_i32) {
        prop_assert_eq!(world.scene([0; 3], 0).frame(), world.scene(by, power).frame());
    }

    /// A lamp that is a power of two as strong gives as much more light, straight and by
    /// the bounce, and changes no decision.
    #[test]
    fn stronger(mut world in worlds(), power in 1..8_i32) {
        let frame = world.scene([0; 3], 0).frame();
        let factor = f64::from(power).exp2();
        world.strength = world.strength.map(|c| c * 2_f32.powi(power));
        let other = world.scene([0; 3], 0).frame();
        prop_assert_eq!(&frame.seen, &other.seen);
        prop_assert_eq!(&frame.direct.lit, &other.direct.lit);
        prop_assert_eq!(&frame.blocked.bits, &other.blocked.bits);
        let values = |colours: &[Colour], by: f64| -> Vec<[f64; 3]> {
            colours.iter().map(|colour| colour.map(|c| c.value * by)).collect()
        };
        prop_assert_eq!(values(&frame.direct.light, factor), values(&other.direct.light, 1.0));
        prop_assert_eq!(values(&frame.all, factor), values(&other.all, 1.0));
        prop_assert_eq!(values(&frame.blurred, factor), values(&other.blurred, 1.0));
        for (pixel, surface) in frame.seen.surfaces.iter().enumerate() {
            if surface.is_some() {
                let [a, b] = [(&frame, factor), (&other, 1.0)].map(|(f, by)| values(&f.picture[pixel..=pixel], by));
                prop_assert_eq!(a, b);
            }
        }
    }

    /// A kernel that holds the whole map from everywhere gives every pixel that has a place
    /// the light of all texels, whatever its place.
    #[test]
    fn whole_map(mut world in worlds(), elsewhere in [0..9_i32, 0..9]) {
        (world.parameters.radius, world.parameters.stride) = (20, 1);
        let scene = world.scene([0; 3], 0);
        let frame = scene.frame();
        let (lights, size) = (frame.rsm.lights(), frame.rsm.seen.size);
        let moved: Vec<_> = frame.places.iter().map(|p| p.map(|mut p| {
            let inside = [0, 1].map(|i| p.texel[i].clamp(0, 8));
            p.texel = if inside == p.texel { elsewhere } else { p.texel };
            p
        })).collect();
        let again = triptych_spec::rsm::gather(&scene.model, &frame.seen, &moved, &lights, size, &scene.parameters);
        prop_assert_eq!(&again, &frame.all);
    }

    /// Kernels of every `stride`-th texel, begun at each of the texels of a square of that side,
    /// give the light of all texels on average.
    #[test]
    fn strides(mut world in worlds(), stride in 2..4_u32) {
        (world.parameters.radius, world.parameters.stride) = (20, 1);
        let whole = world.scene([0; 3], 0).frame();
        world.parameters.stride = stride;
        let scene = world.scene([0; 3], 0);
        let frame = scene.frame();
        let (lights, size) = (frame.rsm.lights(), frame.rsm.seen.size);
        let mut mean = vec![DARK; whole.all.len()];
        let by = stride.cast_signed();
        for at in (0..by).flat_map(|y| (0..by).map(move |x| [x, y])) {
            let moved: Vec<_> = frame.places.iter().map(|p| p.map(|p| Place { texel: at, ..p })).collect();
            let part = triptych_spec::rsm::gather(&scene.model, &frame.seen, &moved, &lights, size, &scene.parameters);
            for (mean, part) in mean.iter_mut().zip(part) {
                for (mean, part) in mean.iter_mut().zip(part) {
                    mean.value += part.value / f64::from(by * by);
                    mean.bound += part.bound / f64::from(by * by);
                }
            }
        }
        let inside = |p: &Place| p.texel.iter().all(|c| (0..9).contains(c));
        for (pixel, place) in whole.places.iter().enumerate() {
            if place.as_ref().is_some_and(inside) {
                // Intensities were rounded to `f32` once, each kernel's by itself.
                let rounded = |c: f64| U * c.abs();
                let near = (0..3).all(|i| {
                    let (a, b) = (whole.all[pixel][i], mean[pixel][i]);
                    (a.value - b.value).abs() <= a.bound + b.bound + 2.0 * rounded(a.value)
                });
                prop_assert!(near, "{:?}, {:?}", whole.all[pixel], mean[pixel]);
            }
        }
    }
}
