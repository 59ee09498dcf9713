//! What pixels see, and where that lies in the light's map.

use proptest::prelude::*;
use triptych_spec::abuffer::{NOTHING, opaque};
use triptych_spec::camera::{Camera, Projection};
use triptych_spec::grid::lattice::{EXTENT, Lattice};
use triptych_spec::rsm::{BIAS_MAX, Face, Gbuffer, Model, View, direct, gbuffer, place, project};
use triptych_spec::scene::Size;
use triptych_spec::vertex::{SUBPIXEL_BITS, primitives};

use super::{PARAMETERS, Scene, rows, scenes, unmoved, volume, worlds};
use crate::config;

/// Pixels that see something: number, triangle, and the point on it.
fn seen(scene: &Scene, gbuffer: &Gbuffer) -> Vec<(usize, u32, [i32; 3])> {
    let surfaces = gbuffer.surfaces.iter().enumerate();
    let seen = surfaces.filter_map(|(pixel, surface)| {
        let surface = surface.as_ref()?;
        let point = unmoved(&scene.model, surface, scene.parameters.offset);
        Some((pixel, surface.triangle, point))
    });
    seen.collect()
}

/// A corner of a box around a point.
fn around(point: [i32; 3], corner: usize) -> [i32; 3] {
    [0, 1, 2].map(|axis| {
        if corner >> axis & 1 == 0 {
            point[axis] - 1
        } else {
            point[axis] + 1
        }
    })
}

/// Whether the middle of a pixel is in a triangle as the view has it, before it is snapped.
fn covers(corners: [[f64; 3]; 3], middle: [f64; 2]) -> bool {
    let sides = [0, 1, 2].map(|i| {
        let [from, to] = [corners[i], corners[(i + 1) % 3]];
        (to[0] - from[0]) * (middle[1] - from[1]) - (to[1] - from[1]) * (middle[0] - from[0])
    });
    sides.iter().all(|s| *s > 0.0) || sides.iter().all(|s| *s < 0.0)
}

