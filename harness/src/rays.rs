//! Rays at blockers, of kinds that traversals and intersections go wrong on.

use triptych_spec::grid::axis::Axis;
use triptych_spec::grid::lattice::{Point, REACH};
use triptych_spec::grid::ray::Ray;
use triptych_spec::grid::{Blockers, Grid};

use crate::generate::Random;
use crate::scene::grid::Rays;

/// A kind of rays. The order is part of a snapshot's meaning.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// Between random points.
    Random,
    /// At points on triangles.
    Aimed,
    /// At points on edges.
    Edge,
    /// At corners.
    Vertex,
    /// Nearly in the planes of triangles.
    Grazing,
    /// Along axes, faces, edges and diagonals of cells.
    Cell,
}

impl Kind {
    /// All kinds, in order.
    pub const ALL: [Self; 6] = [
        Self::Random,
        Self::Aimed,
        Self::Edge,
        Self::Vertex,
        Self::Grazing,
        Self::Cell,
    ];

    /// Its name in a scene file.
    pub fn name(self) -> &'static str {
        match self {
            Self::Random => "random",
            Self::Aimed => "aimed",
            Self::Edge => "edge",
            Self::Vertex => "vertex",
            Self::Grazing => "grazing",
            Self::Cell => "cell",
        }
    }

    /// How many of the kind a scene asks for.
    pub fn count(self, rays: &Rays) -> u32 {
        let count = match self {
            Self::Random => rays.random,
            Self::Aimed => rays.aimed,
            Self::Edge => rays.edge,
            Self::Vertex => rays.vertex,
            Self::Grazing => rays.grazing,
            Self::Cell => rays.cell,
        };
        count.0
    }
}

/// Draws rays.
pub struct Source<'a> {
    blockers: &'a Blockers,
    grid: &'a Grid,
    random: Random,
}

impl<'a> Source<'a> {
    /// Rays at these blockers, the same for the same seed.
    pub fn new(blockers: &'a Blockers, grid: &'a Grid, seed: u64) -> Self {
        Self {
            blockers,
            grid,
            random: Random::new(seed),
        }
    }

    /// The next ray of a kind. Without blockers there are only random ones and such along
    /// cells.
    pub fn next(&mut self, kind: Kind) -> Ray {
        if self.blockers.triangles.is_empty() && kind != Kind::Cell {
            return self.between();
        }
        match kind {
            Kind::Random => self.between(),
            Kind::Aimed => {
                let [a, b, c] = self.triangle();
                let (u, v) = (self.random.unit(), self.random.unit());
                let (u, v) = if u + v > 1.0 {
                    (1.0 - u, 1.0 - v)
                } else {
                    (u, v)
                };
                let on = [0, 1, 2].map(|i| {
                    let along = f64::from(b[i] - a[i]) * u + f64::from(c[i] - a[i]) * v;
                    a[i] + round(along)
                });
                self.towards(on)
            }
            Kind::Edge => {
                let [a, b, _] = self.triangle();
                let s = self.random.unit();
                let on = [0, 1, 2].map(|i| a[i] + round(f64::from(b[i] - a[i]) * s));
                self.towards(on)
            }
            Kind::Vertex => {
                let [a, _, _] = self.triangle();
                self.towards(a)
            }
            Kind::Grazing => self.grazing(),
            Kind::Cell => self.along_cells(),
        }
    }

    fn between(&mut self) -> Ray {
        Ray::between(self.point(), self.point())
    }

    /// Half of them end at the target, others go on.
    fn towards(&mut self, target: Point) -> Ray {
        let segment = self.random.below(2) == 0;
        Ray {
            segment,
            ..Ray::between(self.point(), target)
        }
    }

    /// A direction in the plane of a triangle, off by a few steps, from a point off by a few.
    fn grazing(&mut self) -> Ray {
        let [a, b, c] = self.triangle();
        let (s, t) = (self.random.signed(), self.random.signed());
        let reach = 2.0 + 6.0 * self.random.unit();
        let direction = [0, 1, 2].map(|i| {
            let in_plane = f64::from(b[i] - a[i]) * s + f64::from(c[i] - a[i]) * t;
            round(in_plane * reach)
        });
        let near = |random: &mut Random, p: Point| {
            let off = [0; 3].map(|_: i32| round(random.signed() * 3.0));
            [0, 1, 2].map(|i| (p[i] + off[i]).clamp(-REACH, REACH))
        };
        let from = near(
            &mut self.random,
            [0, 1, 2].map(|i| i32::midpoint(a[i], b[i]) - direction[i] / 2),
        );
        let to = [0, 1, 2].map(|i| (from[i] + direction[i]).clamp(-REACH, REACH));
        let to = near(&mut self.random, to);
        Ray::between(from, to)
    }

