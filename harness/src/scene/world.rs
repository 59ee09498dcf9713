//! The scene before a camera looks at it.

use triptych_spec::camera::Camera;
use triptych_spec::matrix::Matrix;
use triptych_spec::scene::{Scene, Vertex};

/// World space: what the legs that rasterise are given multiplied together.
#[derive(Clone, Debug, PartialEq)]
pub struct World {
    /// Who looks.
    pub camera: Camera,
    /// World from object space, one for each of [`Scene::instances`].
    pub instances: Vec<Matrix>,
}

impl World {
    /// A vertex in world space.
    pub fn point(&self, vertex: &Vertex) -> [f64; 3] {
        self.instances[vertex.instance as usize].point(vertex.position.map(f64::from))
    }

    /// All of a scene's vertices in world space.
    pub fn points(&self, scene: &Scene) -> Vec<[f64; 3]> {
        scene.vertices.iter().map(|v| self.point(v)).collect()
    }
}
