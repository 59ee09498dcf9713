//! Triangles of the sweeps' scenes.

use super::super::shot::Vertex;
use super::super::triangles::mix;
use crate::generate::Random;
use crate::vector::{add, cross, normalize, scale};

pub(super) type Triangles = Vec<[Vertex; 3]>;

/// A quad as two triangles.
fn quad([a, b, c, d]: [Vertex; 4]) -> Triangles {
    vec![[a, b, c], [a, c, d]]
}

/// A square of this half-width around a point, in the plane of two axes of length 1.
pub(super) fn square(middle: Vertex, half: f64, [u, v]: [Vertex; 2]) -> Triangles {
    rectangle(middle, [scale(u, half), scale(v, half)])
}

/// A rectangle around a point, with half of each side.
pub(super) fn rectangle(middle: Vertex, [u, v]: [Vertex; 2]) -> Triangles {
    let corner = |a: f64, b: f64| add(middle, add(scale(u, a), scale(v, b)));
    quad([
        corner(-1.0, -1.0),
        corner(1.0, -1.0),
        corner(1.0, 1.0),
        corner(-1.0, 1.0),
    ])
}

/// A floor of two units, seen from above.
pub(super) fn floor() -> Triangles {
    square([0.0; 3], 1.0, [[1.0, 0.0, 0.0], [0.0, 0.0, -1.0]])
}

/// A box around a point, with half of each side along the axes.
pub(super) fn cuboid(middle: Vertex, half: Vertex) -> Triangles {
    let axis = |i: usize| {
        let mut axis = [0.0; 3];
        axis[i] = half[i];
        axis
    };
    let side = |i: usize, sign: f64| {
        let out = scale(axis(i), sign);
        rectangle(add(middle, out), [axis((i + 1) % 3), axis((i + 2) % 3)])
    };
    (0..3)
        .flat_map(|i| [side(i, -1.0), side(i, 1.0)].concat())
        .collect()
}

/// An octahedron around the origin, each of its faces cut into four so often, with corners at
/// distance 1: convex, but for rounding.
pub(super) fn ball(cuts: u32) -> Triangles {
    let end = |i: usize, sign: f64| {
        let mut end = [0.0; 3];
        end[i] = sign;
        end
    };
    let signs = [1.0, -1.0];
    let face = |n: usize| [0, 1, 2].map(|i| end(i, signs[n >> i & 1]));
    let cut = |[a, b, c]: [Vertex; 3]| {
        let middle = |p, q| normalize(add(p, q));
        let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
        [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
    };
    let whole: Triangles = (0..8).map(face).collect();
    (0..cuts).fold(whole, |faces, _| faces.into_iter().flat_map(cut).collect())
}

/// A floor, a wall, two boxes, and triangles in the air: about two units wide.
pub(super) fn room() -> Triangles {
    let mut all = floor();
    all.extend(rectangle(
        [0.0, 0.5, -1.0],
        [[1.0, 0.0, 0.0], [0.0, 0.5, 0.0]],
    ));
    all.extend(cuboid([-0.45, 0.2, 0.1], [0.2, 0.2, 0.25]));
    all.extend(cuboid([0.4, 0.15, -0.3], [0.15, 0.1, 0.3]));
    all.extend(in_the_air(8, [0.3, 0.8]));
    all
}

/// Triangles over a floor, the same for every count of them that begins alike; of sizes up to the
/// first number, at heights up to the second.
pub(super) fn in_the_air(count: usize, [size, height]: [f64; 2]) -> Triangles {
    let mut random = Random::new(SEED);
    let shapes = mix(&mut random, count, 1.0);
    let at = |random: &mut Random| {
        let up = 0.2 + 0.5 * (height - 0.2) * (1.0 + random.signed());
        [0.8 * random.signed(), up, 0.8 * random.signed()]
    };
    let moved = |[a, b, c]: [Vertex; 3], random: &mut Random| {
        let middle = scale(add(add(a, b), c), -1.0 / 3.0);
        let at = at(random);
        [a, b, c].map(|v| add(at, scale(add(v, middle), size)))
    };
    shapes.into_iter().map(|t| moved(t, &mut random)).collect()
}

/// Thin posts on a floor, as far apart as they are from each other's.
pub(super) fn comb() -> Triangles {
    let mut all = floor();
    for i in 0..6 {
        let x = -0.75 + 0.3 * f64::from(i);
        all.extend(rectangle(
            [x, 0.2, 0.1 * x],
            [[0.03, 0.0, 0.01], [0.0, 0.2, 0.0]],
        ));
        all.extend(rectangle(
            [x + 0.1, 0.35, -0.1],
            [[0.0, 0.0, 0.6], [0.02, 0.01, 0.0]],
        ));
    }
    all
}

/// Two axes at right angles to a normal, and to each other.
pub(super) fn in_plane(normal: Vertex) -> [Vertex; 2] {
    let other = match normal[0].abs() < 0.7 {
        true => [1.0, 0.0, 0.0],
        false => [0.0, 1.0, 0.0],
    };
    let u = normalize(cross(other, normal));
    [u, cross(normal, u)]
}

/// Seed of everything that is drawn: a step is the same scene on every machine.
pub(super) const SEED: u64 = 5;
