//! The triangles of a file in a map, before anything is rounded: what a list must, may and must
//! not hold at a pixel's middle, by bounds.
//!
//! A pixel's middle is where the map's first two rows put it; its depth is along the map's
//! direction, in keys from the map's least. With `q` a corner in steps, unrounded, and `p` on the
//! lattice, `|q - p| <= 1/2` along each axis. So, with `r` a row over 2^shift,
//!
//! - column and row of a corner are off by at most `e = |r|_1 / 2 + 1/2` sub-pixels: the corner's
//!   own rounding, and that of its place;
//! - its key by at most `d = 8 |v|_1 / 2 + 1/2 + |q|_1 / 2^28`, of the map's direction v: the last
//!   is the rounding of the row of depth, by half of 2^-27 in each component.
//!
//! **Which triangles.** An edge function at a point is the cross product of the edge's ends as seen
//! from there, `a` and `b`. Either moved by up to `e` changes it by at most
//! `e_x (|a_y| + |b_y|) + e_y (|a_x| + |b_x|) + 2 e_x e_y`. Where all three are surely of one sign
//! the list has a key of the triangle; where two are surely of different ones it has none.
//!
//! **Which key.** Let the rounded triangle hold the middle `m`, with weights `w`. The same weights
//! put the unrounded triangle's point within `e` of `m`, and its depth there within `d` of the
//! rounded one's, as weights are a mean. From that point to `m` the unrounded plane, with slope `g`,
//! changes by at most `|g_x| e_x + |g_y| e_y`. The key is rounded down: half a key, either way, once
//! half a key is added. So a key is within `d + 1/2 + |g| . e` of depth less half, however thin the
//! triangle is; where it is edge-on, nothing is known of it.

use triptych_spec::grid::lattice::Point;
use triptych_spec::ldm::{KEYS_PER_STEP, Map, Maps};

use super::super::shot::Vertex;
use crate::vector::dot;

/// What `f64` may add to any of these bounds, in sub-pixels or keys: numbers are below 2^28.
const ROUNDED: f64 = 1.0 / (1 << 20) as f64;

/// What `f64` may make of a slope, on the way from a corner to a pixel of at most 2^17 sub-pixels
/// ([`slope`]), in sub-pixels.
const OF_SLOPE: f64 = 1.0 / (1 << 9) as f64;

/// Whether a list has a key of a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Holds {
    /// It does.
    Must,
    /// Rounding decides.
    May,
}

/// A triangle at a pixel's middle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct There {
    /// Row in the scene.
    pub(super) row: usize,
    /// Whether the list has a key of it.
    pub(super) holds: Holds,
    /// Its depth less half a key.
    pub(super) depth: f64,
    /// How far its key may be from that.
    pub(super) bound: f64,
    /// Its slope, in keys a sub-pixel.
    slope: [f64; 2],
}

/// A map, and the triangles in it.
pub(super) struct Projected<'m> {
    maps: &'m Maps,
    map: &'m Map,
    /// Sub-pixels by which a corner's column and row are off.
    pub(super) off: [f64; 2],
    faces: Vec<Face>,
}

struct Face {
    row: usize,
    corners: [Vertex; 3],
    /// `None` if it is edge-on.
    slope: Option<[f64; 2]>,
    bound: f64,
}

impl<'m> Projected<'m> {
    /// The triangles that block, with their rows in the scene.
    pub(super) fn new(maps: &'m Maps, map: &'m Map, blockers: &[(usize, [Vertex; 3])]) -> Self {
        let size = |v: Vertex| v.iter().map(|c| c.abs()).sum::<f64>();
        let lateral = |axis: usize| map.rows[axis].map(|c| per_step(maps, c));
        let off = [0, 1].map(|axis| size(lateral(axis)) / 2.0 + 0.5 + ROUNDED);
        let mut all = Self {
            maps,
            map,
            off,
            faces: Vec::with_capacity(blockers.len()),
        };
        let keys = f64::from(KEYS_PER_STEP);
        for (row, corners) in blockers {
            let farthest = corners.iter().map(|c| size(*c)).fold(0.0, f64::max);
            let of_row = libm::scalbn(farthest, -28);
            let corners = corners.map(|corner| all.place(corner));
            let slope = slope(corners);
            let of_slope = slope.map_or(0.0, |g| {
                g[0].abs() * (off[0] + OF_SLOPE) + g[1].abs() * (off[1] + OF_SLOPE)
            });
            let of_corners = keys * size(map.direction) / 2.0 + 0.5 + of_row;
            all.faces.push(Face {
                row: *row,
                corners,
                slope,
                bound: of_corners + 0.5 + of_slope + ROUNDED,
            });
        }
        all
    }

    /// Column and row in sub-pixels, and depth in keys, of a point in steps.
    pub(super) fn place(&self, point: Vertex) -> Vertex {
        let origin = self.map.origin.map(f64::from);
        let lateral = |axis: usize| dot(self.map.rows[axis].map(|c| per_step(self.maps, c)), point);
        let depth = -dot(self.map.direction, point) * f64::from(KEYS_PER_STEP);
        [
            lateral(0) - origin[0],
            lateral(1) - origin[1],
            depth - origin[2],
        ]
    }

