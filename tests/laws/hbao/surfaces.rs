//! From a picture's surfaces to pixels, and means over pixels of the same surface.

use triptych_gpu::hbao::{Pixel, Screen, Settings};
use triptych_spec::camera::{Camera, Projection};
use triptych_spec::grid::lattice::Lattice;
use triptych_spec::ldm::Falloff;
use triptych_spec::rsm::{Model, Parameters, View, gbuffer};
use triptych_spec::scene::Size;

use super::scenes::{Eye, Shape, V, dot, plus, unit};
use super::{openness, settings};

/// A model's floor and wall in view space are where rays from the eye find them.
#[test]
fn surfaces_become_pixels() {
    let size = Size {
        width: 40,
        height: 30,
    };
    let corners = vec![
        [-900_000, 0, -900_000],
        [900_000, 0, -900_000],
        [900_000, 0, 900_000],
        [-900_000, 0, 900_000],
        [-900_000, 900_000, -900_000],
        [900_000, 900_000, -900_000],
    ];
    let rows = vec![[0, 1, 2], [0, 3, 2], [0, 1, 5], [0, 5, 4]];
    let model = Model::new(corners, rows, vec![[1.0; 3]; 4]).expect("within the limits");
    let lattice = Lattice {
        centre: [0.0; 3],
        exponent: 0,
    };
    for projection in [
        Projection::Perspective { fov: 50.0 },
        Projection::Orthographic {
            height: 1_500_000.0,
        },
    ] {
        let camera = Camera {
            eye: [200_000.0, 1_100_000.0, 1_600_000.0],
            target: [0.0, 200_000.0, 0.0],
            up: [0.1, 1.0, 0.0],
            projection,
            near: 1000.0,
            far: 4_000_000.0,
        };
        let view = View::new(&camera, &lattice, size).expect("a view");
        let parameters = Parameters {
            radius: 1,
            stride: 1,
            divisor: 1,
            blur: 0,
            bias: 0,
            clamp: 1,
            offset: 2,
            edge: 1,
        };
        let seen = gbuffer(&model, &view, &parameters);
        let screen = Screen::new(&view, &model, &seen.surfaces);
        let ahead = unit([0, 1, 2].map(|i| camera.target[i] - camera.eye[i]));
        let right = unit(cross(ahead, camera.up));
        let down = cross(ahead, right);
        let mut checked = 0;
        for (at, (pixel, surface)) in screen.pixels.iter().zip(&seen.surfaces).enumerate() {
            let Some(surface) = surface else {
                assert_eq!(*pixel, Pixel::NOTHING);
                continue;
            };
            // Back in the world: the point in the pixel's middle.
            let by = if screen.near {
                f64::from(pixel.depth)
            } else {
                1.0
            };
            let [x, y] = [(at % 40) as f64 + 0.5 - 20.0, (at / 40) as f64 + 0.5 - 15.0];
            let [sx, sy] = screen.scale.map(f64::from);
            let mut point = plus(camera.eye, right, x / sx * by);
            point = plus(point, down, y / sy * by);
            // An orthographic view counts from its near plane.
            let from = if screen.near { 0.0 } else { camera.near };
            point = plus(point, ahead, f64::from(pixel.depth) + from);
            let apart = [0, 1, 2].map(|i| point[i] - f64::from(surface.point[i]));
            // Two steps off the face and half a step's snapping, which a slope makes more of
            // across the ray; and the roundings of numbers below 2^22.
            assert!(dot(apart, apart).sqrt() < 8.0, "pixel {at}: {apart:?}");
            let normal = pixel.normal.map(f64::from);
            let world = plus(
                plus(right.map(|c| c * normal[0]), down, normal[1]),
                ahead,
                normal[2],
            );
            let face = model
                .face(surface.triangle)
                .unit
                .map(|c| f64::from(c) * f64::from(surface.side));
            let off = plus(world, face, -1.0);
            assert!(dot(off, off) < 1e-12, "pixel {at}: {world:?} for {face:?}");
            checked += 1;
        }
        assert!(checked > 600, "{checked} pixels see anything");
        // A right angle: far from its edge nothing, at it half is blocked.
        let falloff = Falloff::Distance {
            most: 300_000,
            power: 0,
        };
        for (name, found) in openness(&screen, settings(falloff, 8, 16)) {
            let lowest = found.iter().copied().fold(1.0, f32::min);
            assert!(lowest > 0.35 && lowest < 0.75, "{name}: {lowest}");
        }
    }
}

