//! Whatever rounding, fusing, flushing and order WGSL allows stays inside the bounds, and
//! comes near them.

use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;
use triptych_spec::bound::Bounded;
use triptych_spec::rsm::{Colour, Frame, Light, Surface, Viewpoint, blur, compose, project, same};
use triptych_spec::vertex::{DEPTH_ONE, viewport};

use super::{Scene, facing, scenes, unmoved};
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

#[expect(clippy::cast_possible_truncation, reason = "rounding is meant")]
fn f32s<const N: usize>(exact: [f64; N]) -> [f32; N] {
    exact.map(|c| c as f32)
}

/// `a . b`, in some order, fused or not.
fn dot(machine: &mut Loose, a: &[f32], b: &[f32]) -> f32 {
    if a.len() == 3 && machine.choose(2) == 0 {
        let first = machine.mul(a[0], b[0]);
        let second = machine.mul_add(a[1], b[1], first);
        return machine.mul_add(a[2], b[2], second);
    }
    let terms: Vec<f32> = a.iter().zip(b).map(|(a, b)| machine.mul(*a, *b)).collect();
    machine.sum(&terms)
}

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
fn given(colours: &[Colour]) -> Vec<Colour> {
    let round = |c: &Colour| {
        let values = f32s(c.map(|c| c.value));
        values.map(|c| Bounded {
            value: f64::from(c),
            bound: 0.0,
        })
    };
    colours.iter().map(round).collect()
}

fn plain(colour: &Colour) -> [f32; 3] {
    f32s(colour.map(|c| c.value))
}

/// The point of a pixel by the formula, snapped, not moved.
fn point(m: &mut Loose, scene: &Scene, pixel: usize, triangle: u32) -> [i32; 3] {
    let corners = scene.model.corners(triangle);
    let matrix = viewport(scene.eye.size).times(&scene.eye.matrix).rows;
    let width = scene.eye.size.width as usize;
    let middle = f32s([pixel % width, pixel / width].map(|c| c as f64 + 0.5));
    let from = corners.map(|corner| {
        let [a, b, c] = f32s(corner.map(f64::from));
        let [x, y, w] = [0, 1, 3].map(|r| dot(m, &f32s(matrix[r]), &[a, b, c, 1.0]));
        [m.mul_add(-middle[0], w, x), m.mul_add(-middle[1], w, y)]
    });
    let mut edge = |j: usize, k: usize| {
        let product = m.mul(from[j][1], from[k][0]);
        m.mul_add(from[j][0], from[k][1], -product)
    };
    let edges = [edge(1, 2), edge(2, 0), edge(0, 1)];
    let sign = m.sum(&edges).signum();
    let weights = edges.map(|e| (e * sign).max(0.0));
    let total = m.sum(&weights);
    let shares = [m.div(weights[1], total), m.div(weights[2], total)];
    [0, 1, 2].map(|axis| {
        let sides = corners.map(|corner| corner[axis]);
        let [a, b, c] = f32s(sides.map(f64::from));
        let second = m.mul(shares[1], c - a);
        let step = m.mul_add(shares[0], b - a, second);
        let met = m.add(a, step);
        #[expect(clippy::cast_possible_truncation, reason = "clamped")]
        let snapped = (f64::from(met) + 0.5).floor() as i32;
        snapped.clamp(*sides.iter().min().unwrap(), *sides.iter().max().unwrap())
    })
}

/// The unit normal on the side that is seen, and a difference.
fn projected(m: &mut Loose, scene: &Scene, surface: &Surface, d: [f32; 3]) -> f32 {
    let side = if surface.side < 0 { -1.0 } else { 1.0 };
    let unit = scene.model.face(surface.triangle).unit.map(|c| c * side);
    dot(m, &unit, &d).max(0.0)
}

fn difference(to: [i32; 3], from: [i32; 3]) -> [f32; 3] {
    f32s([0, 1, 2].map(|i| f64::from(to[i] - from[i])))
}

