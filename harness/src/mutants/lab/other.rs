//! Scenes that are no triangles to a picture: with a grid, or with indirect light.

use triptych_gpu::error::GpuError;
use triptych_gpu::raster::Path;

use crate::observe::{Observed, Spec};
use crate::plan::RsmPlan;
use crate::registry::Chain;
use crate::replay::gpu::Adapter;
use crate::replay::grid::{GridLeg, GridRun};
use crate::replay::rows::Rows;
use crate::replay::rsm::{RsmLeg, RsmRun};
use crate::scene::Loaded;
use crate::scene::value::Capacity;

/// What the spec says of such a scene.
pub(super) enum Other {
    /// With a grid, and entries of the first attempt.
    Grid(Observed<Spec, GridRun>, Capacity),
    /// With indirect light.
    Rsm(Observed<Spec, RsmRun>, RsmPlan),
}

impl Other {
    /// `None` for triangles to a picture.
    pub(super) fn of(loaded: &Loaded) -> Result<Option<Self>, String> {
        Ok(match loaded.chain() {
            Chain::Frame => None,
            Chain::Rays => {
                let capacity = loaded.file.grid.unwrap_or_default().capacity;
                let spec = Observed::new("spec", GridRun::new(loaded)?);
                Some(Self::Grid(spec, capacity))
            }
            Chain::Indirect => {
                let spec = Observed::new("spec", RsmRun::new(loaded, true)?);
                Some(Self::Rsm(spec, RsmPlan::new(loaded, true)))
            }
        })
    }

    /// Adds the rows of a leg's stages, each from the spec's input.
    pub(super) fn rows(
        &self,
        adapter: &Adapter,
        path: Path,
        rows: &mut Rows,
    ) -> Result<(), GpuError> {
        match self {
            Self::Grid(spec, capacity) => GridLeg::new(adapter, path, spec, *capacity).each(rows),
            Self::Rsm(spec, plan) => RsmLeg {
                adapter,
                path,
                spec,
                plan,
            }
            .each(rows),
        }
    }
}
