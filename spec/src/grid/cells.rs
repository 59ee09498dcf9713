//! Which cells list a triangle, and the stages that write their lists.
//!
//! A slab's cells are a run of all cells, as layers of one number on z follow each other, and so are
//! their lists: slabs that are worked out by themselves and put together are the whole.

use std::ops::Range;

use super::axis::Axis;
use super::lattice::Point;
use super::overlap;
use super::{Blockers, ENTRIES_MAX, GridError, bounds, id, number};

/// Which cells of those that its box touches list a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Membership {
    /// All of them, as in the paper.
    Box,
    /// Those that the triangle itself touches, when widened ([`overlap::touches`]).
    Overlap,
}

/// The cells of three axes.
#[derive(Clone, Copy, Debug)]
pub struct Cells<'a> {
    /// Boundaries on x, y and z.
    pub axes: &'a [Axis; 3],
    /// Which cells list a triangle.
    pub membership: Membership,
}

impl Cells<'_> {
    /// Number of cells; at most [`super::resolution::TOTAL_MAX`].
    pub fn total(&self) -> usize {
        self.axes.iter().map(|axis| axis.cells() as usize).product()
    }

    /// Cells of one layer, which has one number on z.
    fn layer(&self) -> usize {
        (self.axes[0].cells() * self.axes[1].cells()) as usize
    }

    /// Layers that a triangle's box touches.
    pub fn layers(&self, corners: [Point; 3]) -> Range<u32> {
        let [low, high] = bounds(corners);
        let [first, last] = self.axes[2].touched(low[2], high[2]);
        first..last + 1
    }

    /// Numbers of the cells that list a triangle, rising.
    pub fn of(&self, corners: [Point; 3]) -> impl Iterator<Item = usize> {
        self.of_layers(corners, 0..self.axes[2].cells())
    }

    /// Those of some layers alone.
    pub fn of_layers(
        &self,
        corners: [Point; 3],
        layers: Range<u32>,
    ) -> impl Iterator<Item = usize> {
        let [low, high] = bounds(corners);
        let [x, y] = [0, 1].map(|axis| {
            let [first, last] = self.axes[axis].touched(low[axis], high[axis]);
            first..=last
        });
        let own = self.layers(corners);
        let z = own.start.max(layers.start)..own.end.min(layers.end);
        let rows = z.flat_map(move |k| y.clone().map(move |j| [j, k]));
        let cells = rows.flat_map(move |[j, k]| x.clone().map(move |i| [i, j, k]));
        cells
            .filter(move |cell| match self.membership {
                Membership::Box => true,
                Membership::Overlap => overlap::touches(self.axes, *cell, corners),
            })
            .map(|cell| number(self.axes, cell))
    }
}

/// Some layers of cells, and the triangles whose boxes touch any of them, rising.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Slab {
    /// Numbers on z.
    pub layers: Range<u32>,
    /// Rows of [`Blockers::triangles`].
    pub prims: Vec<u32>,
}

impl Slab {
    /// All layers and triangles.
    pub fn whole(blockers: &Blockers, cells: &Cells) -> Self {
        Self {
            layers: 0..cells.axes[2].cells(),
            prims: (0..id(blockers.triangles.len())).collect(),
        }
    }

    /// Numbers of its cells: cells of a layer follow those of the layer before.
    fn cells(&self, cells: &Cells) -> Range<usize> {
        let layer = cells.layer();
        self.layers.start as usize * layer..self.layers.end as usize * layer
    }
}

/// Stage `count`: how many triangles each cell lists.
pub fn count(blockers: &Blockers, cells: &Cells) -> Vec<u32> {
    count_slab(blockers, cells, &Slab::whole(blockers, cells))
}

/// [`count`] of a slab's cells.
pub fn count_slab(blockers: &Blockers, cells: &Cells, slab: &Slab) -> Vec<u32> {
    let own = slab.cells(cells);
    let mut counts = vec![0; own.len()];
    for prim in &slab.prims {
        let touched = cells.of_layers(blockers.corners(*prim), slab.layers.clone());
        touched.for_each(|cell| counts[cell - own.start] += 1);
    }
    counts
}

/// Stage `scan`: where each cell's run starts, and the end of the last.
///
/// # Errors
/// More than [`ENTRIES_MAX`] entries.
pub fn scan(counts: &[u32]) -> Result<Vec<u32>, GridError> {
    let total = counts.iter().map(|count| u64::from(*count)).sum();
    if total > ENTRIES_MAX {
        return Err(GridError::Entries(total));
    }
    let mut end = 0;
    let ends = counts.iter().map(|count| {
        end += count;
        end
    });
    Ok([0].into_iter().chain(ends).collect())
}

/// Stage `fill`: the ids of each cell, rising.
pub fn fill(blockers: &Blockers, cells: &Cells, offsets: &[u32]) -> Vec<u32> {
    fill_slab(blockers, cells, offsets, &Slab::whole(blockers, cells))
}

/// [`fill`] of a slab's cells; `offsets` are those of all cells.
pub fn fill_slab(blockers: &Blockers, cells: &Cells, offsets: &[u32], slab: &Slab) -> Vec<u32> {
    let own = slab.cells(cells);
    let first = offsets[own.start];
    let mut next: Vec<u32> = offsets[own.clone()].iter().map(|at| at - first).collect();
    let mut prims = vec![0; (offsets[own.end] - first) as usize];
    for prim in &slab.prims {
        let touched = cells.of_layers(blockers.corners(*prim), slab.layers.clone());
        touched.for_each(|cell| {
            let next = &mut next[cell - own.start];
            prims[*next as usize] = *prim;
            *next += 1;
        });
    }
    prims
}