proptest! {
    #![proptest_config(config(500))]

    /// Pixels see what the opaque stage says, in the triangle's box, half a step from its
    /// plane in each axis, and after the offset are strictly on the side that is seen.
    #[test]
    fn clear_of_the_face(scene in scenes()) {
        for view in [&scene.eye, &scene.lamp.view] {
            let gbuffer = gbuffer(&scene.model, view, &scene.parameters);
            let target = view.scene(&scene.model);
            let primitives = primitives(&target, SUBPIXEL_BITS);
            let nearest = opaque(&target, &primitives);
            prop_assert_eq!(&gbuffer.keys, &nearest.key);
            for (pixel, surface) in gbuffer.surfaces.iter().enumerate() {
                let Some(surface) = surface else {
                    prop_assert_eq!(nearest.prim[pixel], NOTHING);
                    continue;
                };
                prop_assert_eq!(surface.triangle, primitives.source[nearest.prim[pixel] as usize]);
                let corners = scene.model.corners(surface.triangle);
                let point = unmoved(&scene.model, surface, scene.parameters.offset);
                let axes = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
                let normal: i128 = axes.iter().map(|axis| volume(corners, *axis).abs()).sum();
                let height = |point: [i32; 3]| {
                    let d = [0, 1, 2].map(|i| point[i] - corners[0][i]);
                    volume(corners, d) * i128::from(surface.side)
                };
                // A millionth of a step for what f64 rounds on the way.
                prop_assert!(height(point).abs() * 2 <= normal + normal / 1_000_000);
                prop_assert!(height(surface.point) > 0 || normal == 0);
                for axis in 0..3 {
                    let sides = corners.map(|c| c[axis]);
                    prop_assert!(point[axis] >= *sides.iter().min().unwrap());
                    prop_assert!(point[axis] <= *sides.iter().max().unwrap());
                }
                let towards = view.viewpoint.from(corners[0]);
                prop_assert!(volume(corners, towards) * i128::from(surface.side) >= 0);
            }
        }
    }

    /// A point is where its pixel's ray is, as far as snapping it leaves it there: its box of
    /// a step to each side, seen from the eye, holds the middle of the pixel.
    #[test]
    fn on_the_ray(scene in scenes()) {
        let gbuffer = gbuffer(&scene.model, &scene.eye, &scene.parameters);
        let width = gbuffer.size.width as usize;
        for (pixel, triangle, point) in seen(&scene, &gbuffer) {
            let middle = [pixel % width, pixel / width].map(|c| c as f64 + 0.5);
            let corners = scene.model.corners(triangle).map(|c| project::<f64>(&scene.eye, c));
            // Else the weights were clamped, or the triangle is cut.
            let [Some(a), Some(b), Some(c)] = corners else { continue };
            if !covers([a, b, c], middle) {
                continue;
            }
            let at = project::<f64>(&scene.eye, point).expect("in front");
            for axis in 0..2 {
                let room = (0..8).filter_map(|corner| project::<f64>(&scene.eye, around(point, corner)))
                    .map(|p| (p[axis] - at[axis]).abs()).fold(0.0, f64::max);
                prop_assert!((at[axis] - middle[axis]).abs() <= room, "{:?} at {:?}, {}", at, middle, room);
            }
        }
    }

    /// The light's own points lie in their texels, but for snapping and the offset.
    #[test]
    fn own_texels(scene in scenes()) {
        let view = &scene.lamp.view;
        let gbuffer = gbuffer(&scene.model, view, &scene.parameters);
        let width = gbuffer.size.width as usize;
        let places = place(view, &gbuffer);
        for (pixel, triangle, point) in seen(&scene, &gbuffer) {
            let middle = [pixel % width, pixel / width].map(|c| c as f64 + 0.5);
            let corners = scene.model.corners(triangle).map(|c| project::<f64>(view, c));
            let [Some(a), Some(b), Some(c)] = corners else { continue };
            if !covers([a, b, c], middle) {
                continue;
            }
            let moved = gbuffer.surfaces[pixel].expect("seen").point;
            let [at, off] = [point, moved].map(|p| project::<f64>(view, p).expect("in front"));
            let place = places[pixel].expect("in front");
            for axis in 0..2 {
                let room = (0..8).filter_map(|corner| project::<f64>(view, around(point, corner)))
                    .map(|p| (p[axis] - at[axis]).abs()).fold(0.0, f64::max) + (off[axis] - at[axis]).abs();
                let texel = f64::from(place.texel[axis]);
                prop_assert!(texel - room <= middle[axis] && middle[axis] <= texel + 1.0 + room);
            }
        }
    }

    /// Light comes to what faces it, lies in its map and is not behind what it sees there
    /// by more than the bias: with the largest bias to all that face it.
    #[test]
    fn shadows(mut world in worlds(), all: bool) {
        if all {
            world.parameters.bias = BIAS_MAX;
        }
        let scene = world.scene([0; 3], 0);
        let frame = scene.frame();
        let (size, keys) = (frame.rsm.seen.size, &frame.rsm.seen.keys);
        for (pixel, lit) in frame.direct.lit.iter().enumerate() {
            let mut expected = false;
            if let (Some(surface), Some(place)) = (frame.seen.surfaces[pixel], frame.places[pixel]) {
                let way = scene.lamp.view.viewpoint.from(surface.point);
                let corners = scene.model.corners(surface.triangle);
                let facing = volume(corners, way) * i128::from(surface.side) > 0;
                let [x, y] = place.texel.map(i64::from);
                let inside = (0..i64::from(size.width)).contains(&x) && (0..i64::from(size.height)).contains(&y);
                let index = usize::try_from(y * i64::from(size.width) + x);
                let near = |i: usize| keys[i] == NOTHING || i64::from(place.key) - i64::from(keys[i]) <= i64::from(world.parameters.bias);
                expected = facing && inside && (all || index.is_ok_and(near));
            }
            prop_assert_eq!(*lit, expected);
            prop_assert!(*lit || frame.direct.light[pixel].iter().all(|c| c.value == 0.0 && c.bound == 0.0));
        }
    }

    /// Seen from the light, what it sees is lit: its point is in its own texel, and in front
    /// of it by the offset, so that only snapping the key needs the bias.
    #[test]
    fn lit_from_the_light(mut world in worlds()) {
        (world.eye, world.size) = (world.light, world.map);
        world.parameters.bias = BIAS_MAX;
        let scene = world.scene([0; 3], 0);
        let frame = scene.frame();
        prop_assert_eq!(&frame.seen, &frame.rsm.seen);
        let again = direct(&scene.model, &frame.seen, &frame.places, &scene.lamp, &frame.rsm.seen.keys, &scene.parameters);
        prop_assert_eq!(&again, &frame.direct);
        for (pixel, surface) in frame.seen.surfaces.iter().enumerate() {
            let Some(surface) = surface else { continue };
            let corners = scene.model.corners(surface.triangle);
            let way = scene.lamp.view.viewpoint.from(surface.point);
            let facing = volume(corners, way) * i128::from(surface.side) > 0;
            let [x, y] = frame.places[pixel].expect("in front").texel;
            let texel = usize::try_from(y).is_ok_and(|y| usize::try_from(x).is_ok_and(|x| y * world.map.width as usize + x == pixel));
            prop_assert!(frame.direct.lit[pixel] || !facing || !texel);
        }
    }

    /// A plane's normals have their lengths and their direction, whatever its size.
    #[test]
    fn planes(corners in [super::place(EXTENT), super::place(EXTENT), super::place(EXTENT)]) {
        let face = Face::new(corners);
        let exact = [[1, 0, 0], [0, 1, 0], [0, 0, 1]].map(|axis| volume(corners, axis));
        prop_assert_eq!(face.normal.map(i128::from), exact);
        let wide = exact.map(|c| c as f64);
        let length = (wide[0].powi(2) + wide[1].powi(2) + wide[2].powi(2)).sqrt();
        for (axis, along) in wide.into_iter().enumerate() {
            let unit = along / length;
            prop_assert!((f64::from(face.unit[axis]) - unit).abs() <= f64::from(f32::EPSILON) / 2.0);
            prop_assert!((f64::from(face.coarse[axis]) - unit * 16384.0).abs() <= 0.5 + 1e-9);
        }
    }
}

