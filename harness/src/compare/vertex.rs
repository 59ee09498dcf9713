//! The GPU's own vertex stage against the spec's bound.
//!
//! The spec follows every triangle with [`Bounded`] numbers. A branch of clipping
//! whose number may have either sign in `f32` is followed both ways, so that a
//! triangle has one admitted outcome, or a few (class *decision*). The observed
//! polygon must have the corners of one of them, and every coordinate must be the
//! rounding of some number within the bound (`vertex/axis.rs`).

mod axis;
mod polygons;
mod positions;
mod words;

use rayon::prelude::*;
use triptych_spec::bound::Bounded;
use triptych_spec::scene::Scene;
use triptych_spec::vertex::{self, Plane, Position, Primitives, clip_triangle};

use super::Judgement;
use crate::cause::Cause;
use crate::row::Class;
use axis::Judge;
use polygons::Layout;
pub use positions::{Stray, TransformReport, compare_transform};

/// Ways through the branches of one triangle that are followed before it is given
/// up as undecided: six branches without a certain answer.
pub const OUTCOMES_MAX: usize = 64;

/// Differences that a report tells in full.
pub const TOLD_MAX: usize = 8;

/// Triangles that one task works through. The result does not depend on it.
const CHUNK: usize = 1 << 14;

/// What comparing the corners of a scene gave. Every difference has cause
/// [`crate::cause::Cause::Vertex`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct VertexReport {
    /// Source triangles, visible or not.
    pub triangles: u64,
    /// Corners held against their bound, or missing, or too many.
    pub corners: u64,
    /// Corners outside; a polygon that matches no outcome counts all its corners
    /// (at least one).
    pub outside: u64,
    /// Triangles with such corners.
    pub differing: u64,
    /// The first [`TOLD_MAX`] differences, in order of triangles.
    pub told: Vec<Difference>,
    /// The observed rows are no fans in order of triangles: nothing was compared
    /// beyond that point.
    pub malformed: Option<String>,
    /// Triangles with a branch that may go either way; one outcome matched.
    pub decisions: u64,
    /// Triangles with more than [`OUTCOMES_MAX`] outcomes: not judged.
    pub undecided: u64,
    /// Triangles that were not judged in full: undecided ones, and agreeing ones with
    /// a decision or an unbounded corner.
    pub admitted: u64,
    /// How far the corners are off.
    pub figures: Figures,
}

/// How far corners inside their bounds are off.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Figures {
    /// Corners with a coordinate on which WGSL promises nothing; their other
    /// coordinates were judged.
    pub unbounded: u64,
    /// Corners inside their bounds whose x or y is another sub-pixel than the spec's.
    pub moved: u64,
    /// Largest error over its bound.
    pub error_over_bound: f64,
    /// Largest error of x or y before rounding, in sub-pixels. Errors count as far as
    /// the rounded coordinate proves them.
    pub error_subpixels: f64,
    /// Largest finite bound of x or y, in sub-pixels.
    pub bound_subpixels: f64,
    /// Largest error of z before truncation, in keys.
    pub error_keys: f64,
}

/// A difference.
#[derive(Clone, Debug, PartialEq)]
pub struct Difference {
    /// Row in [`Scene::triangles`].
    pub triangle: usize,
    /// What differs.
    pub kind: Kind,
}

/// How a triangle differs.
#[derive(Clone, Debug, PartialEq)]
pub enum Kind {
    /// The polygon has another number of corners.
    Count {
        /// Corners in the spec.
        expected: usize,
        /// Corners observed.
        observed: usize,
    },
    /// A coordinate lies outside its bound.
    Corner {
        /// Number of the corner within the polygon.
        corner: usize,
        /// 0, 1, 2 for x, y (sub-pixels) and z (keys).
        axis: usize,
        /// Before rounding.
        value: f64,
        /// Largest distance from it.
        bound: f64,
        /// As observed.
        observed: i32,
    },
    /// Branches were uncertain, but no outcome has this polygon.
    NoOutcome {
        /// Outcomes tried.
        outcomes: usize,
        /// Corners observed.
        observed: usize,
    },
}

