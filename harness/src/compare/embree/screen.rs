//! Pairs in screen space: the spec's snapped triangles, parallel rays.

use std::cell::OnceCell;

use triptych_spec::raster::{Setup, Span, sample};
use triptych_spec::scene::Size;
use triptych_spec::vertex::Primitives;

use super::edge::{EDGE_BITS, flat_edges, is_edge};
use super::pairs::{Class, Expected, Pairs};
use crate::embree::bound::{Promise, Triangle};
use crate::embree::scene::Depth;

/// The spec's triangles, and the scale on which Embree has their depths.
pub(super) struct Screen<'a> {
    pub spec: &'a Primitives,
    pub depth: Depth,
}

/// A row of the triangles; one without area has no setup.
pub(super) struct Candidate {
    prim: u32,
    setup: Option<Setup>,
    rows: Span,
    columns: Span,
    /// What Embree makes of it; for its first pair.
    triangle: OnceCell<Triangle>,
}

impl Screen<'_> {
    /// The rows and columns outside of which a triangle makes no pair.
    ///
    /// In class edge, barycentric coordinates are at least -2^-22 (1 + 2^-19). So a sample
    /// there is beyond the corners by at most twice that of a width of 2^20 sub-pixels, which
    /// is less than one: it is not beyond them, as both are whole numbers.
    fn extent(&self, setup: &Setup) -> [Span; 2] {
        let Primitives { size, bits, .. } = *self.spec;
        let rows = setup.rows(size, bits);
        if rows.is_empty() {
            return [0..0, 0..0];
        }
        let columns = setup.columns(size, bits);
        // Most triangles of a fine mesh have one sample about, and miss it.
        let single = rows.len() == 1 && columns.len() == 1;
        if columns.is_empty() || single && !self.meets(setup, columns.start, rows.start) {
            return [0..0, 0..0];
        }
        [rows, columns]
    }

    /// Whether a pixel and a triangle make a pair.
    fn meets(&self, setup: &Setup, column: u32, row: u32) -> bool {
        let point = [column, row].map(|pixel| sample(pixel, self.spec.bits));
        setup
            .edges(point)
            .into_iter()
            .all(|edge| edge >= least(setup))
    }
}

impl Pairs for Screen<'_> {
    type Candidate = Candidate;
    type Row = ();

    fn size(&self) -> Size {
        self.spec.size
    }

    fn count(&self) -> u32 {
        u32::try_from(self.spec.prims.len()).expect("Embree has accepted them")
    }

    fn candidate(&self, prim: u32) -> Candidate {
        let setup = Setup::new(self.spec, prim);
        let [rows, columns] = setup.as_ref().map_or([0..0, 0..0], |s| self.extent(s));
        Candidate {
            prim,
            setup,
            rows,
            columns,
            triangle: OnceCell::new(),
        }
    }

    fn rows(&self, triangle: &Candidate) -> Span {
        triangle.rows.clone()
    }

    fn reach(&self, triangle: &Candidate, row: u32) -> (Span, ()) {
        let Some(setup) = &triangle.setup else {
            return (0..0, ());
        };
        let Primitives { size, bits, .. } = *self.spec;
        // One sample is tested without a division.
        let columns = triangle.columns.clone();
        let span = match columns.len() {
            1 if self.meets(setup, columns.start, row) => columns,
            1 => 0..0,
            _ => setup.span_above([least(setup); 3], row, size, bits),
        };
        (span, ())
    }

    fn expect(&self, triangle: &Candidate, (): &(), [column, row]: [u32; 2]) -> Expected {
        let bits = self.spec.bits;
        let point = [sample(column, bits), sample(row, bits)];
        let setup = triangle.setup.as_ref();
        let flat = || flat_edges(self.spec, triangle.prim, point);
        let edges = setup.map_or_else(flat, |s| s.edges(point));
        let covering = setup.filter(|s| s.covers(edges));
        let class = if is_edge(edges) {
            Class::Edge
        } else {
            let prepared = || Triangle::new(self.spec, &self.depth, triangle.prim);
            let promise = triangle.triangle.get_or_init(prepared).promise(point);
            match (promise, covering) {
                (Promise::Unresolved, _) => Class::Unresolved,
                (Promise::Hit { bound }, Some(setup)) => Class::Judged {
                    // The key is the floor of the exact depth: one key more on that side.
                    depth: Some((setup.key(edges), bound + 1.0)),
                },
                _ => Class::Judged { depth: None },
            }
        };
        Expected {
            covered: covering.is_some(),
            class,
        }
    }

    fn key(&self, t: f32) -> f64 {
        self.depth.key(t)
    }
}

/// No edge function is below this in class edge. With E the least of them, negative, the sum
/// of all is at most area + 4 |E|, so class edge ends at |E| = area 2^-22 (1 + 2^-19), which
/// is less as area is at most 2^40.
fn least(setup: &Setup) -> i64 {
    -(setup.area >> EDGE_BITS) - 3
}
