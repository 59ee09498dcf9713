//! Whether a triangle touches a cell, not only its box.
//!
//! Separating axes (Akenine-Möller 2001): the three of the cell, which the triangle's box is
//! held against; nine products of edges and axes; and the triangle's normal. All are integers, so
//! a cell is dropped only if the triangle provably misses it; in `f32` slivers can be lost.
//! Coordinates are doubled, so that a cell's middle is a point of the lattice: differences are at
//! most 2^26, projections on products of edges and axes at most 2^54, components of a normal at most
//! 2^53, and projections on it below 2^81.

use std::ops::Neg;

use super::axis::{Axis, WIDENED};
use super::lattice::Point;

/// A point as seen from a cell's middle, in half steps.
type Corner = [i64; 3];

/// Whether the triangle touches the widened cell, boundaries included.
pub fn touches(axes: &[Axis; 3], cell: [u32; 3], corners: [Point; 3]) -> bool {
    let between = |axis: usize| {
        let boundaries = axes[axis].boundaries();
        let at = cell[axis] as usize;
        let low = i64::from(boundaries[at] - WIDENED);
        let high = i64::from(boundaries[at + 1] + WIDENED);
        (low, high)
    };
    let half = [0, 1, 2].map(|axis| between(axis).1 - between(axis).0);
    let corners = corners.map(|corner| {
        [0, 1, 2].map(|axis| 2 * i64::from(corner[axis]) - between(axis).0 - between(axis).1)
    });
    let edge = |i: usize| [0, 1, 2].map(|axis| corners[(i + 1) % 3][axis] - corners[i][axis]);
    let edges = [edge(0), edge(1), edge(2)];
    let boxes = (0..3).any(|axis| apart(corners.map(|c| c[axis]), half[axis]));
    let products = || edges.iter().any(|edge| apart_beside(corners, half, *edge));
    !(boxes || products() || apart_on(corners, half, cross(edges[0], edges[1])))
}

/// Whether box and triangle lie apart along one of an edge's products with the axes: in the plane of two
/// axes, across the edge.
fn apart_beside(corners: [Corner; 3], half: Corner, edge: Corner) -> bool {
    (0..3).any(|axis| {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let along = corners.map(|c| c[v] * edge[u] - c[u] * edge[v]);
        apart(along, half[v] * edge[u].abs() + half[u] * edge[v].abs())
    })
}

/// Whether they lie apart along an axis.
fn apart_on(corners: [Corner; 3], half: Corner, axis: Corner) -> bool {
    let dot = |a: Corner, b: Corner| {
        let product = |i: usize| i128::from(a[i]) * i128::from(b[i]);
        product(0) + product(1) + product(2)
    };
    apart(
        corners.map(|corner| dot(corner, axis)),
        dot(half, axis.map(i64::abs)),
    )
}

/// Whether a triangle's projection is beyond a box's, which reaches equally far to both sides of 0.
fn apart<T: Copy + Ord + Neg<Output = T>>([a, b, c]: [T; 3], reach: T) -> bool {
    a.min(b).min(c) > reach || a.max(b).max(c) < -reach
}

fn cross(a: Corner, b: Corner) -> Corner {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}
