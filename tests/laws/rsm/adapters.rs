//! Random scenes on every adapter, with words and with native integers: each stage from the
//! spec's input decides as the spec does, and reports within its bounds.

use proptest::prelude::*;
use triptych_gpu::grid::Shape;
use triptych_gpu::raster::Path;
use triptych_gpu::rsm::{Made, Stages, Timed, Work};
use triptych_gpu::timer::{Clock, Timer};
use triptych_spec::abuffer::NOTHING;
use triptych_spec::bound::Bounded;
use triptych_spec::rsm::{
    Coarse, Colour, Frame, Gbuffer, Light, PLACE_MAX, Place, Surface, block, blur, compose, direct,
    gather, place, project,
};
use triptych_spec::scene::Size;
use triptych_spec::vertex::{DEPTH_ONE, SUBPIXEL_BITS, primitives};

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
fn placed(scene: &Scene, seen: &[Option<Surface>], places: &[Option<Place>]) -> Verdict {
    for (surface, observed) in seen.iter().zip(places) {
        let seen = Gbuffer {
            size: Size {
                width: 1,
                height: 1,
            },
            keys: vec![0],
            surfaces: vec![*surface],
            stray: vec![[0; 3]],
        };
        let expected = &place(&scene.lamp.view, &seen)[0];
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
    placed(scene, seen, &stages.place(seen).unwrap())?;

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

/// Numbers that a device made, as inputs.
fn exact(colours: &[[f32; 3]]) -> Vec<Colour> {
    let one = |c: f32| Bounded {
        value: f64::from(c),
        bound: 0.0,
    };
    colours.iter().map(|c| c.map(one)).collect()
}

/// A whole frame of a device's own: each stage follows from what it made before.
fn follows(scene: &Scene, frame: &Frame, made: &Made) -> Verdict {
    near(&frame.seen.surfaces, &frame.seen.stray, &made.seen)?;
    near(
        &frame.rsm.seen.surfaces,
        &frame.rsm.seen.stray,
        &made.lights,
    )?;
    prop_assert_eq!(&made.keys, &frame.rsm.seen.keys);
    admitted("intensity", &frame.rsm.intensity, &made.intensities)?;
    placed(scene, &made.seen, &made.places)?;
    let (model, lamp, parameters) = (&scene.model, &scene.lamp, &scene.parameters);
    let seen = Gbuffer {
        surfaces: made.seen.clone(),
        ..frame.seen.clone()
    };
    let light = |(surface, intensity): (&Option<Surface>, &[f32; 3])| {
        let (surface, intensity) = ((*surface)?, *intensity);
        Some(Light { surface, intensity })
    };
    let lights: Vec<_> = made
        .lights
        .iter()
        .zip(&made.intensities)
        .map(light)
        .collect();
    let expected = direct(model, &seen, &made.places, lamp, &made.keys, parameters);
    prop_assert_eq!(&made.lit, &expected.lit);
    admitted("direct", &expected.light, &made.direct)?;
    let size = lamp.view.size;
    let expected = gather(model, &seen, &made.places, &lights, size, parameters);
    admitted("gather", &expected, &made.all)?;
    let cells = (&scene.grid, &scene.blockers);
    let expected = block(model, &seen, &made.places, &lights, size, cells, parameters);
    prop_assert_eq!(&made.bits, &expected.bits);
    admitted("block", &expected.light, &made.blocked)?;
    let coarse = Coarse::new(&seen, parameters);
    let expected = blur(model, &coarse, &exact(&made.blocked), parameters);
    admitted("blur", &expected, &made.blurred)?;
    let inputs = [&made.direct, &made.all].map(|c| exact(c));
    let expected = compose(
        model,
        &seen,
        inputs.each_ref().map(|c| &c[..]),
        (&coarse, &exact(&made.blurred)),
        parameters,
        scene.setting().background,
    );
    admitted("compose", &expected, &made.picture)
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

    #[test]
    fn whole_frames(scene in scenes()) {
        let frame = scene.frame();
        let drawn = [&scene.eye, &scene.lamp.view]
            .map(|view| primitives(&view.scene(&scene.model), SUBPIXEL_BITS));
        for (gpu, kernels) in devices() {
            for kernels in kernels {
                let work = Work {
                    setting: scene.setting(),
                    drawn: drawn.each_ref(),
                    path: Path::Compute,
                    cells: Shape::checked(gpu, kernels, &scene.blockers, &scene.grid.axes).unwrap(),
                };
                let timed = Timed::new(gpu, kernels, &work).unwrap();
                let timer = Timer::new(gpu, &Clock::Host(String::new()), 1).unwrap();
                // What a frame leaves does not change the next.
                for _ in 0..2 {
                    timed.time_whole(&timer).unwrap();
                    follows(&scene, &frame, &timed.made().unwrap())?;
                }
            }
        }
    }
}
