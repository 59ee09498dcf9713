//! From where the model is seen: by the eye, or by the light.

use super::parameters::within;
use super::{Model, RsmError};
use crate::abuffer::Order;
use crate::camera::{Camera, Projection};
use crate::grid::exact::minus;
use crate::grid::lattice::{Lattice, Point};
use crate::grid::ray::Ray;
use crate::matrix::Matrix;
use crate::raster::Samples;
use crate::scene::{Scene, Size, Triangle, Vertex};
use crate::vertex::TARGET_MAX;

/// Where what is seen is seen from, on the lattice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Viewpoint {
    /// From a point: perspective.
    Near(Point),
    /// From infinitely far in a direction, of 24 bits: orthographic.
    Far(Point),
}

impl Viewpoint {
    /// From a point to the viewpoint.
    pub fn from(self, point: Point) -> Point {
        match self {
            Self::Near(eye) => minus(eye, point),
            Self::Far(direction) => direction,
        }
    }
}

/// A camera on the lattice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Of the picture.
    pub size: Size,
    /// Clip space from lattice steps.
    pub matrix: Matrix,
    /// Eye of the matrix; for an orthographic one, its direction rounded to 24 bits.
    pub viewpoint: Viewpoint,
    /// Perspective, or orthographic with its height in lattice steps.
    pub projection: Projection,
}

impl View {
    /// A camera of the world, moved to the lattice. The eye of a perspective is snapped
    /// before the matrix is made of it, so that both say which side of a face is seen.
    ///
    /// # Errors
    /// A size beyond the limits, a camera without a matrix, a perspective from beyond the
    /// lattice.
    pub fn new(camera: &Camera, lattice: &Lattice, size: Size) -> Result<Self, RsmError> {
        within("the width", size.width, 1, TARGET_MAX)?;
        within("the height", size.height, 1, TARGET_MAX)?;
        let steps = |length: f64| libm::scalbn(length, -lattice.exponent);
        let moved =
            |point: [f64; 3]| [0, 1, 2].map(|axis| steps(point[axis] - lattice.centre[axis]));
        let mut here = Camera {
            eye: moved(camera.eye),
            target: moved(camera.target),
            near: steps(camera.near),
            far: steps(camera.far),
            ..*camera
        };
        let viewpoint = match camera.projection {
            Projection::Perspective { .. } => {
                let eye = lattice.snap(camera.eye).ok_or(RsmError::TooFar)?;
                here.eye = eye.map(f64::from);
                Viewpoint::Near(eye)
            }
            Projection::Orthographic { height } => {
                let height = steps(height);
                here.projection = Projection::Orthographic { height };
                let back = [0, 1, 2].map(|axis| here.eye[axis] - here.target[axis]);
                Viewpoint::Far(Ray::along([0; 3], back).direction)
            }
        };
        let aspect = f64::from(size.width) / f64::from(size.height);
        Ok(Self {
            size,
            matrix: here.matrix(aspect)?,
            viewpoint,
            projection: here.projection,
        })
    }

    /// The model as the vertex stages are given it. Its coordinates are those of the
    /// lattice, which `f32` holds, and its only instance's matrix is the view's.
    pub fn scene(&self, model: &Model) -> Scene {
        let vertex = |point: &Point| Vertex {
            // At most 2^23, exact.
            position: point.map(|c| c as f32),
            instance: 0,
        };
        let triangle =
            |(primitive, (vertices, [r, g, b])): (u32, (&[u32; 3], &[f32; 3]))| Triangle {
                vertices: *vertices,
                instance: 0,
                primitive,
                colour: [*r, *g, *b, 1.0],
            };
        let triangles = model.triangles.iter().zip(&model.colours);
        Scene {
            size: self.size,
            samples: Samples::ONE,
            order: Order::Centroid,
            instances: vec![self.matrix],
            vertices: model.vertices.iter().map(vertex).collect(),
            triangles: (0..).zip(triangles).map(triangle).collect(),
            background: [0.0; 3],
        }
    }

    /// Which side of a triangle is seen: 1 where its normal points to, else -1. Decided for
    /// the whole triangle at once, exactly; one that is seen edge-on shows side 1, by rule.
    pub fn side(&self, model: &Model, triangle: u32) -> i32 {
        let [corner, ..] = model.corners(triangle);
        let towards = model.face(triangle).along(self.viewpoint.from(corner));
        if towards < 0 { -1 } else { 1 }
    }
}
