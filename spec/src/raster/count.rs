//! What triangles cover, without evaluating it.

use super::{Setup, column};
use crate::vertex::Primitives;

/// Whether any row between a triangle's corners is the target's.
pub(super) fn reaches(primitives: &Primitives, prim: u32) -> bool {
    let rows = primitives.prims[prim as usize].map(|corner| primitives.snapped[corner as usize][1]);
    let end = (primitives.size.height << primitives.bits).cast_signed();
    rows.iter().any(|y| *y >= 0) && rows.iter().any(|y| *y < end)
}

/// How many fragments [`cover`](super::cover) emits, without evaluating them.
pub fn count(primitives: &Primitives) -> u64 {
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
    (0..column(primitives.prims.len() as i64))
        .filter_map(fragments)
        .sum()
}
