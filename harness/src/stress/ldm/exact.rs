//! The scene as its files have it, and rays through it in `f64`.
//!
//! Coordinates are in steps of the lattice, but not rounded to it: what is lost by rounding is the
//! difference to the lattice scene. Rounding of `f64` is below 2^-26 steps for points, and is left
//! out of account beside half a step.

use triptych_spec::grid::exact::minus;
use triptych_spec::grid::lattice::Lattice;

use super::super::shot::Vertex;
use crate::replay::ldm::{Asker, Setup};
use crate::scene::Loaded;
use crate::scene::file::MeshEntry;
use crate::vector::{add, cross, dot, length, scale, sub};

/// What is nearer to a ray's start, in steps, is the surface that it starts from: rounding alone
/// puts a neighbour in the same plane there. Far below a step, far above what `f64` rounds.
const START: f64 = 1.0 / 1024.0;

/// Triangles of a scene.
pub(super) struct Exact {
    /// That are seen, in the order of the model.
    seen: Vec<(usize, [Vertex; 3])>,
    /// That block, with their rows in the scene.
    pub(super) blockers: Vec<(usize, [Vertex; 3])>,
}

/// Where somebody asks from.
pub(super) struct From {
    /// The point, on its triangle.
    pub(super) point: Vertex,
    /// Unit normal to the side that it is seen from.
    pub(super) normal: Vertex,
    /// Row of its triangle in the scene.
    pub(super) row: usize,
}

impl Exact {
    /// The triangles of a scene, in steps of a lattice.
    pub(super) fn new(loaded: &Loaded, lattice: &Lattice) -> Self {
        let points = loaded.world.points(&loaded.scene);
        let steps = |row: u32| {
            let from = sub(points[row as usize], lattice.centre);
            from.map(|c| libm::scalbn(c, -lattice.exponent))
        };
        let entries = loaded.entries();
        let of = |is: fn(&MeshEntry) -> bool| {
            let all = loaded.scene.triangles.iter().enumerate();
            let some = all.filter(|(_, t)| is(entries[t.instance as usize]));
            some.map(|(row, t)| (row, t.vertices.map(steps))).collect()
        };
        Self {
            seen: of(MeshEntry::is_seen),
            blockers: of(MeshEntry::does_block),
        }
    }

    /// The point of the unrounded triangle with the weights that the asker's has in the rounded
    /// one, below it along the normal. `None` where either triangle has no area.
    pub(super) fn from(&self, setup: &Setup, asker: &Asker) -> Option<From> {
        let corners = setup.model.corners(asker.triangle);
        let normal = setup.model.face(asker.triangle).normal.map(|c| c as f64);
        let [ab, ac, ap] = [corners[1], corners[2], asker.receiver.point]
            .map(|point| minus(point, corners[0]).map(f64::from));
        let area = dot(normal, normal);
        let v = dot(cross(ap, ac), normal) / area;
        let w = dot(cross(ab, ap), normal) / area;
        // The point belongs to the triangle, but was rounded.
        let weights = [1.0 - v - w, v, w].map(|weight| weight.max(0.0));
        let total: f64 = weights.iter().sum();
        let (row, exact) = self.seen[asker.triangle as usize];
        let point = (0..3).fold([0.0; 3], |sum, i| {
            add(sum, scale(exact[i], weights[i] / total))
        });
        let out = cross(sub(exact[1], exact[0]), sub(exact[2], exact[0]));
        let towards = dot(out, asker.receiver.normal.map(f64::from));
        let normal = scale(out, towards.signum() / length(out));
        let finite = point.iter().chain(&normal).all(|c| c.is_finite());
        finite.then_some(From { point, normal, row })
    }

    /// What blocks, as it is seen from a point.
    pub(super) fn around(&self, from: &From) -> Around {
        let others = self.blockers.iter().filter(|(row, _)| *row != from.row);
        let faces = others.map(|(row, corners)| {
            let [a, b, c] = corners.map(|corner| sub(corner, from.point));
            let edges = [cross(b, c), cross(c, a), cross(a, b)];
            Face {
                row: *row,
                volume: dot(a, edges[0]),
                edges,
            }
        });
        Around {
            faces: faces.collect(),
        }
    }
}

/// Triangles around a point. The cross product of an edge's ends is that of the next triangle
/// with another sign, to the bit, so nothing passes between the two.
pub(super) struct Around {
    faces: Vec<Face>,
}

struct Face {
    row: usize,
    edges: [Vertex; 3],
    volume: f64,
}

impl Around {
    /// What is first met in a direction of length 1: how many steps away, and the row of the
    /// triangle. What lies in the plane of the direction is not met.
    pub(super) fn closest(&self, direction: Vertex) -> Option<(f64, usize)> {
        let met = |face: &Face| {
            let sides = face.edges.map(|edge| dot(edge, direction));
            let within = sides.iter().all(|s| *s >= 0.0) || sides.iter().all(|s| *s <= 0.0);
            let t = face.volume / sides.iter().sum::<f64>();
            (within && t > START && t.is_finite()).then_some((t, face.row))
        };
        let all = self.faces.iter().filter_map(met);
        all.reduce(|a, b| if b.0 < a.0 { b } else { a })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ray_meets_what_it_must() {
        let square = [
            [-8.0, -8.0, 4.0],
            [8.0, -8.0, 4.0],
            [8.0, 8.0, 4.0],
            [-8.0, 8.0, 4.0],
        ];
        let exact = Exact {
            seen: Vec::new(),
            blockers: vec![
                (0, [square[0], square[1], square[2]]),
                (1, [square[0], square[2], square[3]]),
                (
                    2,
                    [square[0], square[1], square[2]].map(|v| add(v, [0.0, 0.0, 4.0])),
                ),
            ],
        };
        let from = |row| From {
            point: [0.0; 3],
            normal: [0.0, 0.0, 1.0],
            row,
        };
        let around = exact.around(&from(9));
        // Along the diagonal that both share.
        let up = around.closest([0.0, 0.0, 1.0]).expect("one of both");
        assert_eq!(up.0, 4.0);
        assert_eq!(around.closest([0.0, 0.0, -1.0]), None, "behind the start");
        assert_eq!(around.closest([1.0, 0.0, 0.0]), None, "beside it");
        let own = exact.around(&from(0)).closest([0.0, -0.6, 0.8]);
        let (t, row) = own.expect("the sheet behind");
        assert_eq!(
            (t.round(), row),
            (10.0, 2),
            "a ray does not meet what it starts from"
        );
    }
}
