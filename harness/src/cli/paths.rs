//! Which raster paths of which adapters a command runs.

use triptych_gpu::raster::Path;

use super::adapters::OnAdapters;
use crate::again::option;
use crate::replay::gpu::{Adapter, Adapters, PathName};

/// Adapters and paths; all of them without one.
#[derive(clap::Args)]
pub struct OnPaths {
    #[command(flatten)]
    adapters: OnAdapters,
    /// Only this raster path (repeatable)
    #[arg(long)]
    path: Vec<PathName>,
}

impl OnPaths {
    /// The paths, each once.
    pub fn paths(&self) -> Vec<Path> {
        let mut paths = Path::ALL.to_vec();
        if self.is_limited() {
            paths.retain(|path| self.path.iter().any(|asked| asked.path() == *path));
        }
        paths
    }

    /// Whether some paths are left out.
    pub fn is_limited(&self) -> bool {
        !self.path.is_empty()
    }

    /// The adapters, of which some work and have one of the paths.
    ///
    /// # Errors
    /// There is none.
    pub fn usable(&self) -> anyhow::Result<Adapters> {
        let found = self.adapters.usable()?;
        let runs = |a: &Adapter, path: &Path| *path != Path::Native || a.native.is_some();
        let paths = self.paths();
        let runs_any = |a: &Adapter| paths.iter().any(|path| runs(a, path));
        anyhow::ensure!(
            found.open.iter().any(runs_any),
            "no adapter that was asked for has the 64-bit integers that --path native needs"
        );
        Ok(found)
    }

    /// What a command must repeat to run on the same.
    pub fn again(&self) -> Vec<String> {
        let adapters = self.adapters.again();
        let paths = self.paths().into_iter().filter(|_| self.is_limited());
        let paths = paths.map(|path| option("--path", path.name()));
        adapters.chain(paths).collect()
    }
}
