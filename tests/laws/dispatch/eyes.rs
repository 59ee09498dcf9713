//! Rays of pixels, against the camera that they are of.

use proptest::prelude::*;
use triptych_spec::camera::{Camera, Projection};
use triptych_spec::dispatch::{Eye, primary};
use triptych_spec::grid::lattice::REACH;
use triptych_spec::scene::Size;

use super::worlds::{UNIT, place};
use crate::config;

fn camera() -> impl Strategy<Value = Camera> {
    let projection = prop_oneof![
        (1.0..150.0_f64).prop_map(|fov| Projection::Perspective { fov }),
        (1.0..1e6_f64).prop_map(|height| Projection::Orthographic { height }),
    ];
    (projection, place(1 << 20), place(1 << 20)).prop_map(|(projection, eye, way)| Camera {
        eye: eye.map(f64::from),
        target: [0, 1, 2].map(|i| f64::from(eye[i]) + f64::from(way[i]) + 0.5),
        up: [0.1, 1.0, 0.2],
        projection,
        near: 1.0,
        far: 2.0,
    })
}

/// Pictures of any size, or so small that all of their rays are looked at.
fn size() -> impl Strategy<Value = Size> {
    let side = prop_oneof![1..=4096_u32, 1..=8_u32];
    (side.clone(), side).prop_map(|(width, height)| Size { width, height })
}

proptest! {
    #![proptest_config(config(512))]

    /// A corner, steps to the right and steps down are each off by half of 2^-7 at most, and their
    /// sum by half of 1 more when it is rounded.
    #[test]
    fn rays_go_through_the_middles_of_pixels(camera in camera(), size in size(), at in [0.0..1.0_f64, 0.0..1.0]) {
        let Ok(eye) = Eye::new(&camera, &UNIT, size) else { return Ok(()) };
        let (width, height) = (f64::from(size.width), f64::from(size.height));
        let [right, up, forward] = camera.axes(width / height).unwrap();
        let (x, y) = ((at[0] * width).floor(), (at[1] * height).floor());
        let (across, above) = ((2.0 * x + 1.0) / width - 1.0, 1.0 - (2.0 * y + 1.0) / height);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "below 2^24")]
        let pixel = (y * width + x) as u32;
        let ray = eye.ray(pixel);
        let reach = |i: usize| right[i].abs() + up[i].abs() + forward[i].abs();
        let scale = f64::from(1 << 22) / [0, 1, 2].map(reach).into_iter().fold(0.0, f64::max);
        let off = (1.0 + x + y) / 256.0 + 0.5;
        for i in 0..3 {
            let beside = right[i] * across + up[i] * above;
            let (origin, direction) = match camera.projection {
                Projection::Perspective { .. } => (camera.eye[i], (forward[i] + beside) * scale),
                Projection::Orthographic { .. } => (camera.eye[i] + beside, forward[i] * f64::from(1 << 22)),
            };
            prop_assert!((f64::from(ray.origin[i]) - origin).abs() <= off + 1e-6, "{:?} for {}", ray, origin);
            prop_assert!((f64::from(ray.direction[i]) - direction).abs() <= off + 1e-6, "{:?} for {}", ray, direction);
        }
    }

    /// Where steps are rounded up, the last column is farther than the picture is wide.
    #[test]
    fn rays_begin_on_the_lattice(odd in 0..800_i32, beyond in -20..20_i32, turned in any::<bool>()) {
        let size = Size { width: 2048, height: 4 };
        // From one column to the next, in steps: an odd number and a half of units of 2^-7.
        let step = (2.0 * f64::from(odd) + 1.5) / 128.0;
        let half = 1024.0 * step;
        let eye = (f64::from(REACH + beyond) - half).floor();
        let side = if turned { -1.0 } else { 1.0 };
        let camera = Camera {
            eye: [side * eye, 0.0, 0.0],
            target: [side * eye, 0.0, -1.0],
            up: [0.0, side, 0.0],
            projection: Projection::Orthographic { height: half / 256.0 },
            near: 1.0,
            far: 2.0,
        };
        let Ok(eye) = Eye::new(&camera, &UNIT, size) else { return Ok(()) };
        for pixel in [0, 2047, 3 * 2048, 4 * 2048 - 1] {
            let origin = eye.ray(pixel).origin;
            prop_assert!(origin.iter().all(|c| c.abs() <= REACH), "{:?}", origin);
        }
    }

    #[test]
    fn there_is_a_ray_for_each_pixel(camera in camera(), size in (1..=8_u32, 1..=8_u32)) {
        let size = Size { width: size.0, height: size.1 };
        let Ok(eye) = Eye::new(&camera, &UNIT, size) else { return Ok(()) };
        let pixels: Vec<u32> = primary(&eye).map(|ray| ray.pixel).collect();
        prop_assert_eq!(pixels, (0..size.width * size.height).collect::<Vec<_>>());
    }
}
