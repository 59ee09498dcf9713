//! `--vertex hardware`: the driver divides, clips and snaps.

use triptych_gpu::error::GpuError;
use triptych_gpu::raster::{self, Path, Rasterizer};
use triptych_spec::scene::Scene;

use super::gpu::Adapter;
use super::own_vertices::ROW;
use super::rows::Rows;
use crate::calibrate::{BITS_MIN, Grid};
use crate::compare::handed::Handed;
use crate::compare::{Judgement, compare};
use crate::observe::{Gpu, Observed, Spec};
use crate::registry::{Chain, stages_of};
use crate::row::Class;

/// Rows of a leg whose driver is handed clip space. Only coverage on the fragment path
/// has an answer; every other stage has a row that says why it has none. `budget` is the
/// share of triangles that may stay unjudged, where one is stated.
///
/// # Errors
/// Whatever the device reports.
pub fn run(
    adapter: &Adapter,
    path: Path,
    scene: &Scene,
    budget: Option<f64>,
    rows: &mut Rows,
) -> Result<(), GpuError> {
    let label = adapter.label(path);
    let nothing = scene.triangles.is_empty();
    for stage in stages_of(Chain::Frame).map(|stage| stage.name) {
        let reason = match (path, stage) {
            (Path::Fragment, "cover") if nothing => "plan: no triangles",
            (Path::Fragment, "cover") => continue,
            (Path::Fragment, "transform" | "clip" | "snap") => {
                "done by the driver (--vertex hardware)"
            }
            (Path::Fragment, _) => "what the driver makes of clip space has no exact lists",
            _ => "--vertex hardware is for the fragment path",
        };
        rows.skip(stage, "spec", &label, Class::Band, reason.to_owned());
    }
    if path != Path::Fragment || nothing {
        return Ok(());
    }
    let handed = Handed::new(scene, step(adapter.grid));
    let Adapter { gpu, kernels, .. } = adapter;
    let rasterizer = Rasterizer::handed(gpu, kernels, scene.size, &handed.triangles)?;
    let covered = raster::cover(&rasterizer)?;
    let spec = Observed::<Spec, _>::new("spec", &handed);
    let seen = Observed::<Gpu, _>::new(label, covered.fragments).taking(covered.time);
    let mut triangles = Judgement::new(Class::Band, "triangles");
    let pairs = compare(&spec, &seen, |handed, seen| {
        let [pairs, judged] = handed.judge(seen);
        triangles = judged;
        pairs
    });
    triangles.admitted_budget = budget;
    rows.add("cover", &spec, &seen, pairs);
    rows.add(
        ROW,
        &spec,
        &Observed::<Gpu, _>::new(seen.label.clone(), ()),
        triangles,
    );
    Ok(())
}

/// One step of a driver's grid, in pixels; of the coarsest where it is unknown.
fn step(grid: Grid) -> f64 {
    let bits = match grid {
        Grid::Bits(bits) => bits,
        Grid::Unknown => BITS_MIN,
    };
    1.0 / f64::from(1_u32 << bits)
}
