//! Vertex stages on the device: transform, clip, snap, in batches of triangles.

mod stages;
mod timed;

use std::time::Duration;

use triptych_spec::scene::Scene;
use triptych_spec::vertex::{Polygons, Position, Primitives};

use crate::context::Gpu;
use crate::error::GpuError;
use crate::kernel::Kernels;
use stages::Stages;
pub use timed::Timed;

/// Triangles of one batch: their slots take 72 MiB, within the 128 MiB that
/// WebGPU lets every kernel bind.
const TRIANGLES: usize = 1 << 19;

/// What a device exceeds that clips a triangle to more corners than six planes can.
pub const CLIPPED: &str = "corners of a clipped triangle";

/// What exceeds 32 bits where a scene has too many triangles.
const CORNERS: &str = "corners of all triangles";

/// Another leg's results in place of the stages before one.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Given<'a> {
    /// None: `transform` is first.
    #[default]
    Nothing,
    /// Homogeneous pixels, one for each of [`Scene::vertices`]: `clip` is first.
    Positions(&'a [Position<f32>]),
    /// Polygons of at most [`triptych_spec::vertex::CORNERS_MAX`] corners, one for each of
    /// [`Scene::triangles`]: `snap` is first.
    Polygons(&'a Polygons<f32>),
}

/// What the device made of a scene's vertices.
#[derive(Clone, Debug, PartialEq)]
pub struct VertexRun {
    /// After `transform`: homogeneous pixels, one for each of [`Scene::vertices`]; empty
    /// if it did not run.
    pub positions: Vec<Position<f32>>,
    /// After `clip`, if it ran and whoever ran it wants to see them.
    pub polygons: Option<Polygons<f32>>,
    /// After `snap`.
    pub primitives: Primitives,
    /// Time of each stage.
    pub times: Times,
}

/// Time of each stage on the device, without transfers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Times {
    /// Stage transform.
    pub transform: Duration,
    /// Stage clip.
    pub clip: Duration,
    /// Stage snap.
    pub snap: Duration,
}

/// Runs the vertex stages of a scene, from the first one whose input is not given. With
/// `show` the clipped polygons are read back as well, which later stages do not need.
///
/// # Errors
/// Limits by name, WGSL errors, and whatever the device reports.
pub fn run(
    gpu: &Gpu,
    kernels: &Kernels,
    scene: &Scene,
    bits: u32,
    given: Given<'_>,
    show: bool,
) -> Result<VertexRun, GpuError> {
    let stages = Stages::new(gpu, kernels, scene, bits, TRIANGLES)?;
    in_batches(stages, scene, given, show)
}

fn in_batches(
    mut stages: Stages<'_>,
    scene: &Scene,
    given: Given<'_>,
    show: bool,
) -> Result<VertexRun, GpuError> {
    let mut positions = Vec::new();
    match given {
        Given::Nothing => positions = stages.transform(scene)?,
        Given::Positions(given) => stages.place(given)?,
        Given::Polygons(_) => {}
    }
    let mut primitives = Primitives {
        samples: scene.samples,
        size: scene.size,
        bits: stages.frame.bits,
        snapped: Vec::new(),
        prims: Vec::new(),
        source: Vec::new(),
    };
    let clips = !matches!(given, Given::Polygons(_));
    let mut polygons = (show && clips).then(|| Polygons {
        offsets: vec![0],
        corners: Vec::new(),
    });
    for (number, triangles) in scene.triangles.chunks(stages.batch).enumerate() {
        let base = primitives.snapped.len();
        let first = number * stages.batch;
        let counts = match given {
            Given::Polygons(given) => stages.fill(given, first, triangles.len())?,
            _ => stages.clip(triangles)?,
        };
        if let Some(polygons) = &mut polygons {
            stages.read_polygons(&counts, polygons)?;
        }
        let offsets = append_fans(&mut primitives, first, base, &counts)
            .ok_or_else(|| stages.limit(CORNERS, u64::MAX, u64::from(u32::MAX)))?;
        primitives.snapped.extend(stages.snap(&offsets)?);
    }
    Ok(VertexRun {
        positions,
        polygons,
        primitives,
        times: stages.times,
    })
}

/// Appends the fans of a batch whose first triangle and first corner are given, and
/// tells where in the batch's corners each triangle's begin, and where all end.
/// `None` if a corner's row exceeds 32 bits.
fn append_fans(
    primitives: &mut Primitives,
    first: usize,
    base: usize,
    counts: &[u32],
) -> Option<Vec<u32>> {
    let base = u32::try_from(base).ok()?;
    let mut offsets = vec![0_u32];
    let mut at = 0_u32;
    for (source, &count) in (u32::try_from(first).ok()?..).zip(counts) {
        let start = base.checked_add(at)?;
        let end = start.checked_add(count)?;
        for corner in start.saturating_add(2)..end {
            primitives.prims.push([start, corner - 1, corner]);
            primitives.source.push(source);
        }
        at += count;
        offsets.push(at);
    }
    Some(offsets)
}

#[cfg(test)]
mod tests;
