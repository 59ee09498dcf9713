//! Pairs in screen space: the spec's snapped triangles, parallel rays.

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
    triangle: Triangle,
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

    fn rows(&self, prim: u32) -> Span {
        let Primitives { size, bits, .. } = *self.spec;
        Setup::new(self.spec, prim).map_or(0..0, |setup| setup.rows(size, bits))
    }

    fn candidate(&self, prim: u32) -> Candidate {
        Candidate {
            prim,
            setup: Setup::new(self.spec, prim),
            triangle: Triangle::new(self.spec, &self.depth, prim),
        }
    }

    fn reach(&self, triangle: &Candidate, row: u32) -> (Span, ()) {
        let Some(setup) = &triangle.setup else {
            return (0..0, ());
        };
        // With E the least edge function, negative, the sum of all is at
        // most area + 4 |E|, so class edge ends at |E| = area 2^-22
        // (1 + 2^-19), which is below this as area is at most 2^40.
        let least = -(setup.area >> EDGE_BITS) - 3;
        let Primitives { size, bits, .. } = *self.spec;
        (setup.span_above([least; 3], row, size, bits), ())
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
            match (triangle.triangle.promise(point), covering) {
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
