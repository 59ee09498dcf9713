//! The GPU's own vertex stage against the spec's bound.
//!
//! The spec follows every triangle with [`Bounded`] numbers. A branch of clipping
//! whose number may have either sign in `f32` is followed both ways, so that a
//! triangle has one admitted outcome, or a few (class *decision*). The observed
//! polygon must have the corners of one of them, and every coordinate must be the
//! rounding of some number within the bound (`vertex/axis.rs`).

mod axis;
mod cracks;
mod polygons;
mod positions;
mod report;
mod words;

use rayon::prelude::*;
use triptych_spec::bound::Bounded;
use triptych_spec::scene::Scene;
use triptych_spec::vertex::{self, Plane, Position, Primitives, clip_triangle};

use axis::Judge;
use polygons::Layout;
pub use positions::{Stray, TransformReport, compare_transform, exact_positions};
pub use report::{Difference, Figures, Kind, TOLD_MAX, VertexReport};

/// Ways through the branches of one triangle that are followed before it is given
/// up as undecided: six branches without a certain answer.
pub const OUTCOMES_MAX: usize = 64;

/// Triangles that one task works through. The result does not depend on it.
const CHUNK: usize = 1 << 14;

/// Compares all vertex stages together: what a device made of the scene's
/// vertices, on a grid of `bits` sub-pixel bits.
pub fn compare(scene: &Scene, bits: u32, observed: &Primitives) -> VertexReport {
    compare_from(scene, &vertex::transform(scene), bits, observed)
}

/// Compares clip and snap from given positions: with those that the device's own
/// `transform` gave, exact, an error is charged to the stage that makes it.
pub fn compare_from(
    scene: &Scene,
    positions: &[Position<Bounded>],
    bits: u32,
    observed: &Primitives,
) -> VertexReport {
    let triangles = scene.triangles.len();
    let mut report = VertexReport {
        triangles: triangles as u64,
        ..VertexReport::default()
    };
    if (observed.size, observed.bits) != (scene.size, bits) {
        let message = format!("grid is {:?}, {} bits", observed.size, observed.bits);
        report.malformed = Some(message);
        return report;
    }
    let layout = match Layout::new(observed, triangles) {
        Ok(layout) => layout,
        Err(message) => {
            report.malformed = Some(message);
            return report;
        }
    };
    let planes = Plane::all(scene.size);
    let judge = Judge::new(scene.size, bits);
    let chunks = scene.triangles.par_chunks(CHUNK).enumerate();
    let parts: Vec<(VertexReport, Vec<usize>)> = chunks
        .map(|(chunk, triangles)| {
            let mut part = VertexReport::default();
            let mut cut = Vec::new();
            for (row, triangle) in (chunk * CHUNK..).zip(triangles) {
                let corners = triangle.vertices.map(|v| positions[v as usize]);
                let outcomes = outcomes(&planes, corners);
                let one = outcomes
                    .as_ref()
                    .and_then(|o| <&[_; 1]>::try_from(o.as_slice()).ok());
                let is_cut = one.is_some_and(|[polygon]| polygon != &corners);
                let inside = hold(&judge, row, outcomes, layout.polygon(row), &mut part);
                if is_cut && inside {
                    cut.push(row);
                }
            }
            (part, cut)
        })
        .collect();
    let mut cut = Vec::new();
    for (part, rows) in parts {
        report.add(part);
        cut.extend(rows);
    }
    for crack in cracks::cracks(scene, positions, &layout, &cut) {
        report.cracks += 1;
        report.tell(crack);
    }
    report
}

/// Every polygon that an `f32` evaluation may make of a triangle; the spec's own
/// comes first. `None` if there are more than [`OUTCOMES_MAX`].
fn outcomes(
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

/// Holds an observed polygon against a triangle's outcomes; whether it is inside one.
fn hold(
    judge: &Judge,
    triangle: usize,
    outcomes: Option<Vec<Vec<Position<Bounded>>>>,
    observed: &[[i32; 3]],
    report: &mut VertexReport,
) -> bool {
    let Some(outcomes) = outcomes else {
        report.undecided += 1;
        report.admitted += 1;
        return false;
    };
    let corners = observed.len().max(outcomes[0].len());
    report.corners += corners as u64;
    let judged: Vec<_> = outcomes
        .iter()
        .map(|o| judge.polygon(o, observed))
        .collect();
    if let Some(figures) = judged.iter().find_map(|j| j.as_ref().ok()) {
        report.agree(figures, outcomes.len() > 1);
        return true;
    }
    let (kind, outside) = match judged.into_iter().next() {
        Some(Err(kind @ Kind::Corner { .. })) if outcomes.len() == 1 => {
            (kind, judge.outside(&outcomes[0], observed))
        }
        Some(Err(kind)) if outcomes.len() == 1 => (kind, corners),
        _ => {
            let kind = Kind::NoOutcome {
                outcomes: outcomes.len(),
                observed: observed.len(),
            };
            (kind, corners)
        }
    };
    report.outside += outside.max(1) as u64;
    report.tell(Difference { triangle, kind });
    false
}

#[cfg(test)]
mod tests;
