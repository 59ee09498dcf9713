//! What every leg is given: triangles in world space, a matrix per instance, a
//! size in pixels. Loading files and shading faces happen before (in the
//! harness), once, so that all legs start from the same bits.

use crate::abuffer::Order;
use crate::matrix::Matrix;
use crate::raster::Samples;

/// Size of the target in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Size {
    /// Pixels per row, 1 to [`crate::vertex::TARGET_MAX`].
    pub width: u32,
    /// Rows, 1 to [`crate::vertex::TARGET_MAX`].
    pub height: u32,
}

impl Size {
    /// Number of pixels; fits because a side is at most 2048.
    pub fn pixels(self) -> usize {
        self.width as usize * self.height as usize
    }
}

/// A vertex as loaded: object space, finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vertex {
    /// Object-space position.
    pub position: [f32; 3],
    /// Index into [`Scene::instances`].
    pub instance: u32,
}

/// A source triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangle {
    /// Indices into [`Scene::vertices`].
    pub vertices: [u32; 3],
    /// Index into [`Scene::instances`].
    pub instance: u32,
    /// Number of the triangle within its mesh, counted over all meshes.
    pub primitive: u32,
    /// Linear colour and opacity of the face, not premultiplied; 1 is opaque.
    pub colour: [f32; 4],
}

impl Triangle {
    /// A face hides what lies behind it if and only if its opacity is 1.
    pub fn is_opaque(&self) -> bool {
        self.colour[3] >= 1.0
    }
}

/// A scene flattened for the legs.
///
/// `triangles` is sorted by `(primitive, instance)`: a row number is then also
/// the tie key, and no leg needs to carry more than one word for it.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// Size of the target.
    pub size: Size,
    /// The samples of every pixel.
    pub samples: Samples,
    /// In which order layers lie at each of them, where there are several.
    pub order: Order,
    /// Clip space from object space, one per instance (WebGPU's clip volume:
    /// `-w <= x, y <= w`, `0 <= z <= w`, y up).
    pub instances: Vec<Matrix>,
    /// All vertices of all instances.
    pub vertices: Vec<Vertex>,
    /// All triangles of all instances, in tie order.
    pub triangles: Vec<Triangle>,
    /// Linear background colour.
    pub background: [f32; 3],
}
