//! From a picture's surfaces to pixels.

use triptych_gpu::hbao::{Pixel, Screen};
use triptych_spec::camera::{Camera, Projection};
use triptych_spec::grid::lattice::Lattice;
use triptych_spec::ldm::Falloff;
use triptych_spec::rsm::{Model, Parameters, Surface, View, gbuffer};
use triptych_spec::scene::Size;

use super::scenes::{V, dot, plus, unit};
use super::{openness, settings};

/// Of the pictures.
const SIZE: Size = Size {
    width: 40,
    height: 30,
};

/// A floor and a wall.
fn model() -> Model {
    let corners = vec![
        [-900_000, 0, -900_000],
        [900_000, 0, -900_000],
        [900_000, 0, 900_000],
        [-900_000, 0, 900_000],
        [-900_000, 900_000, -900_000],
        [900_000, 900_000, -900_000],
    ];
    let rows = vec![[0, 1, 2], [0, 3, 2], [0, 1, 5], [0, 5, 4]];
    Model::new(corners, rows, vec![[1.0; 3]; 4]).expect("within the limits")
}

/// A camera's picture.
fn seen(model: &Model, camera: &Camera) -> (Screen, Vec<Option<Surface>>) {
    let lattice = Lattice {
        centre: [0.0; 3],
        exponent: 0,
    };
    let view = View::new(camera, &lattice, SIZE).expect("a view");
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
    let seen = gbuffer(model, &view, &parameters);
    (Screen::new(&view, model, &seen.surfaces), seen.surfaces)
}

/// Right, down and ahead.
fn axes(camera: &Camera) -> [V; 3] {
    let ahead = unit([0, 1, 2].map(|i| camera.target[i] - camera.eye[i]));
    let right = unit(cross(ahead, camera.up));
    [right, cross(ahead, right), ahead]
}

/// Points and normals in view space are where rays from the eye find them.
#[test]
fn surfaces_become_pixels() {
    let model = model();
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
        let (screen, surfaces) = seen(&model, &camera);
        let mut checked = 0;
        for (at, (pixel, surface)) in screen.pixels.iter().zip(&surfaces).enumerate() {
            match surface {
                None => assert_eq!(*pixel, Pixel::NOTHING),
                Some(surface) => {
                    agrees((&model, &camera), &screen, at, surface);
                    checked += 1;
                }
            }
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

/// Back in the world, a pixel's point and normal are its surface's.
fn agrees((model, camera): (&Model, &Camera), screen: &Screen, at: usize, surface: &Surface) {
    let pixel = screen.pixels[at];
    let depth = f64::from(pixel.depth);
    // An orthographic view counts from its near plane.
    let (by, from) = match screen.near {
        true => (depth, 0.0),
        false => (1.0, camera.near),
    };
    let [right, down, ahead] = axes(camera);
    let along = |[x, y, z]: V| plus(plus(right.map(|c| c * x), down, y), ahead, z);
    let [x, y] = [(at % 40) as f64 + 0.5 - 20.0, (at / 40) as f64 + 0.5 - 15.0];
    let [sx, sy] = screen.scale.map(f64::from);
    let point = plus(
        camera.eye,
        along([x / sx * by, y / sy * by, depth + from]),
        1.0,
    );
    let apart = [0, 1, 2].map(|i| point[i] - f64::from(surface.point[i]));
    // Two steps off the face and half a step's snapping, which a slope makes more of across
    // the ray; and the roundings of numbers below 2^22.
    assert!(dot(apart, apart).sqrt() < 8.0, "pixel {at}: {apart:?}");
    let normal = along(pixel.normal.map(f64::from));
    let face = model.face(surface.triangle).unit;
    let face = face.map(|c| f64::from(c) * f64::from(surface.side));
    let off = plus(normal, face, -1.0);
    assert!(dot(off, off) < 1e-12, "pixel {at}: {normal:?} for {face:?}");
}

fn cross(a: V, b: V) -> V {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}
