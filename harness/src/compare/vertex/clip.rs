//! Stage `clip` by itself, from the positions that the device had.

use triptych_spec::bound::Bounded;
use triptych_spec::scene::Scene;
use triptych_spec::vertex::{Plane, Polygons, Position, clip_triangle};

use super::positions::exact;
use super::rule::{Outside, Rule};
use super::{Difference, Figures, Kind, SLACK, VertexReport, cracks, each, hold, polygon};

/// Ways through the branches of one triangle that are followed before it is given
/// up as undecided: six branches without a certain answer.
pub const OUTCOMES_MAX: usize = 64;

/// Compares what a device clipped of the positions that it had.
pub fn compare_clip(
    scene: &Scene,
    positions: &[Position<f32>],
    observed: &Polygons<f32>,
) -> VertexReport {
    let sizes = [positions.len(), observed.offsets.len()];
    if sizes != [scene.vertices.len(), scene.triangles.len() + 1] {
        let message = format!("{} positions, {} offsets", sizes[0], sizes[1]);
        return VertexReport::malformed(message);
    }
    let planes = Plane::all(scene.size);
    let corners = |vertices: [u32; 3]| vertices.map(|v| exact(positions[v as usize]));
    let (mut report, cut) = each(scene, |row, triangle, part| {
        part.triangles += 1;
        let corners = corners(triangle.vertices);
        let seen = polygon(observed, row);
        // No outcome has so few, and `snap` could make nothing of them.
        if let observed @ 1..3 = seen.len() {
            let kind = Kind::Count {
                expected: 0,
                observed,
            };
            part.outside += observed as u64;
            part.tell(Difference {
                triangle: row,
                kind,
            });
            return false;
        }
        let Some(outcomes) = outcomes(&planes, corners) else {
            part.undecided += 1;
            part.admitted += 1;
            return false;
        };
        let is_cut = matches!(outcomes.as_slice(), [one] if one != &corners);
        hold(&Homogeneous, row, &outcomes, seen, part) && is_cut
    });
    let told = cracks::cracks(scene, &cut, |triangle| {
        let corners = corners(scene.triangles[triangle].vertices);
        let must = clip_triangle(&planes, corners, |_, plain| plain).into_iter();
        // With the bounds: points of two edges may be the same, and what they may stray
        // by is not. Where an end of both lies in a plane they meet there, each computed
        // from its own other end.
        let must = must.map(|corner| corner.map(|n| [n.value, n.bound].map(f64::to_bits)));
        let seen = polygon(observed, triangle).iter();
        must.zip(seen.map(|corner| corner.map(f32::to_bits)))
            .collect()
    });
    report.add_cracks(told);
    report
}

/// Every polygon that an `f32` evaluation may make of a triangle; the spec's own
/// comes first. `None` if there are more than [`OUTCOMES_MAX`].
pub fn outcomes(
    planes: &[Plane; 6],
    corners: [Position<Bounded>; 3],
) -> Option<Vec<Vec<Position<Bounded>>>> {
    // The uncertain answers of the current way, and whether each was turned round.
    let mut way: Vec<(bool, bool)> = Vec::new();
    let mut found = Vec::new();
    loop {
        let mut at = 0;
        found.push(clip_triangle(planes, corners, |number, plain| {
            if number.sign_is_certain() {
                return plain;
            }
            if at == way.len() {
                way.push((plain, false));
            }
            at += 1;
            way[at - 1].0
        }));
        while way.pop_if(|(_, turned)| *turned).is_some() {}
        let Some(last) = way.last_mut() else {
            return Some(found);
        };
        *last = (!last.0, true);
        if found.len() == OUTCOMES_MAX {
            return None;
        }
    }
}

/// Corners before they are snapped.
pub(super) struct Homogeneous;

impl Rule for Homogeneous {
    type Corner = Position<f32>;

    fn corner(
        &self,
        expected: Position<Bounded>,
        observed: Position<f32>,
    ) -> Result<Figures, Outside> {
        let mut figures = Figures::default();
        for (axis, (expected, observed)) in expected.into_iter().zip(observed).enumerate() {
            let observed = f64::from(observed);
            if expected.bound.is_infinite() {
                figures.unbounded = 1;
                continue;
            }
            let error = (observed - expected.value).abs();
            // The error of NaN is no number, and within no bound.
            if error.is_nan() || error > expected.bound * SLACK {
                return Err(Outside {
                    axis,
                    expected,
                    observed,
                });
            }
            // A corner that was not cut is copied: no bound, no error.
            if error > 0.0 {
                figures.error = figures.error.max(error);
                figures.error_over_bound = figures.error_over_bound.max(error / expected.bound);
            }
        }
        Ok(figures)
    }
}
