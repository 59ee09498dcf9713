//! Triangles at random, the same for every seed.

use super::shot::Vertex;
use crate::generate::Random;
use crate::vector::{add, cross, dot, normalize, scale};

/// Large, small, thin and overlapping triangles in a box of this half-width around the
/// origin.
pub fn mix(random: &mut Random, count: usize, half: f64) -> Vec<[Vertex; 3]> {
    let one = |number: usize, random: &mut Random| {
        let centre = [half; 3].map(|side| side * random.signed());
        let length = half * [0.05, 0.3, 1.2, 1.6][number % 4];
        let width = length * [0.7, 0.2, 0.9, 0.01][number % 4];
        let along = direction(random);
        triangle(random, centre, along, [length, width])
    };
    (0..count).map(|number| one(number, random)).collect()
}

/// Triangles of one length and width, in every direction, with centres in a box.
pub fn slivers(random: &mut Random, count: usize, size: [f64; 2]) -> Vec<[Vertex; 3]> {
    let one = |random: &mut Random| {
        let centre = [0.8, 0.6, 0.6].map(|side| side * random.signed());
        let along = direction(random);
        triangle(random, centre, along, size)
    };
    (0..count).map(|_| one(random)).collect()
}

/// Triangles in planes that contain the direction z but for an angle (radians): seen
/// along z, they are as narrow as its sine.
pub fn grazing(random: &mut Random, count: usize, angle: f64) -> Vec<[Vertex; 3]> {
    let one = |random: &mut Random| {
        let centre = [0.9, 0.6, 0.5].map(|side| side * random.signed());
        let turn = std::f64::consts::TAU * random.unit();
        let (sine, cosine) = (libm::sin(turn), libm::cos(turn));
        let across = [cosine, sine, 0.0];
        let (flat, deep) = (libm::sin(angle), libm::cos(angle));
        let down = [-sine * flat, cosine * flat, deep];
        let mut corner = || {
            let [u, v] = [0.7 * random.signed(), 0.9 * random.signed()];
            add(centre, add(scale(across, u), scale(down, v)))
        };
        [corner(), corner(), corner()]
    };
    (0..count).map(|_| one(random)).collect()
}

/// A triangle across a long range of distances from an eye at the origin that looks
/// along -z: corners between two distances, evenly in their logarithm.
pub fn deep(random: &mut Random, count: usize, [near, far]: [f64; 2]) -> Vec<[Vertex; 3]> {
    let one = |random: &mut Random| {
        let ratio = libm::log2(far / near);
        let start = random.unit();
        [0, 1, 2].map(|_| {
            // Beyond the planes too, so that some triangles are cut.
            let share = start + 0.35 * random.signed();
            let distance = near * libm::exp2(1.2 * share * ratio - 0.1 * ratio);
            let beside = [0.6, 0.4].map(|side| side * distance * random.signed());
            [beside[0], beside[1], -distance]
        })
    };
    (0..count).map(|_| one(random)).collect()
}

/// Layers that cover the whole picture, at random depths and slightly tilted.
pub fn layers(random: &mut Random, count: usize) -> Vec<[Vertex; 3]> {
    let one = |random: &mut Random| {
        let depth = random.signed();
        let tilt = [random.signed(), random.signed()];
        [[-9.0, -9.0], [9.0, -9.0], [0.0, 12.0]].map(|[x, y]: [f64; 2]| {
            let z = depth + 0.02 * (tilt[0] * x + tilt[1] * y);
            [x, y, z]
        })
    };
    (0..count).map(|_| one(random)).collect()
}

/// A triangle of a longest edge and an altitude over it.
fn triangle(
    random: &mut Random,
    centre: Vertex,
    along: Vertex,
    [length, width]: [f64; 2],
) -> [Vertex; 3] {
    let across = loop {
        let normal = cross(along, direction(random));
        if dot(normal, normal) > 0.01 {
            break normalize(cross(normalize(normal), along));
        }
    };
    let foot = length * (random.unit() - 0.5);
    let end = |s: f64| add(centre, scale(along, s * length));
    let apex = add(add(centre, scale(along, foot)), scale(across, width));
    [end(-0.5), end(0.5), apex]
}

/// Uniform on the sphere: points of the cube that lie in the ball (von Neumann).
fn direction(random: &mut Random) -> Vertex {
    loop {
        let v = [random.signed(), random.signed(), random.signed()];
        if (0.01..=1.0).contains(&dot(v, v)) {
            return normalize(v);
        }
    }
}
