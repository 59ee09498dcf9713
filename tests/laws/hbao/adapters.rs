//! Random scenes on every adapter: what the twin finds, within its bound.

use proptest::prelude::*;
use triptych_gpu::hbao::Settings;
use triptych_spec::ldm::Falloff;
use triptych_spec::scene::Size;

use super::openness;
use super::scenes::{Eye, Shape, unit};
use super::twin::twin;
use crate::config;

/// Planes behind, and balls in front of them.
fn shapes() -> impl Strategy<Value = Vec<Shape>> {
    let tilt = || -1.0..1.0_f64;
    let plane = (tilt(), tilt(), 600.0..900.0_f64).prop_map(|(x, y, z)| {
        let normal = unit([x, y, -1.0]);
        Shape::Half {
            normal,
            at: normal[2] * z,
        }
    });
    let ball = (
        prop::array::uniform2(-400.0..400.0_f64),
        300.0..700.0_f64,
        20.0..200.0_f64,
    );
    let ball = ball.prop_map(|([x, y], z, radius)| Shape::Ball {
        centre: [x, y, z],
        radius,
    });
    let planes = prop::collection::vec(plane, 0..3);
    (planes, prop::collection::vec(ball, 0..4)).prop_map(|(mut all, more)| {
        all.extend(more);
        all
    })
}

fn eye() -> impl Strategy<Value = Eye> {
    let size = (1..=40_u32, 1..=40_u32);
    (size, any::<bool>(), 0.6..1.5_f64).prop_map(|((width, height), near, zoom)| Eye {
        size: Size { width, height },
        near,
        scale: if near { 40.0 * zoom } else { 0.05 * zoom },
    })
}

fn falloff() -> impl Strategy<Value = Falloff> {
    prop_oneof![
        1 => Just(Falloff::None),
        3 => (50..1500_u32, 0..=4_u32).prop_map(|(most, power)| Falloff::Distance { most, power }),
    ]
}

fn settings() -> impl Strategy<Value = Settings> {
    let detail = prop::sample::select(vec![1, 3, 31]);
    (falloff(), 1..6_u32, 1..12_u32, detail).prop_map(|(falloff, slices, steps, detail)| Settings {
        falloff,
        slices,
        steps,
        denoise: 0,
        detail,
    })
}

proptest! {
    #![proptest_config(config(48))]

    #[test]
    fn kernels_find_what_the_twin_finds(shapes in shapes(), eye in eye(), settings in settings()) {
        let screen = eye.screen(&shapes);
        let must: Vec<_> = (0..).take(screen.pixels.len()).map(|pixel| twin(&screen, settings, pixel)).collect();
        // Of at most 110 samples, each may be within 2^-12 on either side of four borders.
        let certain = must.iter().filter(|must| must.certain).count();
        prop_assert!(must.len() < 20 || 2 * certain >= must.len(), "{} of {}", certain, must.len());
        for (name, found) in openness(&screen, settings) {
            for (pixel, (must, found)) in must.iter().zip(found).enumerate() {
                let off = (f64::from(found) - must.open).abs();
                prop_assert!(
                    !must.certain || off <= must.bound,
                    "{} pixel {}: {} for {} within {:e}",
                    name, pixel, found, must.open, must.bound
                );
            }
        }
    }
}
