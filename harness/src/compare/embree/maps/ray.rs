//! The ray of a pixel, and where it really goes.
//!
//! A map's three rows are integers, so where a point of the lattice is before it is rounded to
//! sub-pixels is known exactly; so is where an integer ray is, along all of its way. Nothing is
//! lost by which integers are taken for origin and direction: the way from the pixel's middle is
//! worked out, and counts as such.

use triptych_spec::grid::lattice::{Point, REACH};
use triptych_spec::grid::ray::Ray;
use triptych_spec::ldm::{Map, Maps};

use crate::vector::{cross, dot, length, normalize};

/// Where points are in a map, before they are rounded.
pub(super) struct Projection<'m> {
    maps: &'m Maps,
    map: &'m Map,
}

/// A pixel's middle, and the ray through it away from whom the map is seen by.
pub(super) struct Through {
    /// The pixel's middle, in sub-pixels.
    pub(super) middle: [f64; 2],
    /// `None` where the line passes the lattice by, and so all triangles.
    pub(super) way: Option<Way>,
    /// How far the ray is from the middle at most, while it is on the lattice.
    pub(super) stray: f64,
}

/// An integer ray, and where it goes in the map.
pub(super) struct Way {
    pub(super) ray: Ray,
    /// Key of the origin.
    pub(super) key: f64,
    /// By how much the key grows in a unit of time.
    pub(super) keys: f64,
}

impl<'m> Projection<'m> {
    pub(super) fn new(maps: &'m Maps, map: &'m Map) -> Self {
        Self { maps, map }
    }

    /// A vector in sub-pixels and keys. Exact up to the rounding of one integer of 56 bits to
    /// `f64`, which is below 2^-25 of a sub-pixel.
    fn along(&self, vector: Point) -> [f64; 3] {
        let shifts = [
            self.maps.shifts[0],
            self.maps.shifts[0],
            self.maps.shifts[1],
        ];
        [0, 1, 2].map(|axis| {
            let row = self.map.rows[axis];
            let dot: i64 = (0..3)
                .map(|i| i64::from(row[i]) * i64::from(vector[i]))
                .sum();
            libm::scalbn(dot as f64, -shifts[axis].cast_signed())
        })
    }

    /// Column, row and key of a point, in sub-pixels and keys from the map's corner.
    pub(super) fn place(&self, point: Point) -> [f64; 3] {
        let along = self.along(point);
        [0, 1, 2].map(|axis| along[axis] - f64::from(self.map.origin[axis]))
    }

    /// The ray through a pixel's middle.
    pub(super) fn through(&self, pixel: [u32; 2]) -> Through {
        let half = f64::from(1_u32 << (self.maps.bits - 1));
        let middle = pixel.map(|c| f64::from(c << self.maps.bits) + half);
        let rows = self.map.rows.map(|row| row.map(f64::from));
        // At right angles to columns and rows, as they are rounded.
        let mut way = cross(rows[0], rows[1]);
        if dot(way, rows[2]) < 0.0 {
            way = way.map(|c| -c);
        }
        let way = normalize(way);
        // The point of the plane through the lattice's middle that is seen there.
        let aims = [0, 1].map(|axis| {
            let from = middle[axis] + f64::from(self.map.origin[axis]);
            libm::scalbn(from, self.maps.shifts[0].cast_signed())
        });
        let at = solve([rows[0], rows[1], way], [aims[0], aims[1], 0.0]);
        let Some([enters, leaves]) = inside(at, way) else {
            return Through {
                middle,
                way: None,
                stray: 0.0,
            };
        };
        let origin = [0, 1, 2].map(|axis| {
            let reach = f64::from(REACH);
            let near = libm::rint(at[axis] + way[axis] * enters).clamp(-reach, reach);
            #[expect(clippy::cast_possible_truncation, reason = "within REACH")]
            let near = near as i32;
            near
        });
        let ray = Ray::along(origin, way);
        let (from, along) = (self.place(origin), self.along(ray.direction));
        // The ray is as long as the line's part on the lattice, but for a step or two.
        let end = (leaves - enters + 4.0) / length(ray.direction.map(f64::from));
        let off = |t: f64, axis: usize| (from[axis] + t * along[axis] - middle[axis]).abs();
        let ends = [0.0, end].into_iter();
        let stray = ends.flat_map(|t| [off(t, 0), off(t, 1)]);
        Through {
            middle,
            stray: stray.fold(0.0, f64::max),
            way: Some(Way {
                ray,
                key: from[2],
                keys: along[2],
            }),
        }
    }
}

/// Between which lengths along a unit vector a line is on the lattice.
fn inside(at: [f64; 3], way: [f64; 3]) -> Option<[f64; 2]> {
    let reach = f64::from(REACH);
    let mut span = [f64::NEG_INFINITY, f64::INFINITY];
    for axis in 0..3 {
        if way[axis] == 0.0 {
            if at[axis].abs() > reach {
                return None;
            }
            continue;
        }
        let ends = [-reach, reach].map(|end| (end - at[axis]) / way[axis]);
        span = [
            span[0].max(ends[0].min(ends[1])),
            span[1].min(ends[0].max(ends[1])),
        ];
    }
    (span[0] <= span[1]).then_some(span)
}

/// The vector whose products with three rows are these numbers (Cramer's rule).
fn solve([a, b, c]: [[f64; 3]; 3], aims: [f64; 3]) -> [f64; 3] {
    let (bc, ca, ab) = (cross(b, c), cross(c, a), cross(a, b));
    let volume = dot(a, bc);
    [0, 1, 2].map(|i| (aims[0] * bc[i] + aims[1] * ca[i] + aims[2] * ab[i]) / volume)
}
