//! Coverage with several samples in a pixel (Yang et al. 2010, section 4.1.2).
//!
//! A triangle's samples of one number, over all pixels of a row, are a span, as with one sample
//! a pixel. So a row has a span for each, and a pixel's mask is which of them hold it. What a
//! row may cover is the union of all: wider than any by up to a pixel.

use super::samples::{SAMPLES_MAX, Samples, samples_of};
use super::{Fragment, Setup, Span, column, first_pixel};
use crate::vertex::Primitives;

impl Setup {
    /// Rows of the target of which any sample may be covered.
    pub(super) fn rows_of_samples(&self, primitives: &Primitives) -> Span {
        let (samples, bits) = (primitives.samples, primitives.bits);
        let y = self.corners.map(|c| c[1]);
        let (low, high) = (y[0].min(y[1]).min(y[2]), y[0].max(y[1]).max(y[2]));
        let side = primitives.size.height;
        let rows = samples.offsets(bits).map(|[_, down]| {
            first_pixel(low, down, bits, side)..first_pixel(high + 1, down, bits, side)
        });
        union(rows)
    }

    /// Columns and rows of the target whose [`Samples::extent`] meets the triangle's box.
    pub(crate) fn pixels(&self, primitives: &Primitives) -> [Span; 2] {
        let (size, bits) = (primitives.size, primitives.bits);
        let extent = primitives.samples.extent(bits);
        let span = |axis: usize, side: u32| {
            let [a, b, c] = self.corners.map(|corner| corner[axis]);
            let (low, high) = (a.min(b).min(c), a.max(b).max(c));
            let [least, largest] = extent.map(|place| place[axis]);
            first_pixel(low, largest, bits, side)..first_pixel(high + 1, least, bits, side)
        };
        [span(0, size.width), span(1, size.height)]
    }

    /// The pixels of a row that have a covered sample, with their masks.
    pub(super) fn masks(&self, row: u32, primitives: &Primitives, mut emit: impl FnMut(u32, u32)) {
        let (size, bits) = (primitives.size, primitives.bits);
        let least = [0, 1, 2].map(|i| self.least(i));
        let mut spans: [Span; SAMPLES_MAX] = std::array::from_fn(|_| 0..0);
        for (span, [right, down]) in spans.iter_mut().zip(primitives.samples.offsets(bits)) {
            let origin = [right, (i64::from(row) << bits) + down];
            *span = self.span_from(least, origin, size, bits);
        }
        for x in union(spans.iter().cloned()) {
            let bit = |(s, span): (usize, &Span)| u32::from(span.contains(&x)) << s;
            let mask = spans.iter().enumerate().map(bit).sum();
            if mask != 0 {
                emit(x, mask);
            }
        }
    }

    /// The depth key at sample `s` of a pixel; `None` if the triangle does not cover it.
    pub fn key_at(&self, primitives: &Primitives, pixel: u32, s: u32) -> Option<u32> {
        let width = primitives.size.width;
        let place = [pixel % width, pixel / width];
        let edges = self.edges(primitives.samples.point(s, place, primitives.bits));
        self.covers(edges).then(|| self.key(edges))
    }

    /// Every fragment of the triangle, in order of row and column.
    pub(super) fn fragments(
        &self,
        prim: u32,
        primitives: &Primitives,
        emit: &mut impl FnMut(Fragment),
    ) {
        for row in self.rows_of_samples(primitives) {
            self.masks(row, primitives, |x, mask| {
                let pixel = row * primitives.size.width + x;
                let lowest = mask.trailing_zeros();
                let key = self.key_at(primitives, pixel, lowest);
                let key = key.expect("the mask is of covered samples");
                emit(Fragment {
                    pixel,
                    prim,
                    key,
                    mask,
                });
            });
        }
    }
}

impl Primitives {
    /// The triangles as one sample of every pixel sees them: moved so that it is in the middle,
    /// as the only one. What this covers, with which keys, is what sample `s` does here.
    #[must_use]
    pub fn of_sample(&self, s: u32) -> Self {
        let [x, y] = self.samples.point(s, [0, 0], self.bits);
        let middle = 1_i64 << (self.bits - 1);
        // Less than a pixel, and corners are below 2^21.
        let by = [middle - x, middle - y].map(|d| i32::try_from(d).expect("less than a pixel"));
        let moved = |[x, y, z]: &[i32; 3]| [x + by[0], y + by[1], *z];
        Self {
            samples: Samples::ONE,
            snapped: self.snapped.iter().map(moved).collect(),
            ..self.clone()
        }
    }
}

/// How many nodes fragments take if each of their samples is a node, which section 4.1.2
/// rejects for its memory; with a mask in the node it is one a fragment.
pub fn sample_nodes<'f>(fragments: impl Iterator<Item = &'f Fragment>) -> u64 {
    let samples = |f: &Fragment| samples_of(f.mask).count() as u64;
    fragments.map(samples).sum()
}

/// The least span that holds them all; an empty one holds nothing.
fn union(spans: impl Iterator<Item = Span>) -> Span {
    let full = spans.filter(|span| !span.is_empty());
    full.reduce(|a, b| a.start.min(b.start)..a.end.max(b.end))
        .unwrap_or(column(0)..column(0))
}
