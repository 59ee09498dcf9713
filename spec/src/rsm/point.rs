//! Stage `gbuffer`: which point of which triangle each pixel sees.

use super::{Model, Parameters, View};
use crate::abuffer::{NOTHING, opaque};
use crate::bound::{Bounded, Real};
use crate::grid::exact::minus;
use crate::grid::lattice::Point;
use crate::matrix::Matrix;
use crate::scene::Size;
use crate::vertex::{Primitives, SUBPIXEL_BITS, primitives, viewport};

/// What a pixel sees: integers that all later stages start from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Surface {
    /// Row in [`Model::triangles`].
    pub triangle: u32,
    /// 1 where the triangle's normal points to the viewer, else -1.
    pub side: i32,
    /// The point that is seen, snapped and moved off the face to the side that is seen.
    pub point: Point,
}

/// The surfaces of a view, pixel by pixel.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Gbuffer {
    /// Of the picture.
    pub size: Size,
    /// Depth keys, or [`NOTHING`].
    pub keys: Vec<u32>,
    /// What is seen, if anything.
    pub surfaces: Vec<Option<Surface>>,
    /// How far, in steps along each axis, the point of an `f32` evaluation may be from the
    /// pixel's; no farther than the triangle is long.
    pub stray: Vec<[u32; 3]>,
}

/// Stage `gbuffer`: triangle, side and point of each pixel.
///
/// The nearest triangle is [`opaque`]'s, by integer keys. The pixel's ray meets the
/// triangle where its homogeneous edge functions have it (Olano and Greer 1997): with
/// corners `(x, y, w)` in pixels from the middle of the pixel, weight `i` is
/// `x_j y_k - x_k y_j` over the sum of all three. Coverage was decided on snapped corners,
/// so a weight may be a little negative; it is then 0. So the point belongs to the
/// triangle whatever the arithmetic, and it is kept in the triangle's box. It is snapped to
/// the nearest lattice point, halves up, and moved off the face ([`Parameters::offset`]).
pub fn gbuffer(model: &Model, view: &View, parameters: &Parameters) -> Gbuffer {
    let scene = view.scene(model);
    let primitives = primitives(&scene, SUBPIXEL_BITS);
    let nearest = opaque(&scene, &primitives);
    let points = Points::new(model, view, parameters);
    let pixel = |(pixel, prim): (usize, &u32)| points.pixel(pixel, &primitives, *prim);
    let (surfaces, stray) = nearest.prim.iter().enumerate().map(pixel).unzip();
    Gbuffer {
        size: view.size,
        keys: nearest.key,
        surfaces,
        stray,
    }
}

/// Moves a point along the longest component of the face's normal to one side. Does not
/// move it for a triangle without area.
pub(crate) fn moved_off(
    model: &Model,
    triangle: u32,
    side: i32,
    mut point: Point,
    by: u32,
) -> Point {
    let face = model.face(triangle);
    let axis = face.axis();
    let way = match face.normal[axis].signum() {
        1 => side,
        -1 => -side,
        _ => 0,
    };
    point[axis] += way * by.cast_signed();
    point
}

/// The middle of a pixel, in pixels.
fn middle(pixel: usize, size: Size) -> [f64; 2] {
    let width = size.width as usize;
    [pixel % width, pixel / width].map(|c| c as f64 + 0.5)
}

/// The second half of [`gbuffer`], pixel by pixel, of triangles that are known.
pub struct Points<'a> {
    model: &'a Model,
    view: &'a View,
    /// Of [`Parameters`].
    offset: u32,
    /// Corners in homogeneous pixels, with and without bounds.
    plain: Vec<[f64; 3]>,
    bounded: Vec<[Bounded; 3]>,
}

impl<'a> Points<'a> {
    /// Of a model as it is seen.
    pub fn new(model: &'a Model, view: &'a View, parameters: &Parameters) -> Self {
        let matrix = viewport(view.size).times(&view.matrix);
        Self {
            model,
            view,
            offset: parameters.offset,
            plain: homogeneous(model, &matrix),
            bounded: homogeneous(model, &matrix),
        }
    }

