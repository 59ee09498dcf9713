//! Neighbours that were cut must still meet.
//!
//! A point of clipping is computed from the two ends of its edge in an order that
//! does not depend on the triangle, so neighbours get the same point, to the bit,
//! and with it the same corner on the grid. Bounds cannot see whether they did: both
//! orders are inside. So corners that must be equal to the bit, in triangles that
//! share an edge, must be equal in the observation, whatever they are. What a corner must
//! be tells edges apart: nothing is promised of the points of two of them, even where
//! they meet in a vertex that lies in a plane.

use triptych_spec::scene::Scene;

use super::{Difference, Kind};

/// The triangles among `cut` that do not meet a neighbour which comes before them.
/// `corners` gives what each corner of a triangle must be, and what it is; all of the
/// triangles have one outcome, and were observed inside it.
pub fn cracks<M: PartialEq, S: PartialEq>(
    scene: &Scene,
    cut: &[usize],
    corners: impl Fn(usize) -> Vec<(M, S)>,
) -> Vec<Difference> {
    let mut edges: Vec<([u32; 2], usize)> = Vec::with_capacity(3 * cut.len());
    for &triangle in cut {
        let [a, b, c] = scene.triangles[triangle].vertices;
        edges.extend([[a, b], [b, c], [c, a]].map(|[a, b]| ([a.min(b), a.max(b)], triangle)));
    }
    edges.sort_unstable();
    let mut found = Vec::new();
    for pair in edges.windows(2) {
        let [(edge, neighbour), (other, triangle)] = [pair[0], pair[1]];
        if edge != other || neighbour == triangle {
            continue;
        }
        let theirs = corners(neighbour);
        let apart = |(must, seen): &(M, S)| theirs.iter().any(|(m, s)| m == must && s != seen);
        if let Some(corner) = corners(triangle).iter().position(apart) {
            let kind = Kind::Crack { corner, neighbour };
            found.push(Difference { triangle, kind });
        }
    }
    // By triangle, like all differences; one that has two cracks counts once.
    found.sort_by_key(|d| d.triangle);
    found.dedup_by_key(|d| d.triangle);
    found
}
