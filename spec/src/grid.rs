//! Grid: lists of triangles in a 3D grid, rebuilt each frame, and rays through it.
//!
//! Yang, Hensley, Grün and Thibieroz, "Real-Time Concurrent Linked List Construction on
//! the GPU" (2010), section 4.2: each triangle goes into every cell that its bounding box
//! touches; a ray looks through the cells that it passes. Instead of linked lists, whose
//! order no two runs share, the cells' lists are runs of one array (Kalojanov and
//! Slusallek 2009): [`count`], [`scan`], [`fill`], ids rising in each cell. [`link`] builds
//! the paper's lists, which hold the same.
//!
//! Everything here is exact. Blockers and rays are snapped to a [`lattice`] once; boxes,
//! boundaries and sides are integers; the order of events along a ray is that of
//! fractions. What a kernel's `f32` stepping may get wrong is made up for by widened cells
//! ([`axis::WIDENED`]), so that no ray misses what it meets. Twin: `gpu/src/grid.wgsl`.

pub mod axis;
mod cells;
pub mod exact;
pub mod hit;
pub mod lattice;
pub mod link;
pub mod overlap;
pub mod ray;
pub mod resolution;
pub mod trace;
pub mod walk;

use axis::Axis;
pub use cells::{Cells, Membership, Slab, count, count_slab, fill, fill_slab, scan};
use lattice::{EXTENT, Point};
use resolution::Resolution;
use thiserror::Error;

/// Most entries in all cells' lists together: 64 Mi, 256 MiB of ids.
pub const ENTRIES_MAX: u64 = 1 << 26;

/// Triangles that block rays, on the lattice.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Blockers {
    /// Corners, at most [`EXTENT`] in each coordinate.
    pub vertices: Vec<Point>,
    /// Rows of `vertices`; a triangle's own row is its name.
    pub triangles: Vec<[u32; 3]>,
}

impl Blockers {
    /// The corners of a triangle.
    pub fn corners(&self, prim: u32) -> [Point; 3] {
        self.triangles[prim as usize].map(|vertex| self.vertices[vertex as usize])
    }

    /// The box around all triangles; `None` if there are none.
    fn bounds(&self) -> Option<[Point; 2]> {
        let corners = (0..self.triangles.len()).flat_map(|row| self.corners(id(row)));
        corners.map(|c| [c, c]).reduce(joined)
    }
}

/// Why there is no grid.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
pub enum GridError {
    /// More cells than an axis or a grid may have, or none.
    #[error("a grid of {0} cells; 1 to 1024 along an axis, at most 16777216 in all")]
    Cells(u64),
    /// More entries than lists may hold.
    #[error("{0} entries in cells; at most 67108864, which a coarser grid would keep")]
    Entries(u64),
    /// A corner beyond the lattice's extent.
    #[error("a corner at {0:?} is beyond the lattice, which ends at {EXTENT}")]
    Outside(Point),
}

/// Cells and their lists.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Grid {
    /// Boundaries on x, y and z.
    pub axes: [Axis; 3],
    /// Where each cell's run starts; one more than cells. x runs fastest, then y.
    pub offsets: Vec<u32>,
    /// Rows of [`Blockers::triangles`], rising in each cell.
    pub prims: Vec<u32>,
}

impl Grid {
    /// All stages.
    ///
    /// # Errors
    /// A limit that would be exceeded.
    pub fn build(
        blockers: &Blockers,
        resolution: Resolution,
        membership: Membership,
    ) -> Result<Self, GridError> {
        let axes = axes(blockers, resolution)?;
        let cells = Cells {
            axes: &axes,
            membership,
        };
        let offsets = scan(&count(blockers, &cells))?;
        let prims = fill(blockers, &cells, &offsets);
        Ok(Self {
            axes,
            offsets,
            prims,
        })
    }

