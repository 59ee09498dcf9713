//! What triangles cover, without evaluating it.

use std::ops::Range;

use super::{Setup, Span, column};
use crate::vertex::Primitives;

/// Rows of the target between a triangle's corners; it covers nothing in any other.
pub fn rows_between(primitives: &Primitives, prim: u32) -> Span {
    let [a, b, c] =
        primitives.prims[prim as usize].map(|corner| primitives.snapped[corner as usize][1]);
    let (first, last) = (a.min(b).min(c), a.max(b).max(c));
    let height = i64::from(primitives.size.height);
    let row = |y: i32| i64::from(y >> primitives.bits);
    let end = (row(last) + 1).clamp(0, height);
    column(row(first).clamp(0, end))..column(end)
}

/// How many fragments [`cover`](super::cover) emits, without evaluating them.
pub fn count(primitives: &Primitives) -> u64 {
    count_run(primitives, 0..primitives.prims.len())
}

/// [`count`] of some rows of [`Primitives::prims`].
pub fn count_run(primitives: &Primitives, run: Range<usize>) -> u64 {
    let (size, bits) = (primitives.size, primitives.bits);
    let fragments = |prim| {
        let setup = Setup::new(primitives, prim)?;
        if primitives.samples.count() > 1 {
            let mut fragments = 0;
            for row in setup.rows_of_samples(primitives) {
                setup.masks(row, primitives, |_, _| fragments += 1);
            }
            return Some(fragments);
        }
        let span = |row| setup.span(row, size, bits).len() as u64;
        Some(setup.rows(size, bits).map(span).sum::<u64>())
    };
    let prims = run.map(|prim| column(prim as i64));
    prims.filter_map(fragments).sum()
}
