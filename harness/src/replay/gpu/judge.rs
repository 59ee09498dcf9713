//! Each stage of a GPU leg against the spec, from equal inputs.

use std::borrow::Cow;

use triptych_gpu::abuffer;
use triptych_gpu::frame::Band;
use triptych_spec::abuffer::{Lists, Opaque, Sorted};

use super::{From, GpuLeg, GpuSeen};
use crate::cause::Cause;
use crate::compare::lists::compare_overflowed;
use crate::compare::{self, Judgement, compare};
use crate::observe::{self, Observed};
use crate::replay::rows::Rows;
use crate::row::Class;

impl GpuLeg<'_> {
    pub(super) fn judge_opaque(&self, seen: &Observed<observe::Gpu, GpuSeen>, rows: &mut Rows) {
        if let Some(reason) = self.reason_not_run("opaque", From::Opaque) {
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
        let prims = &self.spec.value.primitives;
        let judgement = compare(&spec, &gpu, |a, b| compare::opaque::compare(a, b, prims));
        rows.add("opaque", &spec, &gpu, judgement);
    }

    pub(super) fn judge_lists(&self, seen: &Observed<observe::Gpu, GpuSeen>, rows: &mut Rows) {
        if let Some(reason) = self.reason_not_run("build", From::Build) {
            rows.skip(
                "build",
                &self.spec.label,
                &seen.label,
                Class::Structure,
                reason,
            );
            return;
        }
        let gpu = seen
            .map(|s| &s.abuffer)
            .taking(seen.value.abuffer.times.build);
        let must = self.lists_before(&gpu.value.opaque);
        let spec = self.spec.derive(must.as_ref());
        let spec = spec.taking(self.spec.value.times.build);
        if !gpu.value.overflowed.is_empty() {
            let judgement = compare(&spec, &gpu, |spec, gpu| {
                let judge = |(band, lists): &(Band, Lists)| {
                    let enough = counted(&gpu.bands, *band);
                    compare_overflowed(&self.expected(spec, *band), lists, enough)
                };
                Judgement::sum(gpu.overflowed.iter().map(judge))
            });
            rows.add("overflow", &spec, &gpu, judgement);
        }
        let judgement = compare(&spec, &gpu, |spec, gpu| {
            let judge = |b: &abuffer::BandResult| {
                compare::lists::compare(&self.expected(spec, b.band), &b.built)
            };
            let mut all = Judgement::sum(gpu.bands.iter().map(judge));
            compare::passes::judge(&gpu.passes, &mut all);
            all
        });
        rows.add("build", &spec, &gpu, judgement);
    }

    /// From equal inputs: the lists in front of the opaque surfaces that this leg saw.
    fn lists_before(&self, opaque: &Opaque) -> Cow<'_, Sorted> {
        let spec = &self.spec.value;
        let comparable = opaque.key.len() == spec.opaque.key.len();
        if *opaque == spec.opaque || !self.plan.depth_test || !comparable {
            return Cow::Borrowed(&spec.sorted);
        }
        let prims = &spec.primitives;
        let lists = triptych_spec::abuffer::build(self.scene, prims, opaque, true, u32::MAX);
        Cow::Owned(triptych_spec::abuffer::sort(&lists))
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
            let sorted = bands.iter().filter_map(|band| band.sorted.as_ref());
            let judge = |(must, seen)| compare::order::compare(must, seen, width);
            Judgement::sum(must.iter().zip(sorted).map(judge))
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
        let coloured = |lists: &Lists| {
            let mut nodes = lists.nodes.iter().zip(&lists.colours);
            nodes.all(|(node, colour)| spec.faces.get(node.prim as usize) == Some(colour))
        };
        if !abuffer.bands.iter().all(|b| coloured(&b.built)) {
            let reason = "the nodes hold other colours, see build".to_owned();
            let class = Class::Interval;
            rows.skip("resolve", &self.spec.label, &seen.label, class, reason);
            return;
        }
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
    pub(super) fn reason_not_run(&self, stage: &str, first: From) -> Option<String> {
        let given = self.from > first;
        self.plan
            .skipped(stage)
            .or(given.then(|| From::GIVEN.into()))
    }
}

/// Attempts in the parts of a band, once all of them had room.
fn counted(parts: &[abuffer::BandResult], band: Band) -> u64 {
    let rows = band.first..band.first + band.rows;
    let within = parts.iter().filter(|b| rows.contains(&b.band.first));
    within.map(|b| u64::from(b.built.attempts)).sum()
}