    /// The same of a point of the lattice.
    pub(super) fn place_of(&self, point: Point) -> Vertex {
        self.place(point.map(f64::from))
    }

    /// The middle of the pixel that a place is in, in sub-pixels.
    pub(super) fn middle(&self, place: Point) -> [f64; 2] {
        let half = 1 << (self.maps.bits - 1);
        [0, 1].map(|i| f64::from((place[i] >> self.maps.bits << self.maps.bits) + half))
    }

    /// The triangles that a list has or may have a key of.
    pub(super) fn there<'a>(&'a self, middle: [f64; 2]) -> impl Iterator<Item = There> + 'a {
        self.faces.iter().filter_map(move |face| {
            let holds = self.holds(face, middle)?;
            Some(match face.slope {
                Some(slope) => There {
                    row: face.row,
                    holds,
                    depth: depth(face, slope, middle) - 0.5,
                    bound: face.bound,
                    slope,
                },
                None => There {
                    row: face.row,
                    holds: Holds::May,
                    depth: 0.0,
                    bound: f64::INFINITY,
                    slope: [0.0; 2],
                },
            })
        })
    }

    fn holds(&self, face: &Face, middle: [f64; 2]) -> Option<Holds> {
        let [ex, ey] = self.off;
        let [a, b, c] = face.corners.map(|p| [p[0] - middle[0], p[1] - middle[1]]);
        let (mut positive, mut negative, mut open) = (0, 0, 0);
        for [a, b] in [[a, b], [b, c], [c, a]] {
            let side = a[0] * b[1] - a[1] * b[0];
            let by =
                ex * (a[1].abs() + b[1].abs()) + ey * (a[0].abs() + b[0].abs()) + 2.0 * ex * ey;
            // Products of two coordinates below 2^24: rounded by less than this.
            let by = by + 1.0 / 16.0;
            match side {
                _ if side > by => positive += 1,
                _ if side < -by => negative += 1,
                _ => open += 1,
            }
        }
        match (positive, negative, open) {
            (1.., 1.., _) => None,
            (_, _, 0) => Some(Holds::Must),
            _ => Some(Holds::May),
        }
    }
}

impl There {
    /// Whether a key may be this triangle's, and how near it is to what it must not exceed.
    pub(super) fn ratio(&self, key: f64) -> f64 {
        (key - self.depth).abs() / self.bound
    }

    /// The least and the greatest key that it may have.
    pub(super) fn ends(&self) -> [f64; 2] {
        [self.depth - self.bound, self.depth + self.bound]
    }

    /// How much its depth changes on the way.
    pub(super) fn change(&self, way: [f64; 2]) -> f64 {
        self.slope[0] * way[0] + self.slope[1] * way[1]
    }

    /// The most that it changes as far as that either way.
    pub(super) fn steepest(&self, way: f64) -> f64 {
        (self.slope[0].abs() + self.slope[1].abs()) * way
    }
}

/// A component of one of the first two rows, in sub-pixels a step.
fn per_step(maps: &Maps, component: i32) -> f64 {
    libm::scalbn(f64::from(component), -maps.shifts[0].cast_signed())
}

/// The change of depth along columns and rows; `None` if the triangle is edge-on, or nearly so
/// that `f64` cannot tell.
fn slope([a, b, c]: [Vertex; 3]) -> Option<[f64; 2]> {
    let [u, v] = [b, c].map(|p| [p[0] - a[0], p[1] - a[1], p[2] - a[2]]);
    let (first, second) = (u[0] * v[1], u[1] * v[0]);
    let area = first - second;
    // Coordinates are below 2^17 and so rounded by less than 2^-33, and products by as much of
    // themselves as `f64` does.
    let sides = u[0].abs() + u[1].abs() + v[0].abs() + v[1].abs();
    let rounded = libm::scalbn(sides, -33) + (first.abs() + second.abs()) * f64::EPSILON;
    // A slope is then right to a 2^-26 of it.
    (area.abs() > f64::from(1 << 26) * rounded).then(|| {
        [
            (u[2] * v[1] - v[2] * u[1]) / area,
            (v[2] * u[0] - u[2] * v[0]) / area,
        ]
    })
}

/// Depth of a triangle's plane, from its nearest corner on.
fn depth(face: &Face, slope: [f64; 2], at: [f64; 2]) -> f64 {
    let far = |p: &Vertex| (p[0] - at[0]).abs() + (p[1] - at[1]).abs();
    let corners = face.corners.iter();
    let near = corners.min_by(|a, b| far(a).total_cmp(&far(b)));
    near.map_or(0.0, |p| {
        p[2] + slope[0] * (at[0] - p[0]) + slope[1] * (at[1] - p[1])
    })
}
