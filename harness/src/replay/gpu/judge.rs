//! Each stage of a GPU leg against the spec, from equal inputs.

use triptych_gpu::abuffer;
use triptych_gpu::frame::Band;
use triptych_spec::abuffer::{Lists, Sorted};

use super::{From, GpuLeg, GpuSeen};
use crate::cause::Cause;
use crate::compare::lists::compare_overflowed;
use crate::compare::{self, Judgement, compare};
use crate::observe::{self, Observed};
use crate::replay::rows::Rows;
use crate::row::Class;

impl GpuLeg<'_> {
    pub(super) fn judge_opaque(&self, seen: &Observed<observe::Gpu, GpuSeen>, rows: &mut Rows) {
        if let Some(reason) = self.reason_not_run("opaque", From::Cover) {
            rows.skip(
                "opaque",
                &self.spec.label,
                &seen.label,
                Class::Exact,
                reason,
            );
            return;
        }
        let spec = self
            .spec
            .map(|s| &s.opaque)
            .taking(self.spec.value.times.opaque);
        let times = seen.value.abuffer.times;
        let gpu = seen.map(|s| &s.abuffer.opaque).taking(times.opaque);
        let width = self.scene.size.width;
        let judgement = compare(&spec, &gpu, |a, b| compare::opaque::compare(a, b, width));
        rows.add("opaque", &spec, &gpu, judgement);
    }

    pub(super) fn judge_lists(&self, seen: &Observed<observe::Gpu, GpuSeen>, rows: &mut Rows) {
        if let Some(reason) = self.reason_not_run("build", From::Cover) {
            rows.skip(
                "build",
                &self.spec.label,
                &seen.label,
                Class::Structure,
                reason,
            );
            return;
        }
        let spec = self
            .spec
            .map(|s| &s.sorted)
            .taking(self.spec.value.times.build);
        let gpu = seen
            .map(|s| &s.abuffer)
            .taking(seen.value.abuffer.times.build);
        if !gpu.value.overflowed.is_empty() {
            let judgement = compare(&spec, &gpu, |spec, gpu| {
                let judge = |(band, lists): &(Band, Lists)| {
                    compare_overflowed(&self.expected(spec, *band), lists)
                };
                Judgement::sum(gpu.overflowed.iter().map(judge))
            });
            rows.add("overflow", &spec, &gpu, judgement);
        }
        let judgement = compare(&spec, &gpu, |spec, gpu| {
            let judge = |b: &abuffer::BandResult| {
                compare::lists::compare(&self.expected(spec, b.band), &b.built)
            };
            Judgement::sum(gpu.bands.iter().map(judge))
        });
        rows.add("build", &spec, &gpu, judgement);
    }

    pub(super) fn judge_sort(&self, seen: &Observed<observe::Gpu, GpuSeen>, rows: &mut Rows) {
        if let Some(reason) = self.reason_not_run("sort", From::Sort) {
            rows.skip("sort", &self.spec.label, &seen.label, Class::Tie, reason);
            return;
        }
        if let Some(stage) = seen.value.abuffer.endless {
            let reason = format!("stage {stage} follows a list that does not end");
            rows.fail(
                "sort",
                &self.spec.label,
                &seen.label,
                Some(Cause::Cycle),
                reason,
            );
            return;
        }
        if seen.value.abuffer.bands.iter().any(|b| b.sorted.is_none()) {
            let reason = "the lists are damaged, see build".to_owned();
            rows.skip("sort", &self.spec.label, &seen.label, Class::Tie, reason);
            return;
        }
        // From equal inputs: the spec sorts what this leg built.
        let sorted = |b: &abuffer::BandResult| triptych_spec::abuffer::sort(&b.built);
        let must: Vec<Sorted> = seen.value.abuffer.bands.iter().map(sorted).collect();
        let spec = self.spec.derive(must).taking(self.spec.value.times.sort);
        let gpu = seen
            .map(|s| &s.abuffer.bands)
            .taking(seen.value.abuffer.times.sort);
        let width = self.scene.size.width;
        let judgement = compare(&spec, &gpu, |must, bands| {
            Judgement::sum(must.iter().zip(bands.iter()).map(|(must, band)| {
                let flat = band.sorted.as_ref().and_then(compare::order::flatten);
                compare::order::compare(must, flat.as_ref(), width)
            }))
        });
        rows.add("sort", &spec, &gpu, judgement);
    }

    pub(super) fn judge_resolve(&self, seen: &Observed<observe::Gpu, GpuSeen>, rows: &mut Rows) {
        let Some(sorted) = &seen.value.sorted else {
            let reason = "the lists are damaged, see build".to_owned();
            rows.skip(
                "resolve",
                &self.spec.label,
                &seen.label,
                Class::Interval,
                reason,
            );
            return;
        };
        // From equal inputs: the spec blends what this leg sorted.
        let spec = &self.spec.value;
        let abuffer = &seen.value.abuffer;
        let must = if *sorted == spec.sorted && abuffer.opaque == spec.opaque {
            spec.image.clone()
        } else {
            let prims = &spec.primitives;
            triptych_spec::abuffer::resolve(self.scene, prims, &abuffer.opaque, sorted)
        };
        let spec = self.spec.derive(must).taking(spec.times.resolve);
        let gpu = seen.map(|s| &s.abuffer.image).taking(abuffer.times.resolve);
        let width = self.scene.size.width;
        let judgement = compare(&spec, &gpu, |a, b| compare::image::compare(a, b, width));
        rows.add("resolve", &spec, &gpu, judgement);
    }

    /// Why a stage has nothing of its own to compare: the plan leaves it out, or the
    /// spec's result stands in for it.
    fn reason_not_run(&self, stage: &str, first: From) -> Option<String> {
        let given = self.from > first;
        self.plan
            .skipped(stage)
            .or(given.then(|| "the spec's result is used (--gpu-from)".into()))
    }
}
