//! What lists in other layouts must move at least; letters and rules as in the table of counts, `H` of all
//! layers.
//!
//! | layout | clear and build | atomics | order and blend |
//! |---|---|---|---|
//! | bucket: counter; entry. Counter, entries read and written; entries and colours shown | `4 P + 44 T + 4 C + 16 F` | `F` | `32 P + 24 F + 16 H` |
//! | precalc: the triangles twice, counters twice; sums; offset, entry. The same | `88 T + 8 C + 12 P + 28 F` | `2 F` | `32 P + 24 F + 16 H` |
//! | packed: head, node. Stages sort and resolve on nodes with their colours; head | `60 T + 4 C + 24 F` | `2 F` | `248 P + 20 M + 16 F` |
//! | regions: head, node, colour. Stages sort and resolve | `4 P + 60 T + 4 C + 40 F` | `2 F` | `244 P + 20 M + 32 F` |
//! | ordered: 2 links and nodes emptied; link and node, once or by two passes. Link, node, colour | `4 P + 44 T + 4 C + 48 F` or `4 P + 88 T + 8 C + 56 F` | `3 F` or `4 F` | `28 P + 12 F + 16 H` |
//!
//! How far a fragment goes along an ordered list depends on which came before it, and is not counted.

use triptych_gpu::layouts::Layout;

use super::{Counts, Work};

impl Counts {
    /// What the lists of a layout and their picture must do, beside stage opaque; `wide`: one atomic
    /// holds all of an entry.
    pub fn laid_out(&self, layout: Layout, wide: bool) -> Work {
        let (p, f, merged) = (self.pixels, self.fragments, self.merged());
        let pass = 44 * self.transparent + 4 * self.considered;
        let coloured = pass + 16 * self.transparent;
        let faces = 16 * self.faces(u32::MAX);
        let (bytes, atomics) = match layout {
            Layout::Bucket => (pass + 36 * p + 40 * f + faces, f),
            Layout::Precalc => (2 * pass + 44 * p + 52 * f + faces, 2 * f),
            Layout::Packed => (coloured + 248 * p + 40 * f + 20 * merged, 2 * f),
            Layout::Regions => (coloured + 248 * p + 72 * f + 20 * merged, 2 * f),
            Layout::Ordered if wide => (pass + 32 * p + 60 * f + faces, 3 * f),
            Layout::Ordered => (2 * pass + 32 * p + 68 * f + faces, 4 * f),
        };
        Work { bytes, atomics }
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::counts;
    use super::*;

    /// Five pixels, two transparent triangles, twelve fragments of which eleven are in lists, and two
    /// lists of five that are merged in three passes.
    #[test]
    fn formulas_are_those_of_the_table() {
        let counts = counts();
        let must = |bytes, atomics| Work { bytes, atomics };
        let of = |layout| counts.laid_out(layout, false);
        let (once, coloured) = (88 + 48, 120 + 48);
        let faces = 16 * 2;
        assert_eq!(
            of(Layout::Bucket),
            must(20 + once + 176 + 160 + 264 + faces, 11)
        );
        let precalc = 2 * once + 60 + 308 + 160 + 264 + faces;
        assert_eq!(of(Layout::Precalc), must(precalc, 22));
        let packed = coloured + 264 + 1240 + 20 * 30 + 176;
        assert_eq!(of(Layout::Packed), must(packed, 22));
        let regions = 20 + coloured + 440 + 1220 + 20 * 30 + 352;
        assert_eq!(of(Layout::Regions), must(regions, 22));
        let ordered = 20 + 2 * once + 616 + 140 + 132 + faces;
        assert_eq!(of(Layout::Ordered), must(ordered, 44));
        let wide = 20 + once + 528 + 140 + 132 + faces;
        assert_eq!(counts.laid_out(Layout::Ordered, true), must(wide, 33));
    }
}
