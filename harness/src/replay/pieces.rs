//! The spec's stages of a frame, bands of rows by themselves: over the cores, and in order.
//!
//! Positions are integers of the sub-pixel grid, and a band's triangles move by whole pixels: coverage,
//! keys and colours are what they were, and so are lists, but for the addresses of their nodes, which count on
//! from band to band. Which bands there are depends on the picture alone.

use std::time::Duration;

use triptych_spec::abuffer::{self, EOL, Lists, Node, Opaque, Sorted};
use triptych_spec::bound::Bounded;
use triptych_spec::raster::{self, Fragment};
use triptych_spec::scene::{Scene, Size};
use triptych_spec::vertex::Primitives;

use super::spec::timed;
use crate::dispatch::share;

/// Fragments from which on a frame is taken apart.
const FRAGMENTS: u64 = 1 << 14;

/// Bands of a frame.
const BANDS: u32 = 8;

/// Rows of a target.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rows {
    /// The first.
    pub first: u32,
    /// How many.
    pub count: u32,
}

/// The rows of a frame's bands.
pub fn bands(size: Size, fragments: u64) -> Vec<Rows> {
    let count = match fragments >= FRAGMENTS {
        true => size.height.div_ceil(BANDS),
        false => size.height,
    };
    let firsts = (0..size.height).step_by(count.max(1) as usize);
    let band = |first| Rows {
        first,
        count: count.min(size.height - first),
    };
    firsts.map(band).collect()
}

/// The triangles as they lie in a target of these rows alone.
pub fn of_rows(primitives: &Primitives, rows: Rows) -> Primitives {
    let down = (rows.first << primitives.bits).cast_signed();
    let moved = |[x, y, key]: &[i32; 3]| [*x, y - down, *key];
    Primitives {
        size: Size {
            height: rows.count,
            ..primitives.size
        },
        bits: primitives.bits,
        samples: primitives.samples,
        snapped: primitives.snapped.iter().map(moved).collect(),
        prims: primitives.prims.clone(),
        source: primitives.source.clone(),
    }
}

/// A picture, band by band.
pub fn picture(
    primitives: &Primitives,
    opaque: &Opaque,
    of: impl Fn(&Primitives, &Opaque) -> Vec<[Bounded; 3]> + Sync,
) -> Vec<[Bounded; 3]> {
    let bands = bands(primitives.size, raster::count(primitives));
    if let [_] = bands[..] {
        return of(primitives, opaque);
    }
    let pictures = share::map(&bands, 1, |rows| {
        of(
            &of_rows(primitives, *rows),
            &surfaces(primitives, opaque, *rows),
        )
    });
    pictures.into_iter().flatten().collect()
}

/// The surfaces of some rows.
fn surfaces(primitives: &Primitives, opaque: &Opaque, rows: Rows) -> Opaque {
    let wide = (primitives.size.width * primitives.samples.count()) as usize;
    let range = rows.first as usize * wide..(rows.first + rows.count) as usize * wide;
    Opaque {
        key: opaque.key[range.clone()].to_vec(),
        prim: opaque.prim[range].to_vec(),
    }
}

/// What stages are run.
#[derive(Clone, Copy, Debug)]
pub(super) struct Asked {
    pub(super) cover: bool,
    pub(super) opaque: bool,
    pub(super) depth_test: bool,
}

/// What comes of a band, or of all of them put together.
#[derive(Default)]
pub(super) struct Drawn {
    pub(super) cover: Vec<Fragment>,
    pub(super) opaque: Opaque,
    pub(super) lists: Lists,
    pub(super) sorted: Sorted,
    pub(super) image: Vec<[Bounded; 3]>,
    pub(super) times: Times,
}

/// Time of each stage on one core.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Times {
    pub(super) cover: Duration,
    pub(super) opaque: Duration,
    pub(super) build: Duration,
    pub(super) sort: Duration,
    pub(super) resolve: Duration,
}

/// All stages of a frame of so many fragments.
pub(super) fn draw(scene: &Scene, primitives: &Primitives, asked: Asked, fragments: u64) -> Drawn {
    let bands = bands(primitives.size, fragments);
    if let [_] = bands[..] {
        return Drawn::new(scene, primitives, asked);
    }
    let drawn = share::map(&bands, 1, |rows| {
        Drawn::new(scene, &of_rows(primitives, *rows), asked)
    });
    let mut all = Drawn {
        lists: empty(),
        sorted: Sorted {
            offsets: vec![0],
            fragments: Vec::new(),
        },
        ..Drawn::default()
    };
    for (band, rows) in drawn.into_iter().zip(bands) {
        all.append(band, rows.first * primitives.size.width);
    }
    // As the whole is covered: triangle by triangle, row by row.
    all.cover.sort_unstable_by_key(|f| (f.prim, f.pixel));
    all
}

/// No lists, with room for all fragments.
fn empty() -> Lists {
    Lists {
        heads: Vec::new(),
        nodes: Vec::new(),
        colours: Vec::new(),
        attempts: 0,
        capacity: u32::MAX,
    }
}

impl Drawn {
    /// Runs the stages.
    fn new(scene: &Scene, primitives: &Primitives, asked: Asked) -> Self {
        let mut times = Times::default();
        let mut cover = Vec::new();
        if asked.cover {
            times.cover = timed(|| raster::cover(primitives, |f| cover.push(f))).1;
        }
        let mut opaque = Opaque::nothing(primitives);
        if asked.opaque {
            (opaque, times.opaque) = timed(|| abuffer::opaque(scene, primitives));
        }
        let build = || abuffer::build(scene, primitives, &opaque, asked.depth_test, u32::MAX);
        let (lists, build) = timed(build);
        let (sorted, sort) = timed(|| abuffer::sort(&lists));
        let resolve = || abuffer::resolve(scene, primitives, &opaque, &sorted);
        let (image, resolve) = timed(resolve);
        Self {
            cover,
            opaque,
            lists,
            sorted,
            image,
            times: Times {
                build,
                sort,
                resolve,
                ..times
            },
        }
    }

    /// Adds the next band, whose pixels count from this one on.
    fn append(&mut self, next: Self, pixel: u32) {
        let shown = |f: Fragment| Fragment {
            pixel: f.pixel + pixel,
            ..f
        };
        let node = self.lists.attempts;
        let address = |at: u32| if at == EOL { EOL } else { at + node };
        let start = self.sorted.offsets[self.sorted.offsets.len() - 1];
        let offsets = next.sorted.offsets.into_iter().skip(1);
        let fragments = next.sorted.fragments.into_iter();
        self.sorted.offsets.extend(offsets.map(|end| start + end));
        self.sorted.fragments.extend(fragments.map(shown));
        self.cover.extend(next.cover.into_iter().map(shown));
        self.opaque.key.extend(next.opaque.key);
        self.opaque.prim.extend(next.opaque.prim);
        self.lists
            .heads
            .extend(next.lists.heads.into_iter().map(address));
        self.lists
            .nodes
            .extend(next.lists.nodes.into_iter().map(|n| Node {
                next: address(n.next),
                ..n
            }));
        self.lists.colours.extend(next.lists.colours);
        self.lists.attempts += next.lists.attempts;
        self.image.extend(next.image);
        let Times {
            cover,
            opaque,
            build,
            sort,
            resolve,
        } = next.times;
        self.times.cover += cover;
        self.times.opaque += opaque;
        self.times.build += build;
        self.times.sort += sort;
        self.times.resolve += resolve;
    }
}

#[cfg(test)]
mod tests;
