//! The scene before a camera looks at it.

use triptych_spec::camera::{Camera, Projection};
use triptych_spec::matrix::Matrix;
use triptych_spec::scene::{Scene, Vertex};

use super::Loaded;
use super::file::{CameraEntry, MeshEntry, SceneFile};
use crate::registry::Chain;

/// World space: what the legs that rasterise are given multiplied together.
#[derive(Clone, Debug, PartialEq)]
pub struct World {
    /// Who looks.
    pub camera: Camera,
    /// World from object space, one for each of [`Scene::instances`].
    pub instances: Vec<Matrix>,
    /// What each of [`Scene::triangles`] mirrors, of a scene with `[dispatch]`; empty otherwise.
    pub mirrors: Vec<[f32; 3]>,
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

impl CameraEntry {
    /// The camera that it stands for.
    ///
    /// # Errors
    /// Neither a perspective nor orthographic, or both.
    pub fn camera(&self) -> Result<Camera, String> {
        let projection = match (self.fov, self.height) {
            (Some(fov), None) => Projection::Perspective { fov: fov.0 },
            (None, Some(height)) => Projection::Orthographic { height: height.0 },
            _ => {
                let message = "camera: either fov (perspective) or height (orthographic) is needed";
                return Err(message.to_owned());
            }
        };
        Ok(Camera {
            eye: self.eye.0,
            target: self.target.0,
            up: self.up.0,
            projection,
            near: self.near.0,
            far: self.far.0,
        })
    }
}

impl Loaded {
    /// The mesh entry of each of [`Scene::instances`].
    pub fn entries(&self) -> Vec<&MeshEntry> {
        let entries = self.file.mesh.iter().map(toml::Spanned::get_ref);
        let copies = entries.flat_map(|entry| entry.instances.iter().map(move |_| entry));
        copies.collect()
    }

    /// As what it is replayed.
    pub fn chain(&self) -> Chain {
        let SceneFile {
            dispatch,
            ldm,
            rsm,
            grid,
            ..
        } = &self.file;
        match (dispatch, ldm, rsm, grid) {
            (Some(_), ..) => Chain::Traced,
            (None, Some(_), ..) => Chain::Maps,
            (None, None, Some(_), _) => Chain::Indirect,
            (None, None, None, Some(_)) => Chain::Rays,
            (None, None, None, None) => Chain::Frame,
        }
    }

    /// How many triangles are seen, and how many block indirect light.
    pub fn parts(&self) -> [u64; 2] {
        let entries = self.entries();
        let count = |is: fn(&MeshEntry) -> bool| {
            let triangles = self.scene.triangles.iter();
            let parts = triangles.filter(|t| is(entries[t.instance as usize]));
            parts.count() as u64
        };
        [count(MeshEntry::is_seen), count(MeshEntry::does_block)]
    }
}
