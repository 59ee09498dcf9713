//! What is known of a ray and a triangle before Embree is asked.

use triptych_spec::raster::Span;
use triptych_spec::scene::Size;

/// A view of a scene in which Embree's hits can be judged.
pub(super) trait Pairs: Sync {
    /// A triangle, prepared.
    type Candidate;
    /// A triangle in a row, prepared.
    type Row: Clone;

    /// Size of the target.
    fn size(&self) -> Size;

    /// Number of triangles.
    fn count(&self) -> u32;

    /// Prepares a triangle, no more than [`Self::reach`] needs: most make no pair.
    fn candidate(&self, prim: u32) -> Self::Candidate;

    /// Rows in which a triangle may make pairs.
    fn rows(&self, triangle: &Self::Candidate) -> Span;

    /// The columns of a row in which a triangle makes pairs: where it is covered, or in
    /// class edge.
    fn reach(&self, triangle: &Self::Candidate, row: u32) -> (Span, Self::Row);

    /// What must come of a pair.
    fn expect(&self, triangle: &Self::Candidate, row: &Self::Row, pixel: [u32; 2]) -> Expected;

    /// A hit's distance as a depth key.
    fn key(&self, t: f32) -> f64;
}

/// What must come of a pair.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Expected {
    /// Whether the spec covers the sample.
    pub covered: bool,
    /// Its class.
    pub class: Class,
}

/// The class of a pair.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Class {
    /// Too close to an edge.
    Edge,
    /// Embree's own arithmetic cannot tell.
    Unresolved,
    /// To be judged.
    Judged {
        /// The spec's depth key and the bound of Embree's, where it is covered.
        depth: Option<(u32, f64)>,
    },
}
