//! The stages in `f32`, as a kernel may evaluate them.

use triptych_spec::rsm::{Colour, Frame, Light, Surface, View, Viewpoint, same};
use triptych_spec::vertex::{DEPTH_ONE, viewport};

use super::{Scene, facing};
use crate::loose::Loose;

#[expect(clippy::cast_possible_truncation, reason = "rounding is meant")]
pub fn f32s<const N: usize>(exact: [f64; N]) -> [f32; N] {
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

pub fn plain(colour: &Colour) -> [f32; 3] {
    f32s(colour.map(|c| c.value))
}

/// The point of a pixel by the formula, snapped, not moved.
pub fn point(m: &mut Loose, scene: &Scene, pixel: usize, triangle: u32) -> [i32; 3] {
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

pub fn term(m: &mut Loose, scene: &Scene, to: &Surface, light: &Light, way: usize) -> [f32; 3] {
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
pub fn gathered(m: &mut Loose, scene: &Scene, frame: &Frame, pixel: usize, way: usize) -> [f32; 3] {
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

pub fn lit(m: &mut Loose, scene: &Scene, surface: &Surface) -> [f32; 3] {
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
pub fn averaged(
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

/// A point in a view: texels and key.
pub fn placed(m: &mut Loose, view: &View, point: [i32; 3]) -> [f32; 3] {
    let [a, b, c] = f32s(point.map(f64::from));
    let rows = viewport(view.size).times(&view.matrix).rows;
    let [x, y, z, w] = rows.map(|row| dot(m, &f32s(row), &[a, b, c, 1.0]));
    let (depth, [one]) = (m.div(z, w), f32s([f64::from(DEPTH_ONE)]));
    [m.div(x, w), m.div(y, w), m.mul(depth, one)]
}
