//! The GPU's own vertex stages against the spec's bounds, each from equal inputs.
//!
//! - `transform`: every position inside the bound of its sum (`vertex/positions.rs`).
//! - `clip`: the spec clips the positions that the device gave, with [`Bounded`]
//!   numbers. A branch whose number may have either sign in `f32` is followed both
//!   ways, so that a triangle has one admitted outcome, or a few (class *decision*). The
//!   observed polygon must have the corners of one of them (`vertex/clip.rs`).
//! - `snap`: every coordinate on the grid must be the rounding of some number within
//!   the bound of the corner that the device clipped (`vertex/snap.rs`).
//!
//! All three at once, from the scene to the grid, are not compared beside these: that
//! could find nothing more. A bound only grows with those of its operands, and a sign
//! that is certain stays so for every operand inside them; so what each stage may make
//! of the one before is among what all may make of the scene. `vertex/tests/whole.rs`
//! holds one against the other.

mod axis;
mod clip;
mod cracks;
mod polygons;
mod positions;
mod report;
mod rule;
mod snap;
mod words;

use triptych_spec::bound::Bounded;
use triptych_spec::scene::{Scene, Triangle};
use triptych_spec::vertex::{Polygons, Position};

pub use clip::{OUTCOMES_MAX, compare_clip};
pub use positions::{Stray, TransformReport, compare_transform};
pub use report::{Difference, Figures, Kind, TOLD_MAX, VertexReport};
use rule::Rule;
pub use snap::compare_snap;

/// Triangles that one task works through. The result does not depend on it.
const CHUNK: usize = 1 << 14;

/// The spec's numbers are `f64` and differ from the real ones that the bounds are
/// about: by under 2^-53 where the bound has 2^-23 or more, operation by operation.
const SLACK: f64 = 1.0 + 1.0 / (1 << 20) as f64;

/// Judges every triangle; gives the rows of those for which `judge` says so, in order.
fn each(
    scene: &Scene,
    judge: impl Fn(usize, &Triangle, &mut VertexReport) -> bool + Sync,
) -> (VertexReport, Vec<usize>) {
    let chunks: Vec<_> = scene.triangles.chunks(CHUNK).collect();
    let parts: Vec<(VertexReport, Vec<usize>)> = share::each(chunks.len(), |chunk| {
        let mut part = VertexReport::default();
        let rows = (chunk * CHUNK..).zip(chunks[chunk]);
        let told = rows.filter(|(row, triangle)| judge(*row, triangle, &mut part));
        let told = told.map(|(row, _)| row).collect();
        (part, told)
    });
    let mut report = VertexReport::default();
    let mut all = Vec::new();
    for (part, rows) in parts {
        report.add(part);
        all.extend(rows);
    }
    (report, all)
}

/// Holds an observed polygon against a triangle's outcomes, of which the spec's own
/// comes first; whether it is inside one.
fn hold<R: Rule>(
    rule: &R,
    triangle: usize,
    outcomes: &[impl AsRef<[Position<Bounded>]>],
    observed: &[R::Corner],
    report: &mut VertexReport,
) -> bool {
    let first = outcomes[0].as_ref();
    let corners = observed.len().max(first.len());
    report.corners += corners as u64;
    let mut own = None;
    for outcome in outcomes {
        match rule.polygon(outcome.as_ref(), observed) {
            Ok(figures) => {
                report.agree(&figures, outcomes.len() > 1);
                return true;
            }
            Err(kind) => own = own.or(Some(kind)),
        }
    }
    let (kind, outside) = match own {
        Some(kind @ Kind::Corner { .. }) if outcomes.len() == 1 => {
            (kind, rule.outside(first, observed))
        }
        Some(kind) if outcomes.len() == 1 => (kind, corners),
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

/// The corners of a triangle.
fn polygon<T>(polygons: &Polygons<T>, triangle: usize) -> &[Position<T>] {
    let [start, end] = [triangle, triangle + 1].map(|at| polygons.offsets[at] as usize);
    &polygons.corners[start..end]
}

#[cfg(test)]
mod tests;
use crate::dispatch::share;
