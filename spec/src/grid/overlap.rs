//! Whether a triangle touches a cell, not only its box.
//!
//! Separating axes (Akenine-Möller 2001): the three of the cell, the triangle's normal and
//! nine products of edges and axes. All are integers, so a cell is dropped only if the
//! triangle provably misses it; in `f32` slivers can be lost. Coordinates are doubled, so
//! that a cell's middle is a point of the lattice: differences are at most 2^26, components
//! of a normal at most 2^53, and projections on it below 2^81.

use super::axis::{Axis, WIDENED};
use super::lattice::Point;

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
    let apart_on = |axis: [i64; 3]| apart(corners, half, axis);
    let units = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
    let of_edges = units
        .iter()
        .flat_map(|unit| edges.iter().map(|edge| cross(*unit, *edge)));
    !(units.iter().copied().any(apart_on)
        || of_edges.into_iter().any(apart_on)
        || apart_on(cross(edges[0], edges[1])))
}

/// Whether box and triangle lie apart along an axis.
fn apart(corners: [[i64; 3]; 3], half: [i64; 3], axis: [i64; 3]) -> bool {
    let dot = |a: [i64; 3], b: [i64; 3]| {
        let product = |i: usize| i128::from(a[i]) * i128::from(b[i]);
        product(0) + product(1) + product(2)
    };
    let [a, b, c] = corners.map(|corner| dot(corner, axis));
    let reach = dot(half, axis.map(i64::abs));
    a.min(b).min(c) > reach || a.max(b).max(c) < -reach
}

fn cross(a: [i64; 3], b: [i64; 3]) -> [i64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}
