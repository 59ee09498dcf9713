//! What a comparison found.

use crate::cause::Cause;
use crate::compare::Judgement;
use crate::row::Class;

/// Differences that a report tells in full.
pub const TOLD_MAX: usize = 8;

/// What comparing the corners of a scene gave, in stage `clip` or `snap`. Every difference has cause
/// [`crate::cause::Cause::Vertex`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct VertexReport {
    /// Source triangles: all of them in `clip`, those with a polygon in `snap`.
    pub triangles: u64,
    /// Corners held against their bound, or missing, or too many.
    pub corners: u64,
    /// Corners outside; a polygon that matches no outcome counts all its corners
    /// (at least one).
    pub outside: u64,
    /// Triangles that do not meet a neighbour where both were cut, although all their
    /// corners are inside their bounds.
    pub cracks: u64,
    /// Triangles that differ: with corners outside, or cracks.
    pub differing: u64,
    /// The first [`TOLD_MAX`] differences, in order of triangles.
    pub told: Vec<Difference>,
    /// The observed rows are no fans in order of triangles: nothing was compared
    /// beyond that point.
    pub malformed: Option<String>,
    /// Triangles with a branch that may go either way; one outcome matched.
    pub decisions: u64,
    /// Triangles with more than [`super::OUTCOMES_MAX`] outcomes: not judged.
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
    /// Corners with a coordinate on which WGSL promises nothing, or so little that
    /// every integer of the axis conforms; their other coordinates were judged.
    pub unbounded: u64,
    /// Corners inside their bounds whose x or y is another sub-pixel than the spec's.
    pub moved: u64,
    /// Largest error: of any component in homogeneous pixels (`clip`), or of z in keys
    /// (`snap`, where rounding seldom lets x or y prove any).
    pub error: f64,
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
    /// Row in [`triptych_spec::scene::Scene::triangles`].
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
        /// 0 to 3 for x, y, z, w; on the grid in sub-pixels and keys.
        axis: usize,
        /// What it should be; on the grid, before rounding.
        value: f64,
        /// Largest distance from it.
        bound: f64,
        /// As observed.
        observed: f64,
    },
    /// A corner of clipping is not where a triangle with the same edge has it.
    Crack {
        /// Number of the corner within the polygon.
        corner: usize,
        /// Row of the other triangle.
        neighbour: usize,
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
    /// Nothing can be compared, and why.
    pub(super) fn malformed(message: String) -> Self {
        Self {
            malformed: Some(message),
            ..Self::default()
        }
    }

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
        judgement.error = Some(self.figures.error);
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

    pub(super) fn add(&mut self, other: Self) {
        self.triangles += other.triangles;
        self.corners += other.corners;
        self.outside += other.outside;
        self.cracks += other.cracks;
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
    pub(super) fn agree(&mut self, figures: &Figures, decision: bool) {
        self.figures.merge(figures);
        self.decisions += u64::from(decision);
        self.admitted += u64::from(decision || figures.unbounded > 0);
    }

    /// Triangles that do not meet a neighbour.
    pub(super) fn add_cracks(&mut self, cracks: Vec<Difference>) {
        for crack in cracks {
            self.cracks += 1;
            self.tell(crack);
        }
    }

    pub(super) fn tell(&mut self, difference: Difference) {
        self.differing += 1;
        if self.told.len() < TOLD_MAX {
            self.told.push(difference);
        }
    }
}

impl Figures {
    pub(super) fn merge(&mut self, other: &Self) {
        self.unbounded += other.unbounded;
        self.moved += other.moved;
        self.error = self.error.max(other.error);
        self.error_over_bound = self.error_over_bound.max(other.error_over_bound);
        self.error_subpixels = self.error_subpixels.max(other.error_subpixels);
        self.bound_subpixels = self.bound_subpixels.max(other.bound_subpixels);
        self.error_keys = self.error_keys.max(other.error_keys);
    }
}