fn term(m: &mut Loose, scene: &Scene, to: &Surface, light: &Light, way: usize) -> [f32; 3] {
    let d = difference(light.surface.point, to.point);
    let p = projected(m, scene, to, d);
    let q = projected(m, scene, &light.surface, d.map(|c| -c));
    let [clamp] = f32s([scene.parameters.clamp as f64]);
    let square = dot(m, &d, &d).max(clamp);
    let factor = match way {
        0 => {
            let (a, b) = (m.div(p, square), m.div(q, square));
            m.mul(a, b)
        }
        _ => {
            let (a, b) = (m.mul(p, q), m.mul(square, square));
            m.div(a, b)
        }
    };
    light.intensity.map(|c| m.mul(factor, c))
}

/// The sum of some pixels' kernel.
fn gathered(m: &mut Loose, scene: &Scene, frame: &Frame, pixel: usize, way: usize) -> [f32; 3] {
    let (Some(to), Some(place)) = (&frame.seen.surfaces[pixel], &frame.places[pixel]) else {
        return [0.0; 3];
    };
    let lights = frame.rsm.lights();
    let mut terms: [Vec<f32>; 3] = Default::default();
    for (_, texel) in scene.kernel(place.texel) {
        let Some(light) = &lights[texel] else {
            continue;
        };
        let faced = facing(&scene.model, to, light.surface.point)
            && facing(&scene.model, &light.surface, to.point);
        if faced {
            let term = term(m, scene, to, light, way);
            (0..3).for_each(|i| terms[i].push(term[i]));
        }
    }
    terms.map(|terms| m.sum(&terms))
}

fn lit(m: &mut Loose, scene: &Scene, surface: &Surface) -> [f32; 3] {
    let viewpoint = scene.lamp.view.viewpoint;
    let d = f32s(viewpoint.from(surface.point).map(f64::from));
    let along = projected(m, scene, surface, d);
    let square = dot(m, &d, &d);
    let inverse = m.inverse_sqrt(square);
    let cosine = m.mul(along, inverse);
    let factor = match viewpoint {
        Viewpoint::Far(_) => cosine,
        Viewpoint::Near(_) => {
            let [reference] = f32s([f64::from(scene.lamp.reference)]);
            let ratio = m.mul(reference, inverse);
            let squared = m.mul(ratio, ratio);
            m.mul(cosine, squared)
        }
    };
    scene.lamp.strength.map(|c| m.mul(factor, c))
}

/// The mean of a square of buffer B.
fn averaged(
    m: &mut Loose,
    scene: &Scene,
    frame: &Frame,
    input: &[Colour],
    pixel: usize,
) -> [f32; 3] {
    let Some(middle) = &frame.coarse.surfaces[pixel] else {
        return [0.0; 3];
    };
    let (width, radius) = (
        frame.coarse.size.width as usize,
        scene.parameters.blur as usize,
    );
    let taken = (0..input.len()).filter(|other| {
        let near = (other % width).abs_diff(pixel % width) <= radius
            && (other / width).abs_diff(pixel / width) <= radius;
        let surface = frame.coarse.surfaces[*other].as_ref();
        near && surface.is_some_and(|s| same(&scene.model, middle, s, scene.parameters.edge))
    });
    let taken: Vec<usize> = taken.collect();
    [0, 1, 2].map(|i| {
        let terms: Vec<f32> = taken.iter().map(|at| plain(&input[*at])[i]).collect();
        let sum = m.sum(&terms);
        let [count] = f32s([terms.len() as f64]);
        if terms.len() == 1 {
            sum
        } else {
            m.div(sum, count)
        }
    })
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
        note(1, placed(m, scene, surface.point));
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
        let [weight] = f32s([scene.lamp.weight(texel)]);
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

fn placed(m: &mut Loose, scene: &Scene, point: [i32; 3]) -> f64 {
    let view = &scene.lamp.view;
    let Some(bounded) = project::<Bounded>(view, point) else {
        return 0.0;
    };
    let [a, b, c] = f32s(point.map(f64::from));
    let rows = viewport(view.size).times(&view.matrix).rows;
    let [x, y, z, w] = rows.map(|row| dot(m, &f32s(row), &[a, b, c, 1.0]));
    let depth = m.div(z, w);
    let observed = [
        m.div(x, w),
        m.div(y, w),
        m.mul(depth, f32s([f64::from(DEPTH_ONE)])[0]),
    ];
    worst(&bounded, observed)
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
    let white = triptych_spec::rsm::Model {
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
