//! A-buffer by tiles: triangles in bins, and the lists of a tile's pixels side by side.
//!
//! The lists are those of [`crate::abuffer`] (Yang, Hensley, Grün and Thibieroz 2010, section 4.1),
//! without links: what the paper calls Precalc counts fragments, then fills runs of one array. Here
//! triangles are sorted to tiles of 8 x 8 pixels first (Molnar, Cox, Ellsworth and Fuchs 1994:
//! "sort-middle"), so that one workgroup owns all lists of a tile, and the lists of a tile lie as
//! jagged diagonals (Saad 1989), so that neighbouring pixels read and write neighbouring words.
//!
//! Everything here is exact. Twin: `gpu/src/tiles.wgsl`.

mod entry;
mod linked;
mod local;

use std::ops::Range;

use crate::abuffer::{Opaque, resolve, visible};
use crate::bound::Bounded;
use crate::raster::{Fragment, Setup, samples_of};
use crate::scene::Scene;
use crate::vertex::Primitives;

pub use entry::{packed, sorted, unpacked};
pub use linked::linked;
pub use local::{BIN_SORTED, Digest, WINDOW, digest, local, needs_no_lists};

/// Pixels along a side of a tile.
pub const SIDE: u32 = 8;

/// Lists of a tile.
pub const LISTS: u32 = SIDE * SIDE;

/// Entries of the longest list of a tile whose lists lie in rows; a tile with a longer one keeps its
/// lists one after another.
pub const ROWS: u32 = 256;

/// Which triangles each tile of some rows of the target may hold. Tiles begin at the first of the rows.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Bins {
    /// The rows of pixels.
    pub rows: Range<u32>,
    /// Tiles in a row of them.
    pub across: u32,
    /// Where each tile's bin starts; one entry more than there are tiles, row by row.
    pub offsets: Vec<u32>,
    /// Rows of [`Primitives::prims`], rising in each bin.
    pub prims: Vec<u32>,
}

impl Bins {
    /// The triangles of a tile.
    pub fn bin(&self, tile: usize) -> &[u32] {
        &self.prims[self.offsets[tile] as usize..self.offsets[tile + 1] as usize]
    }

    /// Number of tiles.
    pub fn tiles(&self) -> usize {
        self.offsets.len() - 1
    }

    /// The first pixel of a tile: column and row of the target.
    fn origin(&self, tile: usize) -> [u32; 2] {
        let tile = word(tile);
        [
            tile % self.across * SIDE,
            self.rows.start + tile / self.across * SIDE,
        ]
    }
}

/// A list of [`Jagged`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct List {
    /// Its first entry.
    pub start: u32,
    /// Entries.
    pub length: u32,
}

/// Lists of 8 bytes a fragment. List `64 t + l` is that of pixel `l` of tile `t`, row by row within the
/// tile; pixels beyond the target have empty ones.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Jagged {
    /// The lists.
    pub lists: Vec<List>,
    /// Of each tile, how many entries lie before each of its rows, of which it has at most [`ROWS`]: entry
    /// `i` of a list is at `start + rows[i]`. `None` where it is at `start + i`.
    pub rows: Vec<Option<Vec<u32>>>,
    /// Depth key and [`packed`] triangle of each fragment.
    pub entries: Vec<[u32; 2]>,
}

impl Jagged {
    /// Where an entry of a list is.
    pub fn slot(&self, list: usize, i: u32) -> usize {
        let moved = match &self.rows[list / LISTS as usize] {
            Some(rows) => rows[i as usize],
            None => i,
        };
        (self.lists[list].start + moved) as usize
    }
}

/// Stage `bin`: the triangles that `select` picks, by the tiles that they may cover samples of.
///
/// Samples of a pixel stand for the smallest rectangle that holds them: one sample for a point. A tile
/// lists a triangle if and only if the triangle's box meets that of a pixel of the rows in one of its
/// columns and one of its rows, and no edge has all of the tile's on its outer side (the top-left rule
/// included). So nothing that is covered is left out, and most of what is not is.
pub fn bin(primitives: &Primitives, rows: Range<u32>, select: impl Fn(u32) -> bool) -> Bins {
    let size = primitives.size;
    let across = size.width.div_ceil(SIDE);
    let down = (rows.end - rows.start).div_ceil(SIDE);
    let mut bins = vec![Vec::new(); (across * down) as usize];
    for prim in (0..word(primitives.prims.len())).filter(|prim| select(*prim)) {
        let Some(setup) = Setup::new(primitives, prim) else {
            continue;
        };
        let [columns, reached] = setup.pixels(primitives);
        let columns = tiles(columns, 0..size.width);
        for y in tiles(reached, rows.clone()) {
            for x in columns.clone() {
                if meets(&setup, [x * SIDE, rows.start + y * SIDE], primitives) {
                    bins[(y * across + x) as usize].push(prim);
                }
            }
        }
    }
    let mut offsets = vec![0];
    offsets.extend(bins.iter().scan(0, |sum, bin| {
        *sum += word(bin.len());
        Some(*sum)
    }));
    Bins {
        rows,
        across,
        offsets,
        prims: bins.concat(),
    }
}