    /// Between corners of cells, or along an axis from a point whose other coordinates are
    /// those of boundaries, a step off, or any.
    fn along_cells(&mut self) -> Ray {
        let from = [0, 1, 2].map(|axis| self.boundary(axis));
        let corner = self.random.below(2) == 0;
        if corner {
            let to = [0, 1, 2].map(|axis| self.boundary(axis));
            return Ray::between(from, to);
        }
        let axis = self.random.below(3);
        let off = [0, 1, 2].map(|_| self.random.below(3));
        let mut from = [0, 1, 2].map(|i| from[i] + [-1, 0, 1][off[i]]);
        let mut direction = [0; 3];
        direction[axis] = if self.random.below(2) == 0 { 1 } else { -1 };
        from[axis] = self.point()[axis];
        Ray {
            origin: from,
            direction,
            segment: false,
        }
    }

    fn boundary(&mut self, axis: usize) -> i32 {
        let boundaries = self.grid.axes[axis].boundaries();
        boundaries[self.random.below(boundaries.len())]
    }

    /// Corners in a random order, from the first that is drawn.
    fn triangle(&mut self) -> [Point; 3] {
        let row = self.random.below(self.blockers.triangles.len());
        let row = u32::try_from(row).expect("fewer than 2^32 triangles");
        let [a, b, c] = self.blockers.corners(row);
        match self.random.below(3) {
            0 => [a, b, c],
            1 => [b, c, a],
            _ => [c, a, b],
        }
    }

    /// In the grid's box or around it, by an eighth of its size.
    fn point(&mut self) -> Point {
        let axes: [&Axis; 3] = self.grid.axes.each_ref();
        axes.map(|axis| {
            let boundaries = axis.boundaries();
            let (low, high) = (boundaries[0], boundaries[boundaries.len() - 1]);
            let (middle, side) = (
                f64::midpoint(f64::from(low), f64::from(high)),
                f64::from(high) - f64::from(low),
            );
            let at = middle + 0.625 * side * self.random.signed();
            round(at).clamp(-REACH, REACH)
        })
    }
}

/// The rays of a scene, kind after kind, with where each kind ends.
pub fn draw(blockers: &Blockers, grid: &Grid, seed: u64, counts: &Rays) -> (Vec<Ray>, [usize; 6]) {
    let mut source = Source::new(blockers, grid, seed);
    let mut rays = Vec::new();
    let ends = Kind::ALL.map(|kind| {
        rays.extend((0..kind.count(counts)).map(|_| source.next(kind)));
        rays.len()
    });
    (rays, ends)
}

/// Rays from one point in front of the grid through a raster of points in its middle, row by
/// row: neighbours go alike.
pub fn view(grid: &Grid, count: u32) -> Vec<Ray> {
    let side = count.isqrt().max(1);
    let [low, high] = [0, 1].map(|end| {
        grid.axes.each_ref().map(|axis| {
            let boundaries = axis.boundaries();
            f64::from(boundaries[end * (boundaries.len() - 1)])
        })
    });
    let at = |axis: usize, share: f64| low[axis] + (high[axis] - low[axis]) * share;
    let eye = [
        round(at(0, 0.5)),
        round(at(1, 0.5)),
        round(at(2, 1.1)).min(REACH),
    ];
    let through = |i: u32| {
        let share = |n: u32| (f64::from(n) + 0.5) / f64::from(side);
        let (column, row) = (i % side, i / side % side);
        let point = [at(0, share(column)), at(1, share(row)), at(2, 0.5)].map(round);
        Ray {
            segment: false,
            ..Ray::between(eye, point)
        }
    };
    (0..count).map(through).collect()
}

fn round(x: f64) -> i32 {
    #[expect(clippy::cast_possible_truncation, reason = "saturates")]
    let integer = x.round() as i32;
    integer
}

#[cfg(test)]
mod tests;