fn cross(a: V, b: V) -> V {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// Each pixel's mean by the definition, of what the adapter found without it.
#[test]
fn means_are_of_the_same_surface() {
    let half = |normal: V, at: V| Shape::Half {
        normal,
        at: dot(normal, at),
    };
    // A corner, and a ball in front of it.
    let shapes = [
        half(unit([0.0, -1.0, -1.0]), [0.0, 0.0, 1000.0]),
        half(unit([0.0, 1.0, -1.0]), [0.0, 0.0, 1000.0]),
        Shape::Ball {
            centre: [100.0, 60.0, 500.0],
            radius: 150.0,
        },
    ];
    let eye = Eye {
        size: Size {
            width: 50,
            height: 40,
        },
        near: false,
        scale: 0.06,
    };
    let screen = eye.screen(&shapes);
    let plain = settings(
        Falloff::Distance {
            most: 300,
            power: 1,
        },
        2,
        8,
    );
    let rough = openness(&screen, plain);
    let smooth = openness(
        &screen,
        Settings {
            denoise: 1,
            ..plain
        },
    );
    let twice = openness(
        &screen,
        Settings {
            denoise: 2,
            ..plain
        },
    );
    // On which shape a pixel is, and its point.
    let own = |pixel: usize| {
        let (point, normal) = eye.sees(&shapes, pixel).expect("planes are everywhere");
        let lies = |shape: &Shape| match shape {
            Shape::Half { normal, at } => (dot(*normal, point) - at).abs() < 1e-6,
            _ => true,
        };
        (
            shapes.iter().position(lies).expect("the ball at last"),
            point,
            normal,
        )
    };
    let mut across = 0;
    for (((name, rough), (_, smooth)), (_, twice)) in rough.iter().zip(&smooth).zip(&twice) {
        let means = |of: &[f32], pixel: usize| {
            let (shape, point, normal) = own(pixel);
            let (mut sum, mut total, mut crossed) = (0.0, 0.0, 0);
            let [x, y] = [pixel % 50, pixel / 50];
            for (column, row) in (x.max(2) - 2..50.min(x + 3))
                .flat_map(|c| (y.max(2) - 2..40.min(y + 3)).map(move |r| (c, r)))
            {
                let (there, end, other) = own(50 * row + column);
                let off = plus(end, point, -1.0);
                let long = dot(off, off).sqrt().max(1e-9);
                let apart = dot(normal, off).abs().max(dot(other, off).abs()) / long;
                let ends = |by: usize| if by == 2 { 0.5 } else { 1.0 };
                let weight =
                    ends(column.abs_diff(x)) * ends(row.abs_diff(y)) * (1.0 - 4.0 * apart).max(0.0);
                let weight = if dot(normal, other) > 0.0 {
                    weight
                } else {
                    0.0
                };
                // No plane's pixels take from the other plane; nor from the ball, or it from them,
                // but for silhouettes that stand in a plane by chance.
                assert!(
                    weight == 0.0 || there == shape || there + shape > 1,
                    "pixel {pixel}"
                );
                crossed += usize::from(there != shape);
                sum += weight * f64::from(of[50 * row + column]);
                total += weight;
            }
            (sum / total, crossed)
        };
        for pixel in 0..2000 {
            let (mean, crossed) = means(rough, pixel);
            across += crossed;
            // Weights are off by roundings of points, 64 of a distance of at most 80 pixels,
            // four times; what they weigh lies within 1 of each other.
            let bound = 4.0 * 64.0 * 80.0 / 16_777_216.0;
            assert!(
                (f64::from(smooth[pixel]) - mean).abs() < bound,
                "{name} pixel {pixel}: {} for {mean}",
                smooth[pixel]
            );
            let (mean, _) = means(smooth, pixel);
            assert!(
                (f64::from(twice[pixel]) - mean).abs() < bound,
                "{name} pixel {pixel}, twice"
            );
        }
    }
    assert!(across > 500, "{across} neighbours across an edge");
}