/// The tiles of a span of pixels, as far as it lies within another that tiles begin with.
fn tiles(span: Range<u32>, within: Range<u32>) -> Range<u32> {
    let (start, end) = (span.start.max(within.start), span.end.min(within.end));
    if start >= end {
        return 0..0;
    }
    (start - within.start) / SIDE..(end - 1 - within.start) / SIDE + 1
}

/// Whether each edge leaves something of a tile to the triangle. Edge functions are linear: the largest
/// of a rectangle is at a corner.
fn meets(setup: &Setup, first: [u32; 2], primitives: &Primitives) -> bool {
    let extent = primitives.samples.extent(primitives.bits);
    let ends = |axis: usize| {
        let at = |pixel: u32, place: i64| (i64::from(pixel) << primitives.bits) + place;
        let [low, high] = extent.map(|place| place[axis]);
        [at(first[axis], low), at(first[axis] + SIDE - 1, high)]
    };
    let (xs, ys) = (ends(0), ends(1));
    let corners = [
        [xs[0], ys[0]],
        [xs[1], ys[0]],
        [xs[0], ys[1]],
        [xs[1], ys[1]],
    ];
    let edges = corners.map(|corner| setup.edges(corner));
    (0..3).all(|i| edges.iter().any(|e| e[i] >= setup.least(i)))
}

/// Stage `jagged`: the fragments of all tiles in lists, in order of triangle; if `depth_test` is set,
/// those that are hidden are left out, and samples at which one is are not in its mask.
///
/// Lists are counted first. Of a tile, entries with the same number lie in a row, those of the longest
/// list first, of equally long ones those of the first pixel; row after row, tile after tile. There is
/// nothing between them, so that a fragment takes 8 bytes.
pub fn jagged(primitives: &Primitives, opaque: &Opaque, depth_test: bool, bins: &Bins) -> Jagged {
    let mut jagged = Jagged::default();
    for tile in 0..bins.tiles() {
        let mut lists = vec![Vec::new(); LISTS as usize];
        for &prim in bins.bin(tile) {
            draw(primitives, prim, bins, tile, |list, f| {
                let mask = match depth_test {
                    true => visible(primitives, opaque, &f),
                    false => f.mask,
                };
                if mask != 0 {
                    lists[list].push([f.key, packed(primitives.samples, prim, mask)]);
                }
            });
        }
        place(&mut jagged, &lists);
    }
    jagged
}

/// The pixels of a tile of which a triangle covers a sample: number of the list, and fragment.
fn draw(
    primitives: &Primitives,
    prim: u32,
    bins: &Bins,
    tile: usize,
    mut emit: impl FnMut(usize, Fragment),
) {
    let (size, bits, samples) = (primitives.size, primitives.bits, primitives.samples);
    let setup = Setup::new(primitives, prim).expect("bins hold triangles with an area");
    let [left, top] = bins.origin(tile);
    for y in top..(top + SIDE).min(bins.rows.end) {
        for x in left..(left + SIDE).min(size.width) {
            let edges = |s: u32| setup.edges(samples.point(s, [x, y], bits));
            let covered = samples_of(samples.all()).filter(|s| setup.covers(edges(*s)));
            let mask: u32 = covered.map(|s| 1 << s).sum();
            if mask != 0 {
                let list = (y - top) * SIDE + (x - left);
                let fragment = Fragment {
                    pixel: y * size.width + x,
                    prim,
                    key: setup.key(edges(mask.trailing_zeros())),
                    mask,
                };
                emit(list as usize, fragment);
            }
        }
    }
}

/// Puts the lists of one more tile behind those that are there.
fn place(jagged: &mut Jagged, lists: &[Vec<[u32; 2]>]) {
    let first = word(jagged.entries.len());
    let longest = word(lists.iter().map(Vec::len).max().unwrap_or(0));
    let length = |list: &Vec<[u32; 2]>| word(list.len());
    if longest > ROWS {
        for list in lists {
            let start = word(jagged.entries.len());
            jagged.lists.push(List {
                start,
                length: length(list),
            });
            jagged.entries.extend(list);
        }
        jagged.rows.push(None);
        return;
    }
    let mut order: Vec<usize> = (0..lists.len()).collect();
    order.sort_by_key(|list| std::cmp::Reverse(lists[*list].len()));
    let rank = |list: usize| {
        order
            .iter()
            .position(|other| *other == list)
            .expect("it is there")
    };
    let placed = |list: usize| List {
        start: first + word(rank(list)),
        length: length(&lists[list]),
    };
    jagged.lists.extend((0..lists.len()).map(placed));
    let before = |row: usize| lists.iter().map(|list| word(list.len().min(row))).sum();
    let all = 0..longest as usize;
    jagged.rows.push(Some(all.clone().map(before).collect()));
    for row in all {
        let entries = order.iter().filter_map(|list| lists[*list].get(row));
        jagged.entries.extend(entries);
    }
}

/// Stage `shade`: every list put in order of `(key, prim)` and blended over what lies behind it, as by
/// [`resolve`], whose bounds hold. `bins` are those of the whole target.
pub fn shade(
    scene: &Scene,
    primitives: &Primitives,
    opaque: &Opaque,
    (bins, jagged): (&Bins, &Jagged),
) -> Vec<[Bounded; 3]> {
    resolve(scene, primitives, opaque, &sorted(primitives, bins, jagged))
}

fn word(n: usize) -> u32 {
    u32::try_from(n).expect("fewer than 2^32")
}
