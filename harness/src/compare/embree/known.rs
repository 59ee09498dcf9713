//! What is known of a band's pairs before Embree is asked, in order of pixels.
//!
//! Triangle by triangle, as each is prepared but once then and its data stay at hand;
//! sorted by counting, which keeps the pairs of a pixel in order of `prim`.

use std::ops::Range;

use triptych_spec::raster::Span;

use super::pairs::{Expected, Pairs};
use crate::dispatch::share;

/// Triangles that one task shares out.
const SHARED: u32 = 1 << 14;

/// The triangles that may make pairs in each band of rows, in order of `prim`: a part for
/// each run of triangles, in which each band has a list.
pub(super) struct Shares(Vec<Vec<Vec<u32>>>);

impl Shares {
    /// Shares out triangles among bands of `height` rows.
    pub(super) fn new(pairs: &impl Pairs, height: u32) -> Self {
        let bands = pairs.size().height.div_ceil(height) as usize;
        let of_part = |part: u32| {
            let first = part * SHARED;
            let mut shares = vec![Vec::new(); bands];
            for prim in first..pairs.count().min(first + SHARED) {
                let rows = pairs.rows(&pairs.candidate(prim));
                if !rows.is_empty() {
                    let last = (rows.end - 1) / height;
                    let met = &mut shares[(rows.start / height) as usize..=last as usize];
                    met.iter_mut().for_each(|share| share.push(prim));
                }
            }
            shares
        };
        let parts = pairs.count().div_ceil(SHARED);
        Self(share::runs(parts as usize, 1, |parts| {
            let numbers = (0..).skip(parts.start).take(parts.len());
            numbers.map(of_part).collect()
        }))
    }

    fn of(&self, band: usize) -> impl Iterator<Item = u32> {
        self.0.iter().flat_map(move |part| &part[band]).copied()
    }
}

/// A triangle and what must come of it at a pixel.
pub(super) struct Known {
    pub prim: u32,
    pub expected: Expected,
}

/// The pairs of a band.
pub(super) struct Band {
    all: Vec<Known>,
    /// Where each pixel's pairs begin in `order`, and the end.
    starts: Vec<usize>,
    /// Numbers of pairs, by pixel and triangle.
    order: Vec<u32>,
}

impl Band {
    /// All pairs of the rows `rows`, which are band `band` of those that `shares` is of.
    pub(super) fn new(pairs: &impl Pairs, shares: &Shares, band: usize, rows: &Span) -> Self {
        let width = pairs.size().width;
        let mut starts = vec![0; rows.len() * width as usize + 1];
        let (mut all, mut pixels) = (Vec::new(), Vec::new());
        for prim in shares.of(band) {
            let triangle = pairs.candidate(prim);
            let own = pairs.rows(&triangle);
            for row in own.start.max(rows.start)..own.end.min(rows.end) {
                let (columns, prepared) = pairs.reach(&triangle, row);
                for column in columns {
                    let expected = pairs.expect(&triangle, &prepared, [column, row]);
                    let pixel = (row - rows.start) * width + column;
                    starts[pixel as usize + 1] += 1;
                    pixels.push(pixel);
                    all.push(Known { prim, expected });
                }
            }
        }
        for pixel in 1..starts.len() {
            starts[pixel] += starts[pixel - 1];
        }
        let mut next = starts.clone();
        let mut order = vec![0; all.len()];
        for (pair, pixel) in (0_u32..).zip(pixels) {
            let place = &mut next[pixel as usize];
            order[*place] = pair;
            *place += 1;
        }
        Self { all, starts, order }
    }

    /// The pairs of a pixel, counted from the band's first, in order of `prim`.
    pub(super) fn of(&self, pixel: usize) -> impl Iterator<Item = &Known> {
        let range: Range<usize> = self.starts[pixel]..self.starts[pixel + 1];
        self.order[range]
            .iter()
            .map(|pair| &self.all[*pair as usize])
    }
}
