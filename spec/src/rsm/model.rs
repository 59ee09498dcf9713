//! What is seen: opaque triangles whose corners are points of the lattice.

use super::RsmError;
use crate::grid::exact::minus;
use crate::grid::lattice::{EXTENT, Point};

/// Bits of a component of [`Face::coarse`]. Dot products of two then fit into 30 bits and a
/// sign, and with differences of lattice points into 40.
pub const COARSE_BITS: u32 = 14;

/// The plane of a triangle, worked out once, as colours are: every leg starts from it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Face {
    /// The cross product of two edges, exactly; components are at most 2^49. Zero for a
    /// triangle without area, which neither faces nor lights anything.
    pub normal: [i64; 3],
    /// The same at length 1, rounded to `f32` once.
    pub unit: [f32; 3],
    /// The same at length 2^[`COARSE_BITS`], rounded to integers.
    pub coarse: Point,
}

impl Face {
    /// Of three corners.
    pub fn new([a, b, c]: [Point; 3]) -> Self {
        let [u, v] = [minus(b, a), minus(c, a)].map(|d| d.map(i64::from));
        let cross = |j: usize, k: usize| u[j] * v[k] - u[k] * v[j];
        let normal = [cross(1, 2), cross(2, 0), cross(0, 1)];
        // Exact: 49 bits.
        let wide = normal.map(|c| c as f64);
        let length = wide.iter().map(|c| c * c).sum::<f64>().sqrt();
        let unit = match length > 0.0 {
            true => wide.map(|c| c / length),
            false => [0.0; 3],
        };
        let steps = f64::from(1_u32 << COARSE_BITS);
        #[expect(
            clippy::cast_possible_truncation,
            reason = "rounding to f32 is meant; integers of 15 bits"
        )]
        Self {
            normal,
            unit: unit.map(|c| c as f32),
            coarse: unit.map(|c| libm::floor(c * steps + 0.5) as i32),
        }
    }

    /// `normal . d`, exactly; below 2^76 for a difference of lattice points.
    pub fn along(&self, d: Point) -> i128 {
        let product = |i: usize| i128::from(self.normal[i]) * i128::from(d[i]);
        product(0) + product(1) + product(2)
    }

    /// The axis along which the normal is longest; the first of equals.
    pub fn axis(&self) -> usize {
        let size = |i: usize| self.normal[i].abs();
        (1..3).fold(0, |best, i| if size(i) > size(best) { i } else { best })
    }
}

/// Triangles that are seen by eye and light, all opaque.
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    /// Corners, at most [`EXTENT`] in each coordinate.
    pub vertices: Vec<Point>,
    /// Rows of `vertices`.
    pub triangles: Vec<[u32; 3]>,
    /// Linear colour of each triangle: the part of the light that it gives back, in all
    /// directions alike.
    pub colours: Vec<[f32; 3]>,
    /// The plane of each triangle.
    pub faces: Vec<Face>,
}

impl Model {
    /// Checks a mesh, and works out its planes.
    ///
    /// # Errors
    /// A corner beyond the lattice's extent, a row that is none, a colour that is missing,
    /// negative or not finite.
    pub fn new(
        vertices: Vec<Point>,
        triangles: Vec<[u32; 3]>,
        colours: Vec<[f32; 3]>,
    ) -> Result<Self, RsmError> {
        let outside = |p: &&Point| p.iter().any(|c| !(-EXTENT..=EXTENT).contains(c));
        if let Some(corner) = vertices.iter().find(outside) {
            return Err(RsmError::Outside(*corner));
        }
        let missing = |row: &&u32| **row as usize >= vertices.len();
        if let Some(row) = triangles.iter().flatten().find(missing) {
            return Err(RsmError::Row(*row));
        }
        if colours.len() != triangles.len() {
            return Err(RsmError::Colours(colours.len(), triangles.len()));
        }
        colours.iter().try_for_each(|c| sound(*c))?;
        let corners = |rows: &[u32; 3]| rows.map(|row| vertices[row as usize]);
        let faces = triangles.iter().map(|rows| Face::new(corners(rows)));
        Ok(Self {
            faces: faces.collect(),
            vertices,
            triangles,
            colours,
        })
    }

    /// The corners of a triangle.
    pub fn corners(&self, triangle: u32) -> [Point; 3] {
        self.triangles[triangle as usize].map(|row| self.vertices[row as usize])
    }

    /// The plane of a triangle.
    pub fn face(&self, triangle: u32) -> &Face {
        &self.faces[triangle as usize]
    }
}

/// An error unless light of that colour may exist.
pub(crate) fn sound(colour: [f32; 3]) -> Result<(), RsmError> {
    let wrong = |c: &f32| !(c.is_finite() && *c >= 0.0);
    colour
        .into_iter()
        .find(wrong)
        .map_or(Ok(()), |c| Err(RsmError::Light(c)))
}
