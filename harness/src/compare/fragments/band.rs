//! Which pixels any sub-pixel grid may cover, and which every grid must.
//!
//! A driver rounds every corner to its own grid, once. The coarsest that Vulkan
//! allows has 4 bits, so a corner moves by less than `r`, one sub-pixel of that grid,
//! in x and in y, whichever way it rounds; then the driver rasterises exactly. Each
//! corner lies somewhere in a closed square of half side `r` around the spec's.
//!
//! **Must not.** A pixel that some choice of corners covers is a convex combination of
//! points of the three squares, and lies in the triangle plus a square (Minkowski).
//! For convex polygons that sum is cut out by the normals of both: with `d` the
//! direction of an edge, `E >= -r (|dx| + |dy|)`, and the bounding box wider by `r` on
//! every side. This holds whichever way around the moved triangle runs.
//!
//! **Must.** Seen from the sample, an edge from `a` to `b` has `E = a x b`, linear in
//! each of the four coordinates, so its least value is at corners of the squares. If
//! that is positive for all three edges, every choice covers the sample, in its
//! interior, where no fill rule matters.

use triptych_spec::raster::{Fragment, sample};
use triptych_spec::vertex::Primitives;

use crate::calibrate::BITS_MIN;

/// Whether some grids cover the pixel and others may not.
pub(super) fn may(primitives: &Primitives, f: &Fragment) -> bool {
    let (size, bits) = (primitives.size, primitives.bits);
    let point = [
        sample(f.pixel % size.width, bits),
        sample(f.pixel / size.width, bits),
    ];
    let mut corners = primitives.prims[f.prim as usize].map(|c| {
        let [x, y, _] = primitives.snapped[c as usize].map(i64::from);
        [x - point[0], y - point[1]]
    });
    if area(corners) < 0 {
        corners.swap(1, 2);
    }
    let r = 1 << bits.saturating_sub(BITS_MIN);
    reached(corners, r) && !certain(corners, r)
}

/// Whether some choice of corners covers the origin.
fn reached(corners: [[i64; 2]; 3], r: i64) -> bool {
    let in_box = (0..2).all(|axis| {
        let c = corners.map(|c| c[axis]);
        c.iter().any(|c| *c <= r) && c.iter().any(|c| *c >= -r)
    });
    let inside = |(a, b): ([i64; 2], [i64; 2])| {
        let offset = r * ((b[0] - a[0]).abs() + (b[1] - a[1]).abs());
        cross(a, b) >= -offset
    };
    // The edges of a triangle without area run both ways, and bound both its sides.
    in_box && edges(corners).into_iter().all(inside)
}

/// Whether every choice of corners covers the origin.
fn certain(corners: [[i64; 2]; 3], r: i64) -> bool {
    let moved =
        |p: [i64; 2]| [[-r, -r], [-r, r], [r, -r], [r, r]].map(|d| [p[0] + d[0], p[1] + d[1]]);
    edges(corners).into_iter().all(|(a, b)| {
        moved(a)
            .iter()
            .all(|a| moved(b).iter().all(|b| cross(*a, *b) > 0))
    })
}

fn edges([a, b, c]: [[i64; 2]; 3]) -> [([i64; 2], [i64; 2]); 3] {
    [(b, c), (c, a), (a, b)]
}

fn area(corners: [[i64; 2]; 3]) -> i64 {
    edges(corners).into_iter().map(|(a, b)| cross(a, b)).sum()
}

fn cross(a: [i64; 2], b: [i64; 2]) -> i64 {
    a[0] * b[1] - a[1] * b[0]
}

#[cfg(test)]
mod tests;
