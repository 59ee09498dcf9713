//! Neighbours that were cut must still meet.
//!
//! A point of clipping is computed from the two ends of its edge in an order that
//! does not depend on the triangle, so neighbours get the same point, to the bit,
//! and with it the same corner on the grid. Bounds cannot see whether they did: both
//! orders are inside. So corners that are bit-equal in the spec, in triangles that
//! share an edge, must be equal in the observation, whatever they are.

use triptych_spec::bound::Bounded;
use triptych_spec::scene::Scene;
use triptych_spec::vertex::{Plane, Position, clip_triangle};

use super::polygons::Layout;
use super::{Difference, Kind};

/// The triangles among `cut` that do not meet a neighbour which comes before them.
/// All of them have one outcome, and were observed inside it.
pub fn cracks(
    scene: &Scene,
    positions: &[Position<Bounded>],
    layout: &Layout<'_>,
    cut: &[usize],
) -> Vec<Difference> {
    let mut edges: Vec<([u32; 2], usize)> = Vec::with_capacity(3 * cut.len());
    for &triangle in cut {
        let [a, b, c] = scene.triangles[triangle].vertices;
        edges.extend([[a, b], [b, c], [c, a]].map(|[a, b]| ([a.min(b), a.max(b)], triangle)));
    }
    edges.sort_unstable();
    let planes = Plane::all(scene.size);
    let polygon = |triangle: usize| {
        let corners = scene.triangles[triangle]
            .vertices
            .map(|v| positions[v as usize]);
        clip_triangle(&planes, corners, |_, plain| plain)
    };
    let mut found = Vec::new();
    for pair in edges.windows(2) {
        let [(edge, neighbour), (other, triangle)] = [pair[0], pair[1]];
        if edge != other || neighbour == triangle {
            continue;
        }
        let ours = polygon(triangle).into_iter().zip(layout.polygon(triangle));
        let theirs = polygon(neighbour)
            .into_iter()
            .zip(layout.polygon(neighbour));
        let apart = |(_, (a, x)): &(usize, (Position<Bounded>, &[i32; 3]))| {
            theirs.clone().any(|(b, y)| same(a, &b) && **x != *y)
        };
        if let Some((corner, _)) = ours.enumerate().find(apart) {
            let kind = Kind::Crack { corner, neighbour };
            found.push(Difference { triangle, kind });
        }
    }
    // By triangle, like all differences; one that has two cracks counts once.
    found.sort_by_key(|d| d.triangle);
    found.dedup_by_key(|d| d.triangle);
    found
}

fn same(a: &Position<Bounded>, b: &Position<Bounded>) -> bool {
    let bits = |p: &Position<Bounded>| p.map(|n| n.value.to_bits());
    bits(a) == bits(b)
}
