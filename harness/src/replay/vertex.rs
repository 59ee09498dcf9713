//! The GPU's own vertex stage of one scene, and what follows from it.

use std::cmp::Ordering;
use std::time::Duration;

use triptych_gpu::abuffer::{Abuffer, BandResult};
use triptych_gpu::error::GpuError;
use triptych_gpu::raster::Path;
use triptych_gpu::vertex;
use triptych_spec::scene::Scene;
use triptych_spec::vertex::{DEPTH_ONE, GUARD, Primitives, guard_origin};

use super::gpu::{Adapter, GpuLeg, GpuSeen};
use super::rows::Rows;
use super::spec::SpecRun;
use crate::cause::Cause;
use crate::compare::{Judgement, compare, image, lists, opaque, order};
use crate::observe::{Gpu, Observed, Spec};
use crate::row::Class;

/// Runs the vertex stages on the device and, where `rows` is given, compares them.
/// Gives the device's triangles if they differ from the spec's and later stages can
/// start from them. `budget` is the share of triangles that may be admitted.
///
/// # Errors
/// Whatever the device reports.
pub fn run(
    scene: &Scene,
    spec: &Observed<Spec, SpecRun>,
    adapter: &Adapter,
    path: Path,
    budget: Option<f64>,
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
    let usable = is_usable(scene, &own.value);
    if let Some(rows) = rows {
        let mut judgement = compare(spec, &own, |_, own| {
            crate::compare::vertex::compare(scene, bits, own).judgement()
        });
        judgement.admitted_budget = budget;
        let spec = spec.map(|_| ()).taking(spec.value.times.vertex);
        rows.add("vertex", &spec, &own, judgement);
        if !usable {
            let reason = "corners outside the guard rectangle or the depth range".to_owned();
            rows.fail(
                "end to end",
                &spec.label,
                &own.label,
                Some(Cause::Vertex),
                reason,
            );
        }
    }
    let differ = own.value != spec.value.primitives;
    Ok(Some(own.value).filter(|_| usable && differ))
}

/// Whether a device's triangles keep to what every later stage relies on.
fn is_usable(scene: &Scene, own: &Primitives) -> bool {
    let origin = [scene.size.width, scene.size.height].map(guard_origin);
    let inside = |c: &[i32; 3]| {
        let within = |axis: usize| {
            let low = origin[axis] << own.bits;
            (low..=low + (GUARD << own.bits)).contains(&c[axis])
        };
        within(0) && within(1) && (0..=DEPTH_ONE).contains(&c[2])
    };
    let (corners, triangles) = (own.snapped.len(), scene.triangles.len());
    own.snapped.iter().all(inside)
        && own.prims.len() == own.source.len()
        && own.prims.iter().flatten().all(|c| (*c as usize) < corners)
        && own.source.iter().all(|t| (*t as usize) < triangles)
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
        let Abuffer {
            opaque,
            bands,
            image,
            ..
        } = &seen.abuffer;
        let build = |b: &BandResult| lists::compare(&leg.expected(&spec.sorted, b.band), &b.built);
        let sort = |b: &BandResult| {
            let must = triptych_spec::abuffer::sort(&b.built);
            Some(order::compare(&must, b.sorted.as_ref()?, width))
        };
        // The first stage that differs has the cause; what follows from it has none.
        let opaque = opaque::compare(&spec.opaque, opaque, &spec.primitives);
        if opaque.differ() > 0 {
            return opaque;
        }
        let mut lists = Judgement::sum(bands.iter().map(build));
        if let (0, Some(stage)) = (lists.differ(), seen.abuffer.endless) {
            lists.differs(Cause::Cycle, None, || {
                format!("stage {stage} follows a list that does not end")
            });
        }
        if lists.differ() > 0 {
            return lists;
        }
        let order = Judgement::sum(bands.iter().filter_map(sort));
        if order.differ() > 0 {
            return order;
        }
        let image = image::compare(&spec.image, image, width);
        let (class, unit, compared) = (lists.class, lists.unit, lists.compared);
        Judgement {
            class,
            unit,
            compared,
            ..Judgement::sum([lists, opaque, order, image])
        }
    });
    let changed = changed(&own.value, &leg.spec.value);
    judgement.note = format!("cause vertex: moved corners change {changed} fragments");
    rows.add("end to end", leg.spec, &seen, judgement);
    Ok(())
}

/// Fragments of either run that the other lacks, by pixel and source triangle.
fn changed(a: &SpecRun, b: &SpecRun) -> usize {
    let identify = |run: &SpecRun| -> Vec<(u32, u32)> {
        let source = |prim: u32| run.primitives.source[prim as usize];
        let fragments = run.sorted.fragments.iter();
        let mut all: Vec<_> = fragments.map(|f| (f.pixel, source(f.prim))).collect();
        all.sort_unstable();
        all
    };
    let (a, b) = (identify(a), identify(b));
    let (mut i, mut j, mut common) = (0, 0, 0);
    while i < a.len() && j < b.len() {
        match a[i].cmp(&b[j]) {
            Ordering::Less => i += 1,
            Ordering::Greater => j += 1,
            Ordering::Equal => (i, j, common) = (i + 1, j + 1, common + 1),
        }
    }
    a.len() + b.len() - 2 * common
}
