//! The `[grid]` of a scene: its triangles block rays.

use serde::Deserialize;
use triptych_spec::grid::Membership;
use triptych_spec::grid::axis::CELLS_MAX;
use triptych_spec::grid::resolution::Resolution;

use super::Parsed;
use super::value::{Capacity, Exactly};
use crate::error::InputError;

/// Most rays of a kind: with answers and copies a ray costs about 200 bytes.
pub const RAYS_MAX: u32 = 1 << 21;

/// How the grid is built, and which rays go through it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Grid {
    /// Cells along x, y and z; left out: from the scene.
    pub resolution: Option<Cells>,
    /// Cells list triangles that touch them, not only those whose box does.
    #[serde(default)]
    pub overlap: bool,
    /// Entries of the first attempt; fewer than needed makes it overflow.
    #[serde(default)]
    pub capacity: Capacity,
    /// Rays of each kind.
    #[serde(default)]
    pub rays: Rays,
}

impl Grid {
    /// The spec's name for the resolution.
    pub fn resolution(&self) -> Resolution {
        self.resolution
            .map_or(Resolution::FromScene, |cells| Resolution::Given(cells.0))
    }

    /// Which cells list a triangle.
    pub fn membership(&self) -> Membership {
        match self.overlap {
            true => Membership::Overlap,
            false => Membership::Box,
        }
    }
}

/// Numbers of cells along three axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(try_from = "Exactly<i64, 3>")]
pub struct Cells(pub [u32; 3]);

impl TryFrom<Exactly<i64, 3>> for Cells {
    type Error = String;
    fn try_from(Exactly(v): Exactly<i64, 3>) -> Result<Self, String> {
        let mut cells = [0; 3];
        for (cells, v) in cells.iter_mut().zip(v) {
            let given = u32::try_from(v).ok();
            let given = given.filter(|n| (1..=CELLS_MAX).contains(n));
            *cells = given.ok_or_else(|| format!("{v} is outside 1 to {CELLS_MAX} cells"))?;
        }
        Ok(Self(cells))
    }
}

/// How many rays of each kind there are (`crate::rays`).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Rays {
    /// Segments between random points in and around the blockers' box.
    pub random: Count,
    /// From random points towards points on triangles.
    pub aimed: Count,
    /// From random points towards points on edges.
    pub edge: Count,
    /// From random points towards corners.
    pub vertex: Count,
    /// Nearly in the planes of triangles.
    pub grazing: Count,
    /// Along axes, faces, edges and diagonals of cells.
    pub cell: Count,
}

impl Default for Rays {
    fn default() -> Self {
        let count = Count(250);
        Self {
            random: count,
            aimed: count,
            edge: count,
            vertex: count,
            grazing: count,
            cell: count,
        }
    }
}

/// Refuses keys that nothing of a scene with `[grid]` depends on. Lights, materials and background
/// are seen in its pictures.
pub(super) fn check(parsed: &Parsed) -> Result<(), InputError> {
    let file = &parsed.file;
    if file.grid.is_none() || file.is_lit_later() {
        return Ok(());
    }
    let idle = ["camera", "samples", "abuffer", "expect", "budget.vertex"];
    let stated = idle.into_iter().find(|key| parsed.keys.states(key));
    stated.map_or(Ok(()), |key| {
        let message = "has no effect on a scene with [grid]; leave it out";
        Err(parsed.mistake(key, message))
    })
}

/// A number of rays.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(try_from = "i64")]
pub struct Count(pub u32);

impl TryFrom<i64> for Count {
    type Error = String;
    fn try_from(v: i64) -> Result<Self, String> {
        let count = u32::try_from(v).ok().filter(|n| *n <= RAYS_MAX);
        count
            .map(Self)
            .ok_or_else(|| format!("{v} is outside 0 to {RAYS_MAX} rays"))
    }
}