/// A triangle that is seen exactly edge-on covers nothing, unless snapping its corners to
/// sub-pixels gives it an area. Then its point is its first corner, and any of it is as good.
#[test]
fn edge_on() {
    let lattice = Lattice {
        centre: [0.0; 3],
        exponent: 0,
    };
    let camera = Camera {
        eye: [0.0; 3],
        target: [0.0, 0.0, -1.0],
        up: [0.0, 1.0, 0.0],
        projection: Projection::Orthographic {
            height: f64::from(3 << 10),
        },
        near: 0.0,
        far: f64::from(1 << 14),
    };
    // A pixel is 1024 steps, and a sub-pixel 4.
    let size = Size {
        width: 3,
        height: 3,
    };
    let view = View::new(&camera, &lattice, size).expect("a view");
    let mut seen = 0;
    for (x, y) in (1..8).flat_map(|x| (1..8).map(move |y| (x, y))) {
        let ends = [(-33, 17, 5), (-29, 11, 50), (-50, 7, 31)];
        for (a, b, c) in ends {
            let corner = |n: i32, z: i32| [n * x, n * y, z];
            let corners = vec![corner(a, -999), corner(b, -9), corner(c, -5000)];
            let first = corners[0];
            let model = Model::new(corners.clone(), rows(1), vec![[1.0; 3]]).expect("a model");
            let seen_by = gbuffer(&model, &view, &PARAMETERS);
            for (surface, stray) in seen_by.surfaces.iter().zip(&seen_by.stray) {
                let Some(surface) = surface else { continue };
                seen += 1;
                assert_eq!(unmoved(&model, surface, PARAMETERS.offset), first);
                let side = |i: usize| corners.iter().map(move |c| c[i]);
                let long = [0, 1, 2].map(|i| {
                    let ends = side(i).max().zip(side(i).min());
                    ends.map_or(0, |(high, low)| high.abs_diff(low))
                });
                assert_eq!(*stray, long, "a kernel may find any of its points");
            }
        }
    }
    assert!(seen > 0, "snapping gives none an area");
}
