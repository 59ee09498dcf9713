//! The spec, Embree and `obvhs` on the CPU.

use std::time::Duration;

use glam::Vec3A;
use obvhs::BvhBuildParams;
use obvhs::cwbvh::builder::build_cwbvh_from_tris;
use obvhs::cwbvh::{CwBvh, node::CwBvhNode};
use obvhs::ray::{Ray as ObvhsRay, RayHit};
use obvhs::triangle::Triangle;
use rayon::prelude::*;
use triptych_spec::grid::ray::Ray;
use triptych_spec::grid::trace::{Query, blocked, closest};
use triptych_spec::grid::{Blockers, Grid};

use crate::embree::EmbreeError;
use crate::embree::rays::{RayAnswers, RayScene};

/// Rays that a thread takes at once.
const CHUNK: usize = 1 << 10;

/// Asks a tracer of rays and counts those that meet something.
pub(super) fn count(rays: &[Ray], threads: bool, met: impl Fn(&Ray) -> bool + Sync) -> u64 {
    let of = |rays: &[Ray]| rays.iter().filter(|ray| met(ray)).count() as u64;
    match threads {
        true => rays.par_chunks(CHUNK).map(of).sum(),
        false => of(rays),
    }
}

/// Whether the spec says that a ray meets something.
pub(super) fn of_spec(grid: &Grid, blockers: &Blockers, query: Query, ray: &Ray) -> bool {
    match query {
        Query::Any => blocked(grid, blockers, *ray),
        Query::Closest => closest(grid, blockers, *ray).is_some(),
    }
}

/// Bytes of the spec's grid and its triangles.
pub(super) fn bytes(grid: &Grid, blockers: &Blockers) -> u64 {
    let boundaries: usize = grid.axes.iter().map(|axis| axis.boundaries().len()).sum();
    let points = 12 * (blockers.vertices.len() + blockers.triangles.len());
    (points + 4 * (boundaries + grid.offsets.len() + grid.prims.len())) as u64
}

/// Others' trees of the same triangles.
pub(super) struct Rivals {
    pub(super) embree: RayScene,
    pub(super) obvhs: Obvhs,
}

impl Rivals {
    /// Builds both.
    ///
    /// # Errors
    /// What Embree reports.
    pub(super) fn new(blockers: &Blockers) -> Result<Self, EmbreeError> {
        Ok(Self {
            embree: embree(blockers)?,
            obvhs: Obvhs::new(blockers),
        })
    }
}

/// Whether Embree meets something, and what, if that is asked.
pub(super) fn of_embree(scene: &RayScene, query: Query, ray: &Ray) -> Option<Option<u32>> {
    match query {
        Query::Any => scene.occluded(ray).then_some(None),
        Query::Closest => scene.closest(ray).map(|hit| Some(hit.prim)),
    }
}

/// Embree's tree.
pub(super) fn embree(blockers: &Blockers) -> Result<RayScene, EmbreeError> {
    RayScene::new(blockers)
}

/// `obvhs`' tree of eight children a node, with its triangles in the order of its leaves.
pub(super) struct Obvhs {
    tree: CwBvh,
    triangles: Vec<Triangle>,
}

impl Obvhs {
    pub(super) fn new(blockers: &Blockers) -> Self {
        let rows = 0..u32::try_from(blockers.triangles.len()).expect("fewer than 2^32");
        let vector = |p: [i32; 3]| Vec3A::from(p.map(|c| c as f32));
        let triangle = |row| {
            let [v0, v1, v2] = blockers.corners(row).map(vector);
            Triangle { v0, v1, v2 }
        };
        let triangles: Vec<Triangle> = rows.map(triangle).collect();
        let mut core = Duration::ZERO;
        let tree = build_cwbvh_from_tris(&triangles, BvhBuildParams::medium_build(), &mut core);
        let in_order = tree.primitive_indices.iter();
        let in_order = in_order.map(|i| triangles[*i as usize]).collect();
        Self {
            tree,
            triangles: in_order,
        }
    }

    /// Bytes of nodes, rows and triangles.
    pub(super) fn bytes(&self) -> u64 {
        let nodes = size_of::<CwBvhNode>() * self.tree.nodes.len();
        let rows = size_of::<u32>() * self.tree.primitive_indices.len();
        (nodes + rows + size_of::<Triangle>() * self.triangles.len()) as u64
    }

    /// Whether it meets something, and what, if that is asked.
    pub(super) fn meets(&self, query: Query, ray: &Ray) -> Option<Option<u32>> {
        let [origin, direction] =
            [ray.origin, ray.direction].map(|p| Vec3A::from(p.map(|c| c as f32)));
        let end = if ray.segment { 1.0 } else { f32::MAX };
        let ray = ObvhsRay::new(origin, direction, 0.0, end);
        let intersect = |ray: &ObvhsRay, id: usize| self.triangles[id].intersect(ray);
        match query {
            Query::Any => (!self.tree.ray_traverse_miss(ray, intersect)).then_some(None),
            Query::Closest => {
                let mut hit = RayHit::none();
                let met = self.tree.ray_traverse(ray, &mut hit, intersect);
                met.then(|| Some(self.tree.primitive_indices[hit.primitive_id as usize]))
            }
        }
    }
}
