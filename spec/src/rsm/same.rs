//! Which points belong to the same surface.

use super::model::COARSE_BITS;
use super::{Model, Surface};
use crate::grid::exact::minus;
use crate::grid::lattice::Point;

/// Whether two points are on the same side of all depth edges and creases: light may be
/// blurred from one to the other.
///
/// Points of one triangle are, if the same side of it is seen. Others are if their faces,
/// towards the viewer, make an angle of less than 90 degrees, and each point is at most
/// `edge` steps from the plane of the other: `|n . d| <= edge 2^14`, with normals of length
/// 2^14 ([`super::Face::coarse`]), all in integers of 41 bits. The rule is symmetric.
pub fn same(model: &Model, a: &Surface, b: &Surface, edge: u32) -> bool {
    if a.triangle == b.triangle {
        return a.side == b.side;
    }
    let normals = [a, b].map(|s| model.face(s.triangle).coarse.map(|c| c * s.side));
    let apart = minus(a.point, b.point);
    let most = i64::from(edge) << COARSE_BITS;
    let near = |normal: Point| dot(normal, apart).abs() <= most;
    dot(normals[0], normals[1]) > 0 && normals.into_iter().all(near)
}

fn dot(a: Point, b: Point) -> i64 {
    let product = |i: usize| i64::from(a[i]) * i64::from(b[i]);
    product(0) + product(1) + product(2)
}
