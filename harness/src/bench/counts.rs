//! What a technique must move at least, counted from fragments and layers.
//!
//! With `P` pixels, `F` fragments in lists, `C` transparent fragments before the depth
//! test, `O` opaque fragments on `Q` pixels, `T` transparent and `U` opaque triangles,
//! `S(n)` layers shown (the sum over pixels of `min(n, layers)`), and `M` the sum over
//! lists of `length * ceil(log2 length)`, and `R` what tells of the rows of tiles: one word of each, and one
//! for each entry of its longest list; buffers as in `gpu/src/abuffer.wgsl`, each
//! word counted once for each time that a kernel has to read or write it, and what belongs to a triangle
//! once a kernel, however many read it, as a cache may hold it; `H(n)` is the least of `S(n)` and `T`:
//!
//! | part | bytes | atomics |
//! |---|---|---|
//! | clear: head, opaque key and triangle | `12 P` | |
//! | opaque: triangle twice; minimum of keys, key again, minimum of triangles | `88 U + 12 O + 8 Q` | `O + Q` |
//! | build: triangle with colour; of what is stored opaque key, head, node and colour | `60 T + 44 F` | `2 F` |
//! | insertion: head, key, triangle, picture; every node; colours shown | `28 P + 16 F + 16 S(n)` | |
//! | sort: head, progress (cleared, read, written); node read and link written | `104 P + 20 M` | |
//! | sorted: head, key, triangle, picture; nodes and colours shown | `28 P + 32 S(n)` | |
//! | resolve: the same with progress and the picture so far | `140 P + 32 S(all)` | |
//!
//! | bin, by tiles: triangle and its face twice, the face of opaque ones as well; its number in `B` bins | `72 T + 32 (T + U) + 4 B` | `2 B` |
//! | place: number and triangle, opaque key; length written; list read and placed; rows | `36 T + 4 B + 40 P + 4 R` | |
//! | fill: number and triangle, opaque key; list, how far it is filled; rows; entry of `E` bytes | `36 T + 4 B + 28 P + 4 R + E F` | |
//! | shade: list, surface, picture; rows; entries and colours shown | `36 P + 4 R + E S(n) + 16 H(n)` | |
//! | of linked lists, in place of rows: a word of a pixel in fill and in shade | `4 P` for `4 R` | |
//! | reduced to `P'` pixels: all of clear to sorted there; layer and key read, surface, picture | `20 P' + 24 P` | |
//! | others, each time: triangle with colour, keys, picture; then surface, picture | `60 T + 12 C + 16 P`; `24 P` | |
//!
//! What coverage computes is not counted: it is arithmetic. So a frame of small
//! triangles is far from this bound on purpose. The spec is held to the same bytes.

mod counted;
mod layouts;

use super::Method;
use triptych_gpu::abuffer::Part;
use triptych_spec::abuffer::{NOTHING, visible};
use triptych_spec::raster::{self, Fragment};

use crate::replay::spec::SpecRun;
pub use counted::Counted;

/// What the formulas are made of, on one sub-pixel grid.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    pixels: u64,
    /// Fragments in lists.
    pub fragments: u64,
    considered: u64,
    opaque_fragments: u64,
    opaque_pixels: u64,
    transparent: u64,
    opaque: u64,
    /// How many lists there are of each length.
    lengths: Vec<u64>,
    /// The same of what of a list is not hidden, and so is shown.
    seen: Vec<u64>,
    /// Words that tell where rows of a tile are: one, and one more for each entry of its longest list.
    rows: u64,
}

/// Bytes and atomics.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// Bytes read and written.
    pub bytes: u64,
    /// Atomics that read and write.
    pub atomics: u64,
}

impl Work {
    /// This and that.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self {
            bytes: self.bytes + other.bytes,
            atomics: self.atomics + other.atomics,
        }
    }
}

