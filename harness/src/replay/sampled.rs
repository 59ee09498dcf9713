//! Which legs draw a scene with several samples a pixel.

use triptych_gpu::error::GpuError;
use triptych_gpu::raster::Path;

use super::gpu::{Adapter, Drawn, From, Vertices};
use super::run::Run;
use super::{Options, skips};

impl Run<'_> {
    /// What an adapter draws this scene's samples with, or why it does not: of several, a
    /// user's kernel knows nothing, and nobody says how far off a driver's own snapping may be.
    pub(super) fn samples(&mut self, adapter: &Adapter, path: Path) -> Result<Drawn, GpuError> {
        let samples = self.loaded.scene.samples;
        if samples.count() == 1 {
            return Ok(Drawn::With(samples));
        }
        if self.options.vertex == Vertices::Hardware {
            let reason = "--vertex hardware judges one sample a pixel".to_owned();
            return Ok(Drawn::Not(reason));
        }
        let of_pixels = ["cover", "opaque", "build", "resolve"];
        let mut foreign = adapter.foreign.iter();
        if let Some(foreign) = foreign.find(|f| of_pixels.contains(&f.stage.name)) {
            let stage = foreign.stage.name;
            return Ok(Drawn::Not(format!(
                "{}: a kernel of stage {stage} is held against one sample a pixel",
                foreign.file
            )));
        }
        let drawn = adapter.samples(path, samples)?;
        if let Drawn::With(found) = &drawn
            && *found != samples
        {
            let label = adapter.label(path);
            self.remarks.push(format!(
                "{label}: samples at {:?}, which is not standard",
                found.positions()
            ));
        }
        Ok(drawn)
    }

    /// From a later stage on than coverage, the spec's lists are given: nothing is skipped.
    /// A path that does not draw the scene's samples has no turn.
    pub(super) fn tests_skipping(&self, adapter: &Adapter, path: Path) -> bool {
        let Options {
            skip, from, paths, ..
        } = self.options;
        let samples = self.loaded.scene.samples;
        let draws = |path: &Path| matches!(adapter.samples(*path, samples), Ok(Drawn::With(_)));
        let paths: Vec<Path> = paths.iter().copied().filter(draws).collect();
        let turn = skips::turn(&self.loaded.name, &adapter.gpu.name, &paths);
        *skip && *from == From::Cover && turn == Some(path)
    }
}
