//! Blockers of a grid as an Embree scene, and rays through them.
//!
//! Lattice coordinates are integers of at most 2^23, so Embree is given exactly what the
//! spec has; nothing is scaled, as [`bound`] shows that no intermediate value leaves the
//! range of `f32`.

pub mod bound;
#[cfg(test)]
mod tests;

use embree4_sys::RTCRay;
use triptych_spec::grid::Blockers;
use triptych_spec::grid::lattice::{EXTENT, Point};
use triptych_spec::grid::ray::Ray;

use super::EmbreeError;
use super::bare::Bare;
use super::scene::Hit;

/// An observation by rays through blockers: Embree's, or a test's corruption of it.
pub trait RayAnswers: Sync {
    /// Whether the ray meets anything.
    fn occluded(&self, ray: &Ray) -> bool;

    /// What the ray meets first, and when.
    fn closest(&self, ray: &Ray) -> Option<Hit>;

    /// What went wrong with this thread's rays since this was last asked.
    ///
    /// # Errors
    /// The first error that Embree reports.
    fn check(&self) -> Result<(), EmbreeError>;
}

/// An observation of all that lies along rays: Embree's, or a test's corruption of it.
pub trait RayLists: Sync {
    /// Adds every triangle that the ray meets, once, in order of triangles.
    ///
    /// # Errors
    /// The first error that Embree reports.
    fn all(&self, ray: &Ray, hits: &mut Vec<Hit>) -> Result<(), EmbreeError>;
}

/// Blockers, committed to Embree.
pub struct RayScene {
    /// Absent if there are no triangles: Embree refuses empty buffers.
    scene: Option<Bare>,
}

impl RayScene {
    /// Builds the scene. Hits are of rows of [`Blockers::triangles`].
    ///
    /// # Errors
    /// If a corner lies beyond the lattice's extent, if a triangle names a missing one, or
    /// if Embree reports an error.
    pub fn new(blockers: &Blockers) -> Result<Self, EmbreeError> {
        let outside = |p: &&Point| p.iter().any(|c| !(-EXTENT..=EXTENT).contains(c));
        if let Some(corner) = blockers.vertices.iter().find(outside) {
            let reason = format!("corner {corner:?} lies beyond the lattice");
            return Err(EmbreeError::new("check of the triangles", reason));
        }
        let corners: Vec<[f32; 3]> = blockers.vertices.iter().map(|p| single(*p)).collect();
        let any = !blockers.triangles.is_empty();
        let scene = any.then(|| Bare::new(&corners, &blockers.triangles));
        Ok(Self {
            scene: scene.transpose()?,
        })
    }

    /// Bytes that Embree holds for it.
    pub fn bytes(&self) -> u64 {
        self.scene.as_ref().map_or(0, Bare::bytes)
    }
}

impl RayAnswers for RayScene {
    fn occluded(&self, ray: &Ray) -> bool {
        let scene = self.scene.as_ref();
        scene.is_some_and(|scene| scene.occluded(traced(ray)))
    }

    fn closest(&self, ray: &Ray) -> Option<Hit> {
        self.scene.as_ref()?.closest(traced(ray))
    }

    fn check(&self) -> Result<(), EmbreeError> {
        self.scene.as_ref().map_or(Ok(()), Bare::check)
    }
}

impl RayLists for RayScene {
    fn all(&self, ray: &Ray, hits: &mut Vec<Hit>) -> Result<(), EmbreeError> {
        let Some(scene) = &self.scene else {
            return Ok(());
        };
        let from = hits.len();
        if !scene.all(traced(ray), hits) {
            return Err(EmbreeError::new("ray", "a hit went past the filter"));
        }
        scene.check()?;
        // A triangle that is in several leaves of the tree is reported in each.
        hits[from..].sort_by_key(|hit| hit.prim);
        hits.dedup_by_key(|hit| hit.prim);
        Ok(())
    }
}

/// A ray as Embree takes it.
fn traced(ray: &Ray) -> RTCRay {
    let ([org_x, org_y, org_z], [dir_x, dir_y, dir_z]) =
        (single(ray.origin), single(ray.direction));
    RTCRay {
        org_x,
        org_y,
        org_z,
        tnear: 0.0,
        dir_x,
        dir_y,
        dir_z,
        tfar: if ray.segment { 1.0 } else { f32::INFINITY },
        ..RTCRay::default()
    }
}

/// Exact: integers of a lattice and their differences have 24 bits at most.
fn single(point: Point) -> [f32; 3] {
    point.map(|c| c as f32)
}
