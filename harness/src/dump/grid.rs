//! The layout of a grid, its rays, and what a leg says of them.

use std::io;

use triptych_spec::abuffer::NOTHING;
use triptych_spec::grid::Blockers;
use triptych_spec::grid::axis::Axis;
use triptych_spec::grid::lattice::Lattice;
use triptych_spec::grid::ray::Ray;

use super::LegDump;

/// What a leg knows of a grid. Triangles, boundaries and rays are those of all legs; lists and
/// hits are the leg's own.
#[derive(Clone, Copy)]
pub struct GridArrays<'a> {
    /// World space and the lattice.
    pub lattice: &'a Lattice,
    /// Boundaries on x, y and z.
    pub axes: &'a [Axis; 3],
    /// Triangles.
    pub blockers: &'a Blockers,
    /// Where each cell's list starts, and the end of the last.
    pub offsets: &'a [u32],
    /// Rows of triangles.
    pub prims: &'a [u32],
    /// Rays.
    pub rays: &'a [Ray],
    /// Of each ray: a triangle that blocks it, and the first with its time.
    pub hits: &'a [GridHit],
}

/// What a ray meets: any triangle, the first one, and when.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GridHit {
    /// Some triangle that blocks it.
    pub any: Option<u32>,
    /// The first, and its time.
    pub closest: Option<(u32, f64)>,
}

impl LegDump {
    /// Writes `grid/dims`, `boundaries`, `lattice`, `triangles`, `offsets`, `prims`, `rays`,
    /// `hit` and `t`.
    ///
    /// # Errors
    ///
    /// If a file cannot be written.
    pub fn grid(&self, arrays: &GridArrays<'_>) -> io::Result<()> {
        let GridArrays {
            lattice,
            axes,
            blockers,
            offsets,
            prims,
            rays,
            hits,
        } = arrays;
        self.u32("grid", "dims", &[3], &axes.each_ref().map(Axis::cells))?;
        let boundaries = axes.iter().flat_map(|axis| axis.boundaries());
        let boundaries: Vec<i32> = boundaries.copied().collect();
        self.i32("grid", "boundaries", &[boundaries.len()], &boundaries)?;
        self.lattice("grid", lattice)?;
        let rows = (0_u32..).take(blockers.triangles.len());
        let corners: Vec<i32> = rows
            .flat_map(|row| blockers.corners(row).into_iter().flatten())
            .collect();
        self.i32(
            "grid",
            "triangles",
            &[blockers.triangles.len(), 3, 3],
            &corners,
        )?;
        self.u32("grid", "offsets", &[offsets.len()], offsets)?;
        self.u32("grid", "prims", &[prims.len()], prims)?;
        let of_ray = |ray: &Ray| {
            let ends = ray.origin.into_iter().chain(ray.direction);
            ends.chain([i32::from(ray.segment)])
        };
        let flat: Vec<i32> = rays.iter().flat_map(of_ray).collect();
        self.i32("grid", "rays", &[rays.len(), 7], &flat)?;
        let row = |prim: Option<u32>| prim.unwrap_or(NOTHING);
        let met = |hit: &GridHit| [row(hit.any), row(hit.closest.map(|(prim, _)| prim))];
        let met: Vec<u32> = hits.iter().flat_map(met).collect();
        self.u32("grid", "hit", &[hits.len(), 2], &met)?;
        let times = hits
            .iter()
            .map(|h| h.closest.map_or(f64::NAN, |(_, time)| time));
        let times: Vec<f64> = times.collect();
        self.f64("grid", "t", &[times.len()], &times)
    }

    /// Writes the point of the world that is 0 on the lattice, and a step's size.
    pub(super) fn lattice(&self, stage: &str, lattice: &Lattice) -> io::Result<()> {
        let [x, y, z] = lattice.centre;
        let step = libm::scalbn(1.0, lattice.exponent);
        self.f64(stage, "lattice", &[4], &[x, y, z, step])
    }
}
