//! Whatever rounding, fusing, flushing and order WGSL allows stays inside the bounds, and
//! comes near them.

use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;
use triptych_spec::abuffer::NOTHING;
use triptych_spec::bound::{Bounded, TINY, U};
use triptych_spec::camera::{Camera, Projection};
use triptych_spec::grid::lattice::Lattice;
use triptych_spec::rsm::{
    Colour, Frame, Gbuffer, Lamp, Light, Model, Parameters, Place, Surface, View, blur, compose,
    direct, project, rsm, term,
};
use triptych_spec::scene::Size;

use super::kernels::{averaged, f32s, gathered, lit, placed, plain, point};
use super::{PARAMETERS, Scene, scenes, unmoved};
use crate::config;
use crate::loose::Loose;

/// Stages that are evaluated loosely.
const STAGES: [&str; 7] = [
    "point",
    "place",
    "intensity",
    "direct",
    "gather",
    "blur",
    "compose",
];

/// An error over its bound; more than 1 is outside.
fn over(bounded: Bounded, observed: f32) -> f64 {
    let error = (f64::from(observed) - bounded.value).abs();
    match error == 0.0 || bounded.bound.is_infinite() {
        true => 0.0,
        false => error / bounded.bound,
    }
}

fn worst(colour: &Colour, observed: [f32; 3]) -> f64 {
    (0..3)
        .map(|i| over(colour[i], observed[i]))
        .fold(0.0, f64::max)
}

/// Inputs of a stage: rounded once.
pub fn given(colours: &[Colour]) -> Vec<Colour> {
    let round = |c: &Colour| {
        let values = f32s(c.map(|c| c.value));
        values.map(|c| Bounded {
            value: f64::from(c),
            bound: 0.0,
        })
    };
    colours.iter().map(round).collect()
}

/// The largest error over its bound that an evaluation comes to, of each stage.
fn strain(scene: &Scene, seed: u64, way: usize) -> [f64; 7] {
    let m = &mut Loose::new(seed);
    let frame = scene.frame();
    let mut most = [0.0; 7];
    let mut note = |stage: usize, ratio: f64| most[stage] = f64::max(most[stage], ratio);
    let (inputs, b) = (
        [&frame.direct.light, &frame.all].map(|c| given(c)),
        given(&frame.blocked.light),
    );
    for (pixel, surface) in frame.seen.surfaces.iter().enumerate() {
        let Some(surface) = surface else { continue };
        let expected = unmoved(&scene.model, surface, scene.parameters.offset);
        let observed = f32s(point(m, scene, pixel, surface.triangle).map(f64::from));
        for axis in 0..3 {
            let bounded = Bounded {
                value: f64::from(expected[axis]),
                bound: f64::from(frame.seen.stray[pixel][axis]),
            };
            note(0, over(bounded, observed[axis]));
        }
        let view = &scene.lamp.view;
        if let Some(bounded) = project::<Bounded>(view, surface.point) {
            note(1, worst(&bounded, placed(m, view, surface.point)));
        }
        note(
            4,
            worst(&frame.all[pixel], gathered(m, scene, &frame, pixel, way)),
        );
        if frame.direct.lit[pixel] {
            note(3, worst(&frame.direct.light[pixel], lit(m, scene, surface)));
        }
    }
    for (texel, surface) in frame.rsm.seen.surfaces.iter().enumerate() {
        let Some(surface) = surface else { continue };
        let [weight] = f32s([scene.lamp.weight(texel, scene.parameters.stride)]);
        let colour = scene.model.colours[surface.triangle as usize];
        let observed = [0, 1, 2].map(|i| {
            let strength = m.mul(weight, scene.lamp.strength[i]);
            m.mul(strength, colour[i])
        });
        note(2, worst(&frame.rsm.intensity[texel], observed));
    }
    let mean = blur(&scene.model, &frame.coarse, &b, &scene.parameters);
    for (pixel, mean) in mean.iter().enumerate() {
        note(5, worst(mean, averaged(m, scene, &frame, &b, pixel)));
    }
    note(6, composed(m, scene, &frame, &inputs, &given(&mean)));
    most
}

fn composed(
    m: &mut Loose,
    scene: &Scene,
    frame: &Frame,
    inputs: &[Vec<Colour>; 2],
    b: &[Colour],
) -> f64 {
    let [direct, all] = inputs;
    let make = |all: &[Colour], b: &[Colour]| {
        let background = [0.25, 0.5, 0.75];
        let light = [&direct[..], all];
        compose(
            &scene.model,
            &frame.seen,
            light,
            (&frame.coarse, b),
            &scene.parameters,
            background,
        )
    };
    let picture = make(all, b);
    // Which pixel of B is taken, from a buffer that numbers them: the colours are 1.
    let white = Model {
        colours: vec![[1.0; 3]; scene.model.colours.len()],
        ..scene.model.clone()
    };
    let value = |value: f64| [Bounded { value, bound: 0.0 }; 3];
    let numbers: Vec<Colour> = (0..b.len()).map(|n| value(n as f64)).collect();
    let many = vec![value(1e4); all.len()];
    let dark = vec![value(0.0); all.len()];
    let taken = compose(
        &white,
        &frame.seen,
        [&dark, &many],
        (&frame.coarse, &numbers),
        &scene.parameters,
        [1e4; 3],
    );
    let pixel = |pixel: usize| {
        let Some(surface) = &frame.seen.surfaces[pixel] else {
            return worst(&picture[pixel], [0.25, 0.5, 0.75]);
        };
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a row"
        )]
        let from = (1e4 - taken[pixel][0].value) as usize;
        let colour = scene.model.colours[surface.triangle as usize];
        let [d, a, b] = [&direct[pixel], &all[pixel], &b[from]].map(plain);
        worst(
            &picture[pixel],
            [0, 1, 2].map(|i| {
                let indirect = m.sub(a[i], b[i]).max(0.0);
                let light = m.add(d[i], indirect);
                m.mul(light, colour[i])
            }),
        )
    };
    (0..all.len()).map(pixel).fold(0.0, f64::max)
}