impl Counts {
    /// Of a scene, as the spec sees it.
    pub fn of(run: &SpecRun) -> Self {
        let opaque = |prim: &u32| run.is_opaque(*prim);
        let all = raster::count(&run.primitives);
        let opaque_fragments = run.cover.iter().filter(|f| opaque(&f.prim)).count() as u64;
        let triangles = run.faces.len() as u64;
        let opaque_triangles = run.faces.iter().filter(|face| face[3] >= 1.0).count() as u64;
        let is_seen = |f: &&Fragment| visible(&run.primitives, &run.opaque, f) != 0;
        let seen = (0..run.primitives.size.pixels())
            .map(|pixel| run.sorted.list(pixel).iter().filter(is_seen).count());
        Self {
            pixels: run.primitives.size.pixels() as u64,
            fragments: run.sorted.fragments.len() as u64,
            considered: all - opaque_fragments,
            opaque_fragments,
            opaque_pixels: run.opaque.prim.iter().filter(|p| **p != NOTHING).count() as u64,
            transparent: triangles - opaque_triangles,
            opaque: opaque_triangles,
            lengths: histogram(run.sorted.lengths()),
            seen: histogram(seen.map(|n| u32::try_from(n).expect("of a list"))),
            rows: counted::rows(
                &run.sorted.lengths().collect::<Vec<_>>(),
                run.primitives.size,
            ),
        }
    }

    /// Fragments of the longest list.
    pub fn longest(&self) -> u32 {
        u32::try_from(self.lengths.len().saturating_sub(1)).unwrap_or(u32::MAX)
    }

    /// Layers shown, `S(n)`: what lies behind an opaque surface ends a list that holds it.
    pub(super) fn shown(&self, n: u32) -> u64 {
        sum(&self.seen, |length| length.min(n.into()))
    }

    /// Triangles of so many nearest layers, at most.
    fn faces(&self, n: u32) -> u64 {
        self.shown(n).min(self.transparent)
    }

    /// Nodes that are relinked, `M`.
    fn merged(&self) -> u64 {
        sum(&self.lengths, |length| {
            length * u64::from(length.max(1).next_power_of_two().ilog2())
        })
    }

    /// What a part must do.
    pub fn work(&self, part: Part) -> Work {
        let p = self.pixels;
        let bytes = match part {
            Part::Clear => 12 * p,
            Part::Opaque => 88 * self.opaque + 12 * self.opaque_fragments + 8 * self.opaque_pixels,
            // What is hidden may have been left out before it is asked for its key.
            Part::Build => 60 * self.transparent + 44 * self.fragments,
            Part::Nearest(n) => 28 * p + 16 * self.fragments + 16 * self.shown(n),
            Part::Sort => 104 * p + 20 * self.merged(),
            Part::NearestSorted(n) => 28 * p + 32 * self.shown(n),
            Part::Resolve => 140 * p + 32 * self.fragments,
        };
        let atomics = match part {
            Part::Opaque => self.opaque_fragments + self.opaque_pixels,
            Part::Build => 2 * self.fragments,
            _ => 0,
        };
        Work { bytes, atomics }
    }

    /// What a frame by tiles must do beside stage opaque, with so many triangles in bins.
    pub fn by_tiles(&self, binned: u64, layers: u32, method: Method) -> Work {
        let (entry, counted) = (method.entry(), u64::from(method == Method::Tiles));
        let (p, triangles) = (self.pixels, self.transparent + self.opaque);
        let bin = 2 * (36 * self.transparent + 16 * triangles) + 4 * binned;
        let drawn = 36 * self.transparent + 4 * binned;
        let told = match method {
            Method::Tiles => 4 * self.rows,
            _ => 4 * p,
        };
        let place = counted * (drawn + 4 * p + 12 * p + 24 * p + told);
        let fill = drawn + 4 * p + 24 * p + told + entry * self.fragments;
        let shade = 12 * p + told + entry * self.shown(layers) + 24 * p + 16 * self.faces(layers);
        Work {
            bytes: bin + place + fill + shade,
            atomics: 2 * binned,
        }
    }

    /// What a target with so few pixels must do for the full one, beside stage opaque there.
    pub fn reduced(&self, full: &Self) -> Work {
        let parts = [Part::Clear, Part::Opaque, Part::Build, Part::Sort];
        let shown = self.work(Part::NearestSorted(self.longest()));
        let upsampled = Work {
            bytes: 20 * self.pixels + 24 * full.pixels,
            atomics: 0,
        };
        let lists = parts.into_iter().map(|part| self.work(part));
        lists.fold(shown.and(upsampled), Work::and)
    }

