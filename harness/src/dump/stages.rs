//! The layouts of the stages' results.

use std::io;

use triptych_spec::abuffer::Sorted;
use triptych_spec::raster::Fragment;
use triptych_spec::scene::{Scene, Triangle};
use triptych_spec::vertex::Primitives;

use super::LegDump;

impl LegDump {
    /// Writes `vertex/snapped`, `vertex/prims` and `vertex/source`.
    ///
    /// A leg's result may be wrong: the source of a triangle that the scene does
    /// not have is written as the largest `u32`, twice.
    ///
    /// # Errors
    ///
    /// If a file cannot be written.
    pub fn primitives(&self, primitives: &Primitives, scene: &Scene) -> io::Result<()> {
        let snapped = primitives.snapped.as_flattened();
        self.i32("vertex", "snapped", &[primitives.snapped.len(), 3], snapped)?;
        let prims = primitives.prims.as_flattened();
        self.u32("vertex", "prims", &[primitives.prims.len(), 3], prims)?;
        let source: Vec<u32> = primitives
            .source
            .iter()
            .map(|&row| scene.triangles.get(row as usize))
            .flat_map(|t| t.map_or([u32::MAX; 2], |t| [t.instance, t.primitive]))
            .collect();
        self.u32("vertex", "source", &[primitives.source.len(), 2], &source)
    }

    /// Writes sorted lists with the colours of the scene's faces.
    ///
    /// # Errors
    ///
    /// As [`Self::lists`].
    pub fn sorted(
        &self,
        scene: &Scene,
        primitives: &Primitives,
        sorted: &Sorted,
    ) -> io::Result<()> {
        let face = |f: &Fragment| -> Option<&Triangle> {
            let row = primitives.source.get(f.prim as usize)?;
            scene.triangles.get(*row as usize)
        };
        // A leg's result may be wrong: what has no face has no colour.
        let colour = |f| face(f).map_or([f32::NAN; 4], |t| t.colour);
        let colours: Vec<[f32; 4]> = sorted.fragments.iter().map(colour).collect();
        self.lists(&sorted.offsets, &sorted.fragments, &colours)
    }

    /// Writes `abuffer/offsets`, `depth`, `prim`, `mask` and `rgba`.
    ///
    /// # Errors
    ///
    /// If there is not one colour per fragment, or a file cannot be written.
    pub fn lists(
        &self,
        offsets: &[u32],
        fragments: &[Fragment],
        colours: &[[f32; 4]],
    ) -> io::Result<()> {
        let n = fragments.len();
        self.u32("abuffer", "offsets", &[offsets.len()], offsets)?;
        let column = |name, of: fn(&Fragment) -> u32| {
            let column: Vec<u32> = fragments.iter().map(of).collect();
            self.u32("abuffer", name, &[n], &column)
        };
        column("depth", |f| f.key)?;
        column("prim", |f| f.prim)?;
        column("mask", |f| f.mask)?;
        self.f32("abuffer", "rgba", &[n, 4], colours.as_flattened())
    }
}
