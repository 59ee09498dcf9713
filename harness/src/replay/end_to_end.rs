//! What follows from the GPU's own vertices.

use std::cmp::Ordering;

use triptych_gpu::abuffer::{Abuffer, BandResult};
use triptych_gpu::error::GpuError;
use triptych_spec::vertex::Primitives;

use super::gpu::{GpuLeg, GpuSeen};
use super::rows::Rows;
use super::spec::SpecRun;
use crate::cause::Cause;
use crate::compare::{Judgement, compare, image, lists, opaque, order};
use crate::observe::{Gpu, Observed, Spec};

/// The whole family from the GPU's own vertices: the later stages must equal the
/// spec's later stages on the same vertices. What differs from the spec's own run
/// is what moved vertices change; it is counted, not judged.
///
/// # Errors
/// Whatever the device reports.
pub fn run(
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
    let moved = moved(&own.value.primitives, &leg.spec.value.primitives);
    let changed = changed(&own.value, &leg.spec.value);
    judgement.note = format!("cause vertex: {moved}; {changed} fragments change");
    rows.add("end to end", leg.spec, &seen, judgement);
    Ok(())
}

/// How far the GPU's corners lie from the spec's, in words.
pub(super) fn moved(spec: &Primitives, own: &Primitives) -> String {
    if (&spec.prims, &spec.source) != (&own.prims, &own.source) {
        return "triangles are clipped otherwise".into();
    }
    let corners = spec.snapped.iter().zip(&own.snapped);
    let apart = corners.map(|(a, b)| a[0].abs_diff(b[0]).max(a[1].abs_diff(b[1])));
    let (count, most) = apart.fold((0_u64, 0), |(count, most), by| {
        (count + u64::from(by > 0), by.max(most))
    });
    let corners = own.snapped.len();
    format!("{count} of {corners} corners on another sub-pixel, {most} away at most")
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
