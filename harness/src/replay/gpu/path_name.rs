//! Raster paths by name, on the command line and in tables.

use clap::ValueEnum;
use serde::Deserialize;
use triptych_gpu::raster::Path;

/// The name of a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PathName {
    /// The hardware's rasteriser
    Fragment,
    /// Integer arithmetic in baseline WGSL
    Compute,
    /// The same with 64-bit integers, where an adapter has them
    Native,
}

impl PathName {
    /// The path.
    pub fn path(self) -> Path {
        match self {
            Self::Fragment => Path::Fragment,
            Self::Compute => Path::Compute,
            Self::Native => Path::Native,
        }
    }
}