impl VertexReport {
    /// Whether something was compared and all of it agrees. Whether too much was
    /// admitted is the caller's budget.
    pub fn agrees(&self) -> bool {
        let judged = self.triangles - self.undecided;
        self.differing == 0 && self.malformed.is_none() && judged > 0
    }

    /// The report as a judgement over triangles: one that is clipped away in both
    /// legs is an agreement, too. The budget for what is admitted is the caller's.
    pub fn judgement(&self) -> Judgement {
        let mut judgement = Judgement::new(Class::Interval, "triangles");
        judgement.compared = self.triangles;
        judgement.admitted = self.admitted;
        judgement.error_over_bound = Some(self.figures.error_over_bound);
        if let Some(malformed) = &self.malformed {
            judgement.differs(Cause::Vertex, None, || malformed.clone());
        }
        for difference in &self.told {
            judgement.differs(Cause::Vertex, None, || difference.to_string());
        }
        let further = self.differing - self.told.len() as u64;
        if further > 0 {
            *judgement.causes.entry(Cause::Vertex).or_default() += further;
        }
        judgement.note = self.to_string();
        judgement
    }

    fn add(&mut self, other: Self) {
        self.triangles += other.triangles;
        self.corners += other.corners;
        self.outside += other.outside;
        self.differing += other.differing;
        self.admitted += other.admitted;
        self.told.extend(other.told);
        self.told.truncate(TOLD_MAX);
        self.malformed = self.malformed.take().or(other.malformed);
        self.decisions += other.decisions;
        self.undecided += other.undecided;
        self.figures.merge(&other.figures);
    }

    /// A triangle that matches its outcome, or one of several.
    fn agree(&mut self, figures: &Figures, decision: bool) {
        self.figures.merge(figures);
        self.decisions += u64::from(decision);
        self.admitted += u64::from(decision || figures.unbounded > 0);
    }

    fn tell(&mut self, corners: usize, triangle: usize, kind: Kind) {
        self.outside += corners.max(1) as u64;
        self.differing += 1;
        if self.told.len() < TOLD_MAX {
            self.told.push(Difference { triangle, kind });
        }
    }
}

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
    let parts: Vec<VertexReport> = chunks
        .map(|(chunk, triangles)| {
            let mut part = VertexReport::default();
            for (row, triangle) in (chunk * CHUNK..).zip(triangles) {
                let corners = triangle.vertices.map(|v| positions[v as usize]);
                let outcomes = outcomes(&planes, corners);
                hold(&judge, row, outcomes, layout.polygon(row), &mut part);
            }
            part
        })
        .collect();
    for part in parts {
        report.add(part);
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

/// Holds an observed polygon against a triangle's outcomes.
fn hold(
    judge: &Judge,
    triangle: usize,
    outcomes: Option<Vec<Vec<Position<Bounded>>>>,
    observed: &[[i32; 3]],
    report: &mut VertexReport,
) {
    let Some(outcomes) = outcomes else {
        report.undecided += 1;
        report.admitted += 1;
        return;
    };
    report.corners += observed.len().max(outcomes[0].len()) as u64;
    if let [only] = outcomes.as_slice() {
        match judge.polygon(only, observed) {
            Ok(figures) => report.agree(&figures, false),
            Err(kind) => {
                let corners = match kind {
                    Kind::Corner { .. } => judge.outside(only, observed),
                    _ => observed.len().max(only.len()),
                };
                report.tell(corners, triangle, kind);
            }
        }
        return;
    }
    let matching = outcomes
        .iter()
        .find_map(|o| judge.polygon(o, observed).ok());
    match matching {
        Some(figures) => report.agree(&figures, true),
        None => {
            let kind = Kind::NoOutcome {
                outcomes: outcomes.len(),
                observed: observed.len(),
            };
            report.tell(observed.len(), triangle, kind);
        }
    }
}

impl Figures {
    fn merge(&mut self, other: &Self) {
        self.unbounded += other.unbounded;
        self.moved += other.moved;
        self.error_over_bound = self.error_over_bound.max(other.error_over_bound);
        self.error_subpixels = self.error_subpixels.max(other.error_subpixels);
        self.bound_subpixels = self.bound_subpixels.max(other.bound_subpixels);
        self.error_keys = self.error_keys.max(other.error_keys);
    }
}

#[cfg(test)]
mod tests;