    /// What techniques beside lists must do, beside stage opaque: going through the triangles
    /// `times` times, each time with the fragments' keys, and through the pixels.
    pub fn gone_through(&self, times: u32) -> Work {
        let triangles = 60 * self.transparent + 12 * self.considered;
        Work {
            bytes: u64::from(times) * (triangles + 16 * self.pixels) + 24 * self.pixels,
            atomics: 0,
        }
    }

    /// Bytes of the triangles with their colours.
    pub fn triangles(&self) -> u64 {
        52 * (self.transparent + self.opaque)
    }

    /// Bytes that the spec holds: triangles as above; of each pixel head, surface, offset
    /// and a picture of numbers with bounds; node and colour; the fragments in order.
    pub fn spec_memory(&self, layers: u32) -> u64 {
        self.triangles() + 64 * self.pixels + 32 * self.fragments + 16 * self.shown(layers)
    }
}

/// How many lists there are of each length.
fn histogram(lengths: impl Iterator<Item = u32>) -> Vec<u64> {
    let mut lists = Vec::new();
    for length in lengths {
        let length = length as usize;
        if lists.len() <= length {
            lists.resize(length + 1, 0);
        }
        lists[length] += 1;
    }
    lists
}

/// The sum over lists of something that depends on the length.
fn sum(lists: &[u64], of: impl Fn(u64) -> u64) -> u64 {
    let each = (0_u64..).zip(lists);
    each.map(|(length, lists)| lists * of(length)).sum()
}

#[cfg(test)]
mod tests {
    use triptych_gpu::abuffer;

    use super::*;

    /// Two empty pixels, one list of one, and two of five.
    pub(super) fn counts() -> Counts {
        Counts {
            pixels: 5,
            fragments: 11,
            considered: 12,
            opaque_fragments: 4,
            opaque_pixels: 3,
            transparent: 2,
            opaque: 1,
            lengths: vec![2, 1, 0, 0, 0, 2],
            seen: vec![2, 1, 0, 0, 0, 2],
            rows: 6,
        }
    }

    #[test]
    fn formulas_are_those_of_the_table() {
        let counts = counts();
        let work = |part| counts.work(part);
        let must = |bytes, atomics| Work { bytes, atomics };
        assert_eq!(work(Part::Clear), must(60, 0));
        assert_eq!(work(Part::Opaque), must(88 + 48 + 24, 7));
        assert_eq!(work(Part::Build), must(120 + 484, 22));
        // Shown: 1 + 2 + 2.
        assert_eq!(work(Part::Nearest(2)), must(140 + 176 + 80, 0));
        assert_eq!(work(Part::NearestSorted(2)), must(140 + 160, 0));
        // Five are merged in three passes, one in none.
        assert_eq!(work(Part::Sort), must(520 + 20 * 2 * 5 * 3, 0));
        assert_eq!(work(Part::Resolve), must(700 + 352, 0));
        // Two layers of eleven fragments are five, of no more than two triangles.
        let drawn = 36 * 2 + 4 * 7;
        let tiles = 2 * (36 * 2 + 16 * 3) + 4 * 7 + 2 * drawn + 8 * 11 + 8 * 5 + 16 * 2;
        let tiles = tiles + 104 * 5 + 12 * 6;
        assert_eq!(counts.by_tiles(7, 2, Method::Tiles), must(tiles, 14));
        assert_eq!(counts.longest(), 5);
        assert_eq!(counts.gone_through(3), must(3 * (120 + 144 + 80) + 120, 0));
        assert_eq!(counts.triangles(), 156);
        // Clear, opaque, build, sort and sorted as above, of which eleven are shown.
        let reduced = 60 + 160 + 604 + 1_120 + 140 + 352 + 100 + 24 * 20;
        let full = Counts {
            pixels: 20,
            ..counts.clone()
        };
        assert_eq!(counts.reduced(&full), must(reduced, 29));
        assert_eq!(abuffer::bytes([5, 1], 11, false), 140 + 352);
        assert_eq!(abuffer::bytes([5, 1], 11, true), 140 + 352 + 160);
        assert_eq!(abuffer::bytes([5, 4], 11, false), 5 * (4 + 4 * 24) + 352);
        assert_eq!(counts.spec_memory(9), 156 + 320 + 352 + 176);
    }
}