    /// The triangles of a cell.
    pub fn list(&self, cell: Point3) -> &[u32] {
        let at = number(&self.axes, cell);
        &self.prims[self.offsets[at] as usize..self.offsets[at + 1] as usize]
    }
}

/// Numbers of a cell on x, y and z.
pub type Point3 = [u32; 3];

/// Boundaries for a scene; without blockers one cell around the middle.
///
/// # Errors
/// A resolution beyond the limits, a corner beyond the lattice, or boxes that touch more than
/// [`ENTRIES_MAX`] cells together: that is looked at before any cell is.
pub fn axes(blockers: &Blockers, resolution: Resolution) -> Result<[Axis; 3], GridError> {
    let outside = |p: &&Point| p.iter().any(|c| !(-EXTENT..=EXTENT).contains(c));
    if let Some(corner) = blockers.vertices.iter().find(outside) {
        return Err(GridError::Outside(*corner));
    }
    let [low, high] = blockers.bounds().unwrap_or_default();
    let axes = resolution::axes(resolution, blockers.triangles.len(), low, high);
    let axes = axes.map_err(GridError::Cells)?;
    let of = |row| touched(&axes, blockers.corners(id(row)));
    let total = (0..blockers.triangles.len()).map(of).sum();
    match total <= ENTRIES_MAX {
        true => Ok(axes),
        false => Err(GridError::Entries(total)),
    }
}

/// How many cells a triangle's box touches. Sums of fewer than 2^32 triangles fit.
fn touched(axes: &[Axis; 3], corners: [Point; 3]) -> u64 {
    let [low, high] = bounds(corners);
    let on = |axis: usize| {
        let [first, last] = axes[axis].touched(low[axis], high[axis]);
        u64::from(last - first + 1)
    };
    on(0) * on(1) * on(2)
}

/// Which cells hold anything: a bit for each cell of a brick of 4 x 4 x 4, two words a
/// brick; x runs fastest in the brick and among bricks. A ray crosses an empty brick in one
/// step.
pub fn bricks(axes: &[Axis; 3], offsets: &[u32]) -> Vec<[u32; 2]> {
    let [x, y, z] = axes.each_ref().map(Axis::cells);
    let [across, down, deep] = brick_counts(axes);
    let mut bricks = vec![[0; 2]; across as usize * down as usize * deep as usize];
    let rows = (0..z).flat_map(|k| (0..y).map(move |j| [j, k]));
    for [i, j, k] in rows.flat_map(|[j, k]| (0..x).map(move |i| [i, j, k])) {
        let at = number(axes, [i, j, k]);
        if offsets[at] < offsets[at + 1] {
            let brick = (i / 4 + across * (j / 4 + down * (k / 4))) as usize;
            let bit = i % 4 + 4 * (j % 4) + 16 * (k % 4);
            bricks[brick][(bit / 32) as usize] |= 1 << (bit % 32);
        }
    }
    bricks
}

/// Bricks along each axis.
pub fn brick_counts(axes: &[Axis; 3]) -> [u32; 3] {
    axes.each_ref().map(|axis| axis.cells().div_ceil(4))
}

/// The number of a cell.
fn number(axes: &[Axis; 3], [i, j, k]: Point3) -> usize {
    let [x, y, _] = axes.each_ref().map(|axis| axis.cells() as usize);
    i as usize + x * (j as usize + y * k as usize)
}

/// The box around a triangle.
fn bounds(corners: [Point; 3]) -> [Point; 2] {
    let [a, b, c] = corners.map(|c| [c, c]);
    joined(joined(a, b), c)
}

fn joined([low, high]: [Point; 2], [other_low, other_high]: [Point; 2]) -> [Point; 2] {
    [
        [0, 1, 2].map(|i| low[i].min(other_low[i])),
        [0, 1, 2].map(|i| high[i].max(other_high[i])),
    ]
}

/// A row as a triangle's id.
fn id(row: usize) -> u32 {
    u32::try_from(row).expect("fewer than 2^32 triangles")
}
