//! Random scenes on every adapter, with words and with native integers: each stage from the
//! spec's input decides as the spec does, and reports within its bounds.

use proptest::prelude::*;
use triptych_gpu::rsm::Stages;
use triptych_spec::abuffer::NOTHING;
use triptych_spec::bound::Bounded;
use triptych_spec::rsm::{Colour, Frame, PLACE_MAX, Surface, blur, compose, project};
use triptych_spec::vertex::DEPTH_ONE;

use super::kernels::plain;
use super::loose::given;
use super::{Scene, scenes};
use crate::adapters::devices;
use crate::config;

type Verdict = Result<(), TestCaseError>;

fn triangles(surfaces: &[Option<Surface>]) -> Vec<u32> {
    let row = |s: &Option<Surface>| s.map_or(NOTHING, |s| s.triangle);
    surfaces.iter().map(row).collect()
}

fn f32s(colours: &[Colour]) -> Vec<[f32; 3]> {
    colours.iter().map(plain).collect()
}

fn admitted(what: &str, expected: &[Colour], observed: &[[f32; 3]]) -> Verdict {
    prop_assert_eq!(expected.len(), observed.len(), "{}", what);
    for (at, (expected, observed)) in expected.iter().zip(observed).enumerate() {
        for (expected, observed) in expected.iter().zip(observed) {
            prop_assert!(
                expected.admits(f64::from(*observed)),
                "{} {}: {} for {:?}",
                what,
                at,
                observed,
                expected
            );
        }
    }
    Ok(())
}

/// Triangles and sides equal, points no farther than the spec lets them stray.
fn near(expected: &[Option<Surface>], stray: &[[u32; 3]], observed: &[Option<Surface>]) -> Verdict {
    prop_assert_eq!(expected.len(), observed.len());
    for (at, (expected, observed)) in expected.iter().zip(observed).enumerate() {
        let sides = |s: &Option<Surface>| s.map(|s| (s.triangle, s.side));
        prop_assert_eq!(sides(expected), sides(observed), "pixel {}", at);
        if let (Some(expected), Some(observed)) = (expected, observed) {
            let apart = |axis: usize| expected.point[axis].abs_diff(observed.point[axis]);
            prop_assert!(
                (0..3).all(|axis| apart(axis) <= stray[at][axis]),
                "pixel {}: {:?} for {:?} within {:?}",
                at,
                observed,
                expected,
                stray[at]
            );
        }
    }
    Ok(())
}

/// Places are the spec's, or those of numbers within the bound of `project`.
fn places(scene: &Scene, frame: &Frame, stages: &mut Stages) -> Verdict {
    let observed = stages.place(&frame.seen.surfaces).unwrap();
    for (pixel, surface) in frame.seen.surfaces.iter().enumerate() {
        let (expected, observed) = (&frame.places[pixel], &observed[pixel]);
        if expected == observed {
            continue;
        }
        let surface = surface.expect("a place of nothing");
        let numbers = project::<Bounded>(&scene.lamp.view, surface.point);
        let (Some(numbers), Some(observed)) = (numbers, observed) else {
            // Only w within its bound of 0, which the cameras here are far from.
            return Err(TestCaseError::fail(format!("{expected:?}, {observed:?}")));
        };
        let key = i32::try_from(observed.key).unwrap();
        let edge = [-PLACE_MAX, PLACE_MAX];
        let ranges = [edge, edge, [0, DEPTH_ONE]].map(|range| range.map(f64::from));
        let integers = [observed.texel[0], observed.texel[1], key].map(f64::from);
        for ((number, [least, most]), integer) in numbers.into_iter().zip(ranges).zip(integers) {
            let floor = |c: f64| c.floor().clamp(least, most);
            let low = floor(number.value - number.bound);
            let high = floor(number.value + number.bound);
            prop_assert!(
                low <= integer && integer <= high,
                "{}: {:?}",
                integer,
                number
            );
        }
    }
    Ok(())
}

fn agrees(scene: &Scene, frame: &Frame, stages: &mut Stages) -> Verdict {
    let (seen, map) = (&frame.seen.surfaces, &frame.rsm.seen);
    near(
        seen,
        &frame.seen.stray,
        &stages.gbuffer(&triangles(seen)).unwrap(),
    )?;
    let (surfaces, intensity) = stages.rsm(&triangles(&map.surfaces)).unwrap();
    near(&map.surfaces, &map.stray, &surfaces)?;
    admitted("intensity", &frame.rsm.intensity, &intensity)?;
    places(scene, frame, stages)?;

    let (lit, light) = stages.direct(seen, &frame.places, &map.keys).unwrap();
    prop_assert_eq!(&lit, &frame.direct.lit);
    admitted("direct", &frame.direct.light, &light)?;
    let lights = frame.rsm.lights();
    let all = stages.gather(seen, &frame.places, &lights).unwrap();
    admitted("gather", &frame.all, &all)?;
    let blocked = stages.block(seen, &frame.places, &lights).unwrap();
    prop_assert_eq!(blocked.rays, frame.blocked.rays);
    prop_assert_eq!(&blocked.bits, &frame.blocked.bits);
    admitted("block", &frame.blocked.light, &blocked.light)?;

    let (model, parameters) = (&scene.model, &scene.parameters);
    let buffer = given(&frame.blocked.light);
    let expected = blur(model, &frame.coarse, &buffer, parameters);
    let observed = stages.blur(seen, &f32s(&buffer)).unwrap();
    admitted("blur", &expected, &observed)?;
    let [direct, all, blurred] =
        [&frame.direct.light, &frame.all, &frame.blurred].map(|c| given(c));
    let expected = compose(
        model,
        &frame.seen,
        [&direct, &all],
        (&frame.coarse, &blurred),
        parameters,
        scene.setting().background,
    );
    let inputs = [&direct, &all].map(|c| f32s(c));
    let observed = stages.compose(seen, inputs.each_ref().map(|c| &c[..]), &f32s(&blurred));
    admitted("compose", &expected, &observed.unwrap())
}

proptest! {
    #![proptest_config(config(48))]

    #[test]
    fn random_frames(scene in scenes()) {
        let frame = scene.frame();
        for (gpu, kernels) in devices() {
            for kernels in kernels {
                let mut stages = Stages::new(gpu, kernels, &scene.setting()).unwrap();
                agrees(&scene, &frame, &mut stages)?;
            }
        }
    }
}
