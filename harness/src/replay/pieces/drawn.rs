//! The stages of a frame, band by band.
//!
//! Lists are what they were, but for the addresses of their nodes, which count on from band to band.

use std::mem;
use std::time::Duration;

use triptych_spec::abuffer::{self, EOL, Lists, Node, Opaque, Sorted};
use triptych_spec::bound::Bounded;
use triptych_spec::raster::{self, Fragment};
use triptych_spec::scene::Scene;
use triptych_spec::vertex::Primitives;

use super::bands::{self, Band};
use crate::dispatch::share;
use crate::replay::spec::timed;

/// What stages are run.
#[derive(Clone, Copy, Debug)]
pub(in crate::replay) struct Asked {
    pub(in crate::replay) cover: bool,
    pub(in crate::replay) opaque: bool,
    pub(in crate::replay) depth_test: bool,
}

/// What comes of a band, or of all of them put together.
#[derive(Default)]
pub(in crate::replay) struct Drawn {
    pub(in crate::replay) cover: Vec<Fragment>,
    pub(in crate::replay) opaque: Opaque,
    pub(in crate::replay) lists: Lists,
    pub(in crate::replay) sorted: Sorted,
    pub(in crate::replay) image: Vec<[Bounded; 3]>,
    pub(in crate::replay) times: Times,
}

/// Time of each stage on one core.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::replay) struct Times {
    pub(in crate::replay) cover: Duration,
    pub(in crate::replay) opaque: Duration,
    pub(in crate::replay) build: Duration,
    pub(in crate::replay) sort: Duration,
    pub(in crate::replay) resolve: Duration,
}

/// All stages of a frame of so many fragments.
pub(in crate::replay) fn draw(
    scene: &Scene,
    primitives: &Primitives,
    asked: Asked,
    fragments: u64,
) -> Drawn {
    let of = |band: &Band| Drawn::new(scene, &band.primitives, asked).placed(band);
    let Some(mut drawn) = bands::each(primitives, fragments, of) else {
        return Drawn::new(scene, primitives, asked);
    };
    let lists: Vec<Lists> = drawn.iter_mut().map(|d| mem::take(&mut d.lists)).collect();
    // Copying takes as long as some of the stages.
    let (lists, mut all) = share::join(|| linked(lists), || Drawn::together(drawn));
    all.lists = lists;
    all
}

/// The lists of bands, with nodes one after another.
fn linked(bands: Vec<Lists>) -> Lists {
    let nodes = bands.iter().map(|band| band.nodes.len()).sum();
    let mut all = Lists {
        heads: Vec::with_capacity(bands.iter().map(|band| band.heads.len()).sum()),
        nodes: Vec::with_capacity(nodes),
        colours: Vec::with_capacity(nodes),
        attempts: 0,
        capacity: u32::MAX,
    };
    for band in bands {
        let first = all.attempts;
        let address = |at| if at == EOL { EOL } else { at + first };
        all.heads.extend(band.heads.into_iter().map(address));
        all.nodes.extend(band.nodes.into_iter().map(|node| Node {
            next: address(node.next),
            ..node
        }));
        all.colours.extend(band.colours);
        all.attempts += band.attempts;
    }
    all
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

    /// A band's pixels and triangles as the frame counts them.
    fn placed(mut self, band: &Band) -> Self {
        let place = |f: &mut Fragment| *f = band.shown(*f);
        self.cover.iter_mut().for_each(place);
        self.sorted.fragments.iter_mut().for_each(place);
        self.opaque = band.shown_surfaces(self.opaque);
        let nodes = self.lists.nodes.iter_mut();
        nodes.for_each(|node| node.prim = band.prim(node.prim));
        self
    }

    /// What comes of all bands, but for their lists.
    fn together(bands: Vec<Self>) -> Self {
        let fragments = bands.iter().map(|band| band.sorted.fragments.len()).sum();
        let mut all = Self {
            sorted: Sorted {
                offsets: vec![0],
                fragments: Vec::with_capacity(fragments),
            },
            ..Self::default()
        };
        bands.into_iter().for_each(|next| all.append(next));
        // As the whole is covered: triangle by triangle, row by row. Each band is in order, which only the
        // stable sort makes use of.
        all.cover.sort_by_key(|f| (f.prim, f.pixel));
        all
    }

    /// Adds the next band.
    fn append(&mut self, next: Self) {
        let start = self.sorted.offsets[self.sorted.offsets.len() - 1];
        let offsets = next.sorted.offsets.into_iter().skip(1);
        self.sorted.offsets.extend(offsets.map(|end| start + end));
        self.sorted.fragments.extend(next.sorted.fragments);
        self.cover.extend(next.cover);
        self.opaque.key.extend(next.opaque.key);
        self.opaque.prim.extend(next.opaque.prim);
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
