//! Which paths can say anything of a mutant.

use triptych_gpu::raster::Path;

use super::Ground;
use crate::calibrate::Grid;
use crate::replay::gpu::{Adapter, Drawn};

impl Ground {
    /// Why a path has nothing to say of a mutant on this scene.
    pub(super) fn cannot_run(&self, adapter: &Adapter, path: Path) -> Option<String> {
        let samples = self.loaded.scene.samples;
        match path {
            Path::Native if adapter.native.is_none() => Some("no 64-bit integers".to_owned()),
            Path::Fragment if adapter.grid == Grid::Unknown => {
                Some("the sub-pixel grid is unknown".to_owned())
            }
            _ => match adapter.samples(path, samples) {
                Ok(Drawn::With(found)) if found == samples => None,
                Ok(Drawn::With(_)) => Some("its samples have places of their own".to_owned()),
                Ok(Drawn::Not(reason)) => Some(reason),
                Err(error) => Some(error.to_string()),
            },
        }
    }
}