    /// What a pixel sees where a triangle is nearest, or [`NOTHING`] is, and how far the point may be
    /// from an evaluation's ([`Gbuffer::stray`]).
    pub fn pixel(
        &self,
        pixel: usize,
        primitives: &Primitives,
        prim: u32,
    ) -> (Option<Surface>, [u32; 3]) {
        if prim == NOTHING {
            return (None, [0; 3]);
        }
        let triangle = primitives.source[prim as usize];
        let side = self.view.side(self.model, triangle);
        let (point, stray) = self.point(triangle, middle(pixel, self.view.size));
        let surface = Surface {
            triangle,
            side,
            point: moved_off(self.model, triangle, side, point, self.offset),
        };
        (Some(surface), stray)
    }

    /// The point of a triangle at a pixel, and how far an evaluation may stray from it.
    fn point(&self, triangle: u32, pixel: [f64; 2]) -> (Point, [u32; 3]) {
        let corners = self.model.corners(triangle);
        let rows = self.model.triangles[triangle as usize].map(|row| row as usize);
        let exact = met(rows.map(|row| self.plain[row]), corners, pixel);
        let bounded = met(rows.map(|row| self.bounded[row]), corners, pixel);
        let mut point = corners[0];
        let mut stray = [0; 3];
        for axis in 0..3 {
            let sides = corners.map(|corner| corner[axis]);
            let low = sides[0].min(sides[1]).min(sides[2]);
            let high = sides[0].max(sides[1]).max(sides[2]);
            let long = f64::from(high) - f64::from(low);
            // `min` takes the triangle's length for a NaN.
            let off = bounded.map_or(long, |b| b[axis].bound.min(long));
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "clamped to the box of the triangle, no longer than 2^24"
            )]
            {
                if let Some(exact) = exact {
                    let nearest = libm::floor(exact[axis] + 0.5);
                    point[axis] = nearest.clamp(f64::from(low), f64::from(high)) as i32;
                }
                // Numbers that far apart may round to integers one farther apart.
                stray[axis] = libm::floor(off + 1.0).min(long) as u32;
            }
        }
        (point, stray)
    }
}

fn homogeneous<T: Real>(model: &Model, matrix: &Matrix) -> Vec<[T; 3]> {
    let [x, y, _, w] = matrix.rows;
    let transform = |p: &Point| {
        let [a, b, c] = p.map(f64::from);
        [x, y, w].map(|row| T::sum_of_products(row, [a, b, c, 1.0]))
    };
    model.vertices.iter().map(transform).collect()
}

/// Where the ray of a pixel meets a triangle, in steps; `None` where it is seen edge-on,
/// or may be for all that the arithmetic says.
fn met<T: Real>(pixels: [[T; 3]; 3], corners: [Point; 3], middle: [f64; 2]) -> Option<[T; 3]> {
    let from = pixels.map(|[x, y, w]| {
        let off = |c: T, to: f64| c.sub(w.mul(T::exact(to)));
        [off(x, middle[0]), off(y, middle[1])]
    });
    let edge = |j: usize, k: usize| {
        let ([a, b], [c, d]) = (from[j], from[k]);
        a.mul(d).sub(c.mul(b))
    };
    let edges = [edge(1, 2), edge(2, 0), edge(0, 1)];
    let total = edges[0].add(edges[1]).add(edges[2]);
    if !total.certainly_differs(T::exact(0.0)) {
        return None;
    }
    let sign = T::exact(total.value().signum());
    let weights = edges.map(|e| e.mul(sign).at_least(0.0));
    let total = weights[0].add(weights[1]).add(weights[2]);
    let towards = [1, 2].map(|i| (weights[i].div(total), minus(corners[i], corners[0])));
    let along = |axis: usize| {
        let step = |(weight, way): (T, Point)| weight.mul(T::exact(f64::from(way[axis])));
        let from = T::exact(f64::from(corners[0][axis]));
        from.add(step(towards[0]).add(step(towards[1])))
    };
    Some([along(0), along(1), along(2)])
}
