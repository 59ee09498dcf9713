//! The scene's own triangles in world space as an Embree scene, and camera rays.

pub mod bound;

use embree4_rs::CommittedScene;
use embree4_sys::RTCRay;
use triptych_spec::scene::Scene;

use super::EmbreeError;
use super::collect::{collect, commit};
use super::scene::{Hit, RayHits};
use super::view::View;

/// World space as Embree has it: a power of two brings all coordinates below 1, which
/// changes no rounding and keeps products in range, however large the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct World {
    /// Vertices, scaled.
    pub points: Vec<[f64; 3]>,
    /// The camera; its rays are in world units.
    pub view: View,
    /// Embree's units from the world's.
    pub scale: f64,
}

impl World {
    /// Scales a scene's vertices, which are given in world space.
    pub fn new(points: &[[f64; 3]], view: View) -> Self {
        let largest = points
            .iter()
            .flatten()
            .fold(view.reach(), |m, x| m.max(x.abs()));
        let exponent = if largest > 0.0 {
            largest.log2().floor() + 1.0
        } else {
            0.0
        };
        let scale = (-exponent).exp2();
        Self {
            points: points.iter().map(|p| p.map(|x| x * scale)).collect(),
            view,
            scale,
        }
    }
}

/// A scene's triangles, committed to Embree.
pub struct WorldScene {
    /// Absent if there are no triangles: Embree refuses empty buffers.
    scene: Option<CommittedScene>,
    view: View,
    scale: f64,
}

impl WorldScene {
    /// Builds the scene. Hits are of rows of [`Scene::triangles`].
    ///
    /// # Errors
    /// If Embree reports an error.
    pub fn new(scene: &Scene, world: &World) -> Result<Self, EmbreeError> {
        let corners: Vec<[f32; 3]> = world.points.iter().map(|p| p.map(single)).collect();
        let prims: Vec<[u32; 3]> = scene.triangles.iter().map(|t| t.vertices).collect();
        let committed = (!prims.is_empty()).then(|| commit(&corners, &prims));
        Ok(Self {
            scene: committed.transpose()?,
            view: world.view,
            scale: world.scale,
        })
    }
}

impl RayHits for WorldScene {
    fn hits(&self, column: u32, row: u32, hits: &mut Vec<Hit>) -> Result<(), EmbreeError> {
        hits.clear();
        let Some(scene) = &self.scene else {
            return Ok(());
        };
        let ray = self.view.ray([column, row]);
        let [origin_x, origin_y, origin_z] = ray.origin.map(|x| single(x * self.scale));
        let [dir_x, dir_y, dir_z] = ray.direction.map(single);
        let [near, far] = ray.range.map(|t| single(t * self.scale));
        let ray = RTCRay {
            org_x: origin_x,
            org_y: origin_y,
            org_z: origin_z,
            tnear: near,
            dir_x,
            dir_y,
            dir_z,
            tfar: far,
            ..RTCRay::default()
        };
        collect(scene, ray, hits)
    }
}

/// The one rounding of what Embree is given.
fn single(exact: f64) -> f32 {
    #[expect(clippy::cast_possible_truncation, reason = "the bound allows for it")]
    let single = exact as f32;
    single
}
