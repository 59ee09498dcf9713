//! Any number that a camera, a colour or a coordinate may have gives a frame.

use proptest::prelude::*;
use triptych_spec::camera::{Camera, Projection};

use super::worlds::{R, worlds};
use crate::config;

/// An angle, two distances of any size, and a factor.
fn hostile() -> impl Strategy<Value = [f64; 4]> {
    let power = -40..80_i32;
    let fov = prop_oneof![Just(1e-9), Just(179.999_999), 1.0..179.0_f64];
    (fov, power.clone(), power, -3.0..3.0_f64)
        .prop_map(|(fov, near, far, at)| [fov, f64::from(near).exp2(), f64::from(far).exp2(), at])
}

proptest! {
    #![proptest_config(config(300))]

    /// Colours are finite, and no bound is none; the arithmetic never panics.
    #[test]
    fn frames(mut world in worlds(), eye in hostile(), light in hostile(), bright: bool, corner in 0..8_usize) {
        for (camera, [fov, near, far, at]) in [(&mut world.eye, eye), (&mut world.light, light)] {
            let next = Camera {
                near,
                far: near * 1.001 + far,
                eye: camera.eye.map(|c| (c * at).rem_euclid(f64::from(R))),
                projection: match camera.projection {
                    Projection::Perspective { .. } => Projection::Perspective { fov },
                    Projection::Orthographic { .. } => Projection::Orthographic { height: far },
                },
                ..*camera
            };
            // Else what it was is a camera at least.
            if next.matrix(1.0).is_ok() {
                *camera = next;
            }
        }
        if bright {
            world.colours.fill([f32::MAX; 3]);
            world.strength = [f32::MAX, f32::MIN_POSITIVE, 1e-40];
        }
        // A triangle as long as the lattice, and one that is a point.
        let end = [0, 1, 2].map(|axis| if corner >> axis & 1 == 0 { -R } else { R });
        world.triangles[0] = [end, end.map(|c| -c), [0, R, R]];
        world.triangles[1] = [end; 3];
        let frame = world.scene([0; 3], 0).frame();
        for colour in frame.all.iter().chain(&frame.picture).flatten() {
            prop_assert!(colour.value.is_finite() && colour.value >= 0.0);
            prop_assert!(!colour.bound.is_nan());
            // What f32 cannot say is promised by no evaluation.
            prop_assert!(colour.value <= f64::from(f32::MAX) || colour.bound.is_infinite());
        }
    }
}
