//! What rays meet, found in a tree of boxes (paper section 3, "a Bounding Volume Hierarchy"): the
//! spec's answers to the bit.
//!
//! `obvhs` builds the tree. Boxes and triangles are integers that `f32` holds; numbers are `f64`
//! here, so that a box is left out only if the ray passes it, and a triangle only if it does.
//! Whether, and when, a triangle is met that is not left out, the spec's own [`crossing`] says.

use std::time::Duration;

use glam::Vec3A;
use obvhs::BvhBuildParams;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::build_bvh2_from_tris;
use obvhs::triangle::Triangle;
use triptych_spec::dispatch::Tracer;
use triptych_spec::grid::Blockers;
use triptych_spec::grid::hit::crossing;
use triptych_spec::grid::lattice::Point;
use triptych_spec::grid::ray::Ray;
use triptych_spec::grid::trace::Closest;

/// Above this a side's sign is certain. Differences of lattice points are at most 2^24 in each
/// component, so those of a cross product are at most 2^49 and exact; the three terms of its dot product with
/// a direction are below 2^73 each. Five roundings of 2^-53 make less than `3 * 3 * 2^20 < 2^24`.
const SIDE_ERROR: f64 = (1_u32 << 24) as f64;

/// Times of boxes and hits are a difference, which is exact, times a rounded inverse; or a quotient within
/// 2^-51. Widened by so much, none is on the wrong side of another.
const WIDER: f64 = 1.0 + 1.0 / (1_u64 << 48) as f64;

/// A tree over the triangles of a scene.
pub struct Tree {
    tree: Bvh2,
    /// Corners in the order of the leaves.
    corners: Vec<[Point; 3]>,
}

impl Tree {
    /// Builds a tree. Triangles are not split, as the boxes of their parts would be rounded.
    pub fn new(blockers: &Blockers) -> Self {
        let rows = 0..u32::try_from(blockers.triangles.len()).expect("fewer than 2^32");
        let vector = |p: Point| Vec3A::from(p.map(|c| c as f32));
        let triangle = |row| {
            let [v0, v1, v2] = blockers.corners(row).map(vector);
            Triangle { v0, v1, v2 }
        };
        let triangles: Vec<Triangle> = rows.map(triangle).collect();
        let parameters = BvhBuildParams {
            pre_split: false,
            ..BvhBuildParams::medium_build()
        };
        let mut time = Duration::ZERO;
        let tree = match triangles.is_empty() {
            true => Bvh2::default(),
            false => build_bvh2_from_tris(&triangles, parameters, &mut time),
        };
        let corners = tree.primitive_indices.iter();
        Self {
            corners: corners.map(|row| blockers.corners(*row)).collect(),
            tree,
        }
    }

    /// Calls `met` with every triangle that the ray may meet until `limit`, which it returns anew;
    /// a negative limit ends the search.
    fn visit(&self, ray: &Ray, mut limit: f64, mut met: impl FnMut(u32, [Point; 3]) -> f64) {
        if self.tree.nodes.is_empty() || !ray.moves() {
            return;
        }
        let line = Line::new(ray);
        // A node and when its box is entered.
        let mut stack = Vec::with_capacity(64);
        stack.extend(line.enters(&self.tree, 0, limit).map(|time| (0, time)));
        while let Some((node, entry)) = stack.pop() {
            if entry > limit {
                continue;
            }
            let node = &self.tree.nodes[node as usize];
            let first = node.first_index;
            if node.prim_count > 0 {
                for at in (first..first + node.prim_count).map(|at| at as usize) {
                    if line.may_meet(self.corners[at]) {
                        limit = met(self.tree.primitive_indices[at], self.corners[at]);
                        if limit < 0.0 {
                            return;
                        }
                    }
                }
                continue;
            }
            let both = [first, first + 1].map(|child| {
                let time = line.enters(&self.tree, child, limit)?;
                Some((child, time))
            });
            match both {
                [Some(near), Some(far)] if near.1 <= far.1 => stack.extend([far, near]),
                [near, far] => stack.extend(near.into_iter().chain(far)),
            }
        }
    }
}

impl Tracer for Tree {
    fn closest(&self, ray: Ray) -> Option<u32> {
        let mut nearest: Option<Closest> = None;
        let mut limit = end(&ray);
        self.visit(&ray, limit, |prim, corners| {
            if let Some(time) = crossing(&ray, corners)
                && nearest.is_none_or(|n| (time, prim) < (n.time, n.prim))
            {
                nearest = Some(Closest { prim, time });
                limit = time.value() * WIDER;
            }
            limit
        });
        nearest.map(|met| met.prim)
    }

    fn blocked(&self, ray: Ray) -> bool {
        let (limit, mut blocked) = (end(&ray), false);
        self.visit(&ray, limit, |_, corners| {
            blocked = crossing(&ray, corners).is_some();
            if blocked { -1.0 } else { limit }
        });
        blocked
    }
}

/// When a ray ends.
fn end(ray: &Ray) -> f64 {
    if ray.segment { WIDER } else { f64::INFINITY }
}

/// A ray in numbers that its integers fit in.
struct Line {
    origin: [f64; 3],
    direction: [f64; 3],
    inverse: [f64; 3],
}

impl Line {
    fn new(ray: &Ray) -> Self {
        let direction = ray.direction.map(f64::from);
        Self {
            origin: ray.origin.map(f64::from),
            direction,
            // Infinite along axes on which the ray does not move.
            inverse: direction.map(|c| 1.0 / c),
        }
    }

    /// When the ray enters a node's box, a little early; `None` if it passes it, or comes there only after
    /// `limit`.
    ///
    /// On an axis without movement a side of the box is infinitely early or late, or not a number
    /// where the ray lies in the side, which `max` and `min` take no notice of: it touches the box there.
    fn enters(&self, tree: &Bvh2, node: u32, limit: f64) -> Option<f64> {
        let bounds = &tree.nodes[node as usize].aabb;
        let [low, high] = [bounds.min, bounds.max].map(|p| p.to_array().map(f64::from));
        let (mut entry, mut exit) = (0.0_f64, limit);
        for axis in 0..3 {
            let (near, far) = match self.direction[axis] >= 0.0 {
                true => (low[axis], high[axis]),
                false => (high[axis], low[axis]),
            };
            entry = entry.max((near - self.origin[axis]) * self.inverse[axis]);
            exit = exit.min((far - self.origin[axis]) * self.inverse[axis] * WIDER);
        }
        (entry <= exit).then_some(entry / WIDER)
    }

    /// Whether it cannot be told that the ray passes a triangle: its edges as seen along the ray
    /// ([`triptych_spec::grid::hit::sides`]).
    fn may_meet(&self, corners: [Point; 3]) -> bool {
        let from = |p: Point| [0, 1, 2].map(|axis| f64::from(p[axis]) - self.origin[axis]);
        let [a, b, c] = corners.map(from);
        let sides = [(b, c), (c, a), (a, b)].map(|(p, q)| {
            let cross = [
                p[1] * q[2] - p[2] * q[1],
                p[2] * q[0] - p[0] * q[2],
                p[0] * q[1] - p[1] * q[0],
            ];
            let d = self.direction;
            d[0] * cross[0] + d[1] * cross[1] + d[2] * cross[2]
        });
        let least = sides[0].min(sides[1]).min(sides[2]);
        let most = sides[0].max(sides[1]).max(sides[2]);
        !(least < -SIDE_ERROR && most > SIDE_ERROR)
    }
}
