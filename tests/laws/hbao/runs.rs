//! What makes no run is named; runs leave the same.

use triptych_gpu::error::GpuError;
use triptych_gpu::hbao::{DENOISE_MAX, Hbao, Pixel, SLICES_MAX, Screen, Settings, Span};
use triptych_gpu::timer::{Clock, Timer};
use triptych_spec::ldm::Falloff;
use triptych_spec::scene::Size;

use super::scenes::{Eye, Shape};
use super::{openness, settings};

/// A pixel.
fn one() -> Screen {
    Screen {
        size: Size {
            width: 1,
            height: 1,
        },
        near: true,
        scale: [1.0; 2],
        pixels: vec![Pixel {
            normal: [0.0, 0.0, -1.0],
            depth: 7.0,
        }],
    }
}

#[test]
fn a_pixel_alone_and_nothing_are_open() {
    let screen = one();
    let plain = settings(Falloff::None, 1, 1);
    assert!(
        openness(&screen, plain)
            .iter()
            .all(|(_, open)| *open == [1.0])
    );
    let nothing = Screen {
        pixels: vec![Pixel::NOTHING],
        ..screen.clone()
    };
    let smooth = Settings {
        denoise: 1,
        ..plain
    };
    assert!(
        openness(&nothing, smooth)
            .iter()
            .all(|(_, open)| *open == [1.0])
    );
}

#[test]
fn limits_are_named() {
    let screen = one();
    let plain = settings(Falloff::None, 1, 1);
    let (gpu, kernels) = &crate::adapters::devices()[0];
    let power = Falloff::Distance { most: 1, power: 9 };
    for (settings, needed) in [
        (Settings { slices: 0, ..plain }, 0),
        (
            Settings {
                slices: SLICES_MAX + 1,
                ..plain
            },
            65,
        ),
        (Settings { steps: 0, ..plain }, 0),
        (
            Settings {
                steps: 2049,
                ..plain
            },
            4098,
        ),
        (
            Settings {
                denoise: DENOISE_MAX + 1,
                ..plain
            },
            9,
        ),
        (
            Settings {
                falloff: power,
                ..plain
            },
            9,
        ),
        (
            Settings {
                detail: 32,
                ..plain
            },
            32,
        ),
    ] {
        let error = Hbao::new(gpu, &kernels[0], &screen, settings).err();
        assert!(
            matches!(error, Some(GpuError::Limit { needed: n, .. }) if n == needed),
            "{settings:?}: {error:?}"
        );
    }
}

/// Parts are timed, and leave what a run leaves.
#[test]
fn timed_runs_find_the_same() {
    let ball = Shape::Ball {
        centre: [0.0, 0.0, 500.0],
        radius: 150.0,
    };
    let normal = [0.0, 0.0, -1.0];
    let floor = Shape::Half { normal, at: -700.0 };
    let screen = Eye::square(33, true, 33.0).screen(&[ball, floor]);
    for (gpu, kernels) in crate::adapters::devices() {
        for (denoise, spans) in [(0, 2), (3, 3)] {
            let settings = Settings {
                denoise,
                ..settings(Falloff::None, 2, 4)
            };
            let made = Hbao::new(gpu, &kernels[0], &screen, settings).expect("within the limits");
            let all = [Span::Prepare, Span::Horizons, Span::Denoise];
            assert_eq!(made.spans().collect::<Vec<_>>(), all[..spans]);
            let clock = Clock::Host("asked".to_owned());
            let timer =
                Timer::new(gpu, &clock, u32::try_from(spans).expect("few")).expect("a timer");
            let seconds = made.time(&timer).expect("it runs");
            assert!(
                seconds.len() == spans && seconds.iter().all(|s| *s > 0.0),
                "{seconds:?}"
            );
            let timed = made.openness().expect("it is there");
            made.run().expect("it runs");
            assert_eq!(timed, made.openness().expect("it is there"), "{}", gpu.name);
        }
    }
}