proptest! {
    #![proptest_config(config(400))]

    /// Inside.
    #[test]
    fn inside(scene in scenes(), seed: u64, way in 0..2_usize) {
        for (stage, ratio) in STAGES.into_iter().zip(strain(&scene, seed, way)) {
            prop_assert!(ratio <= 1.0, "{} by {}", stage, ratio);
        }
    }
}

/// Near: an evaluation of some scene comes to a thousandth of the bound, in every stage.
#[test]
fn near() {
    let mut runner = TestRunner::deterministic();
    let mut most = [0.0_f64; 7];
    for seed in 0..200 {
        let scene = scenes().new_tree(&mut runner).expect("a scene").current();
        let strain = strain(&scene, seed, 0);
        (0..7).for_each(|i| most[i] = most[i].max(strain[i]));
    }
    for (stage, ratio) in STAGES.into_iter().zip(most) {
        println!("{stage}: {ratio:.3}");
        assert!(ratio >= 1e-3, "{stage} comes only to {ratio} of its bound");
    }
}

/// Two triangles that face each other along x, and a point before each.
fn face_to_face() -> (Model, [Surface; 2]) {
    let corners = |x: i32, far: i32| [[x, 0, 0], [x, far, 0], [x, 0, far]];
    let vertices = [corners(0, 64), corners(4096, 64)].concat();
    let model = Model::new(vertices, super::rows(2), vec![[0.5; 3]; 2]).expect("a model");
    let surface = |triangle, side, x| Surface {
        triangle,
        side,
        point: [x, 9, 9],
    };
    (model, [surface(0, 1, 2), surface(1, -1, 4094)])
}

/// A bound is so many roundings of its value.
fn is_off_by(bounded: Bounded, roundings: f64) {
    let found = bounded.bound / (U * bounded.value);
    assert!((found - roundings).abs() < 1e-3, "{found}: {bounded:?}");
}

/// Bounds of light that comes along an axis, counted by hand: a dot product meets 3
/// roundings, a quotient 2.5, `inverseSqrt` 2 and half of what its operand has.
#[test]
fn terms_by_hand() {
    let (model, [to, surface]) = face_to_face();
    let light = Light {
        surface,
        intensity: [3.0, 0.0, 1.0],
    };
    let sum = term(&model, &to, &light, 1).expect("face to face");
    let expected = 3.0 / f64::from(4092_i32 * 4092);
    assert!((sum[0].value / expected - 1.0).abs() < 1e-14);
    // Twice p / D with 3 + 3 + 2.5, and two products.
    is_off_by(sum[0], 19.0);
    assert_eq!((sum[1].value, sum[1].bound <= 4.0 * TINY), (0.0, true));
    // The clamp is rounded once, not three times.
    let near = term(&model, &to, &light, 1 << 40).expect("face to face");
    is_off_by(near[0], 15.0);
}

/// The same of light that comes from a lamp.
#[test]
fn lamps_by_hand() {
    let (model, [to, _]) = face_to_face();
    let size = Size {
        width: 1,
        height: 1,
    };
    let lattice = Lattice {
        centre: [0.0; 3],
        exponent: 0,
    };
    let camera = |projection| Camera {
        eye: [1024.0, 9.0, 9.0],
        target: [0.0, 9.0, 9.0],
        up: [0.0, 1.0, 0.0],
        projection,
        near: 1.0,
        far: 8192.0,
    };
    // Cosine: 3 + (3 / 2 + 2) + 1. Ratio: 3.5 + 1, squared 10; product with it, and strength.
    let spot = Projection::Perspective { fov: 90.0 };
    for (projection, count) in [
        (spot, 19.5),
        (Projection::Orthographic { height: 8.0 }, 8.5),
    ] {
        let view = View::new(&camera(projection), &lattice, size).expect("a view");
        let lamp = Lamp::new(view, [1.0; 3], 512).expect("a lamp");
        let seen = Gbuffer {
            size,
            keys: vec![0],
            surfaces: vec![Some(to)],
            stray: vec![[0; 3]],
        };
        let places = [Some(Place {
            texel: [0, 0],
            key: 0,
        })];
        let direct = direct(&model, &seen, &places, &lamp, &[NOTHING], &PARAMETERS);
        is_off_by(direct.light[0][0], count);
        // The weight, given rounded, and two products.
        let parameters = Parameters {
            radius: 0,
            ..PARAMETERS
        };
        let rsm = rsm(&model, &lamp, &parameters);
        is_off_by(rsm.intensity[0][0], 3.0);
    }
}
