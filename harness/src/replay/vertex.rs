//! The GPU's own vertex stage of one scene, and what follows from it.

use std::collections::BTreeSet;
use std::time::Duration;

use triptych_gpu::error::GpuError;
use triptych_gpu::raster::Path;
use triptych_gpu::vertex;
use triptych_spec::scene::Scene;
use triptych_spec::vertex::Primitives;

use super::gpu::{Adapter, GpuLeg, GpuSeen};
use super::rows::Rows;
use super::spec::SpecRun;
use crate::cause::Cause;
use crate::compare::vertex::VertexReport;
use crate::compare::{self, Judgement, compare};
use crate::observe::{Gpu, Observed, Spec};
use crate::row::Class;

/// Share of corners and triangles that may stay unjudged: branches with too many
/// outcomes, coordinates on which WGSL promises nothing. Such scenes are built for
/// it and are few.
const UNJUDGED_BUDGET: f64 = 0.01;

/// Runs the vertex stages on the device and, where `rows` is given, compares them.
/// Gives the device's triangles if they differ from the spec's.
///
/// # Errors
/// Whatever the device reports.
pub fn run(
    scene: &Scene,
    spec: &Observed<Spec, SpecRun>,
    adapter: &Adapter,
    path: Path,
    rows: Option<&mut Rows>,
) -> Result<Option<Primitives>, GpuError> {
    let label = format!("gpu@{}/{}", adapter.gpu.name, path.name());
    if scene.triangles.is_empty() {
        if let Some(rows) = rows {
            let reason = "plan: no triangles".to_owned();
            rows.skip("vertex", &spec.label, &label, Class::Interval, reason);
        }
        return Ok(None);
    }
    let bits = spec.value.primitives.bits;
    let run = vertex::run(&adapter.gpu, &adapter.kernels, scene, bits)?;
    let time: Duration = run.times.transform + run.times.clip + run.times.snap;
    let own = Observed::<Gpu, _>::new(label, run.primitives).taking(time);
    if let Some(rows) = rows {
        let judgement = compare(spec, &own, |_, own| {
            judge(&compare::vertex::compare(scene, bits, own))
        });
        let spec = spec.map(|_| ()).taking(spec.value.times.vertex);
        rows.add("vertex", &spec, &own, judgement);
    }
    Ok(Some(own.value).filter(|own| *own != spec.value.primitives))
}

fn judge(report: &VertexReport) -> Judgement {
    let figures = &report.figures;
    let mut judgement = Judgement {
        compared: report.corners,
        admitted: report.undecided + figures.unbounded,
        admitted_budget: Some(UNJUDGED_BUDGET),
        error_over_bound: Some(figures.error_over_bound),
        ..Judgement::new(Class::Interval, "corners")
    };
    // Triangles that are clipped away have no corners, and were compared all the same.
    if judgement.compared == 0 {
        judgement.unit = "triangles";
        judgement.compared = report.triangles - report.undecided;
    }
    judgement.note = format!(
        "{} corners moved, by at most {:.3} sub-pixels and {:.0} keys; {} triangles decided \
         either way",
        figures.moved, figures.error_subpixels, figures.error_keys, report.decisions,
    );
    if report.outside > 0 {
        judgement.causes.insert(Cause::Vertex, report.outside);
        judgement.described = report.told.iter().map(|d| format!("{d:?}")).collect();
    }
    if let Some(malformed) = &report.malformed {
        judgement.unexplained = 1;
        judgement.described.push(malformed.clone());
    }
    judgement
}

/// The whole family from the GPU's own vertices: the later stages must equal the
/// spec's later stages on the same vertices. What differs from the spec's own run
/// is what moved vertices change; it is counted, not judged.
///
/// # Errors
/// Whatever the device reports.
pub fn end_to_end(
    leg: &GpuLeg<'_>,
    own: &Observed<Spec, SpecRun>,
    rows: &mut Rows,
) -> Result<(), GpuError> {
    let rasterizer = leg.rasterizer()?;
    let seen = Observed::<Gpu, _>::new(leg.label(), leg.abuffer(&rasterizer)?);
    let seen = seen.map(|s| s).taking(seen.value.time);
    let width = leg.scene.size.width;
    let mut judgement = compare(leg.spec, &seen, |spec, seen: &&GpuSeen| {
        let lists = seen
            .abuffer
            .bands
            .iter()
            .map(|b| compare::lists::compare(&leg.expected(&spec.sorted, b.band), &b.built));
        let lists = Judgement::sum(lists);
        if lists.differ() > 0 {
            return lists;
        }
        let opaque = compare::opaque::compare(&spec.opaque, &seen.abuffer.opaque, width);
        let image = compare::image::compare(&spec.image, &seen.abuffer.image, width);
        let (class, unit, compared) = (lists.class, lists.unit, lists.compared);
        Judgement {
            class,
            unit,
            compared,
            ..Judgement::sum([lists, opaque, image])
        }
    });
    let changed = changed(&own.value, &leg.spec.value);
    judgement.note = format!("cause vertex: moved corners change {changed} fragments");
    rows.add("end to end", leg.spec, &seen, judgement);
    Ok(())
}

/// Fragments of either run that the other lacks, by pixel and source triangle.
fn changed(a: &SpecRun, b: &SpecRun) -> usize {
    let identify = |run: &SpecRun| -> BTreeSet<(u32, u32)> {
        let source = |prim: u32| run.primitives.source[prim as usize];
        run.sorted
            .fragments
            .iter()
            .map(|f| (f.pixel, source(f.prim)))
            .collect()
    };
    identify(a).symmetric_difference(&identify(b)).count()
}
