//! What came of the stages, and whether it is right.

use triptych_gpu::abuffer::BandResult;
use triptych_gpu::frame::Band;
use triptych_gpu::tiles::{Drawn, Linked, Local};
use triptych_spec::tiles::{Bins, bin, needs_no_lists};
use triptych_spec::vertex::Primitives;

use super::super::gpu::GpuLeg;
use super::super::layouts::fragments;
use super::super::rows::Rows;
use super::part;
use crate::compare::lists::compare_overflowed;
use crate::compare::{self, Judgement, compare};
use crate::observe::{self, Observed};
use crate::row::Class;

impl GpuLeg<'_> {
    /// Bins, lists and their picture; why stages that follow cannot be judged.
    pub(super) fn judge_drawn(&self, drawn: Drawn, rows: &mut Rows) -> Option<&'static str> {
        let seen = Observed::<observe::Gpu, _>::new(self.label(), drawn);
        let bins = "the bins differ, see bin";
        let lists = "the lists differ, see jagged";
        if !self.judge_bins(&seen, rows) {
            self.skip("jagged", Class::Structure, bins, rows);
            self.skip("shade", Class::Interval, bins, rows);
            return Some(bins);
        }
        if !self.judge_jagged(&seen, rows) {
            self.skip("shade", Class::Interval, lists, rows);
            return Some(lists);
        }
        self.judge_shade(&seen, rows);
        None
    }

    /// The spec's bins of a band.
    fn bins(&self, primitives: &Primitives, band: &Band) -> Bins {
        let rows = band.first..band.first + band.rows;
        bin(primitives, rows, |prim| !self.spec.value.is_opaque(prim))
    }

    /// Whether all bins are right: what follows from others says nothing of later stages.
    fn judge_bins(&self, seen: &Observed<observe::Gpu, Drawn>, rows: &mut Rows) -> bool {
        let spec = self.spec.derive(&self.spec.value.primitives);
        let gpu = seen.map(|s| &s.bins).taking(seen.value.times.bin);
        let judgement = compare(&spec, &gpu, |primitives, bins| {
            Judgement::sum(bins.iter().map(|(band, offsets, prims)| {
                compare::tiles::bins(&self.bins(primitives, band), offsets, prims)
            }))
        });
        let agrees = judgement.differ() == 0;
        rows.add("bin", &spec, &gpu, judgement);
        agrees
    }

    /// Lists as they were filled; whether they are right.
    fn judge_jagged(&self, seen: &Observed<observe::Gpu, Drawn>, rows: &mut Rows) -> bool {
        let spec = self.spec.derive(&self.spec.value.sorted);
        let gpu = seen.map(|s| &s.bands).taking(seen.value.times.jagged);
        let judgement = compare(&spec, &gpu, |spec, bands| {
            let filled =
                |b: &BandResult| compare::lists::compare(&self.expected(spec, b.band), &b.built);
            Judgement::sum(bands.iter().map(filled))
        });
        let agrees = judgement.differ() == 0;
        rows.add("jagged", &spec, &gpu, judgement);
        agrees
    }

    /// The picture, and the lists in order.
    fn judge_shade(&self, seen: &Observed<observe::Gpu, Drawn>, rows: &mut Rows) {
        let spec = self.spec.derive(&self.spec.value);
        let gpu = seen.map(|s| s).taking(seen.value.times.shade);
        let width = self.scene.size.width;
        let judgement = compare(&spec, &gpu, |spec, drawn| {
            let ordered = |b: &BandResult| {
                let sorted = b.sorted.as_ref()?;
                Some(compare::order::compare(
                    &part(&spec.sorted, b, width),
                    sorted,
                    width,
                ))
            };
            let picture = compare::image::compare(&spec.image, &drawn.image, width);
            let ordered = drawn.bands.iter().filter_map(ordered);
            Judgement::sum([picture].into_iter().chain(ordered))
        });
        rows.add("shade", &spec, &gpu, judgement);
    }

    /// The picture without lists in memory, and what is left of them.
    pub(super) fn judge_local(&self, local: Local, rows: &mut Rows) {
        let spec = self.spec.derive(&self.spec.value);
        let gpu = Observed::<observe::Gpu, _>::new(self.label(), local);
        let gpu = gpu.map(|s| s).taking(gpu.value.time);
        let width = self.scene.size.width;
        let judgement = compare(&spec, &gpu, |spec, local| {
            let must = triptych_spec::tiles::local(&spec.sorted, self.scene.samples);
            Judgement::sum([
                compare::image::compare(&spec.image, &local.image, width),
                compare::tiles::digests(&must, &local.digests, width),
                Judgement::sum(local.left.iter().map(|(band, left)| {
                    let bins = self.bins(&spec.primitives, band);
                    let must = needs_no_lists(&bins, &spec.sorted, width);
                    compare::tiles::left(&must, left)
                })),
            ])
        });
        rows.add("local", &spec, &gpu, judgement);
    }

    /// Linked lists by tiles as they were built, in order, and blended.
    pub(super) fn judge_linked(&self, linked: Linked, rows: &mut Rows) {
        let spec = self.spec.derive(&self.spec.value);
        let gpu = Observed::<observe::Gpu, _>::new(self.label(), linked);
        let gpu = gpu.map(|s| s).taking(gpu.value.time);
        let width = self.scene.size.width;
        let judgement = compare(&spec, &gpu, |spec, linked| {
            let built = |b: &BandResult| {
                compare::lists::compare(&self.expected(&spec.sorted, b.band), &b.built)
            };
            let overflowed = linked.overflowed.iter().map(|(band, lists)| {
                let enough = fragments(&spec.sorted, *band, width);
                compare_overflowed(&self.expected(&spec.sorted, *band), lists, enough)
            });
            let built = Judgement::sum(linked.bands.iter().map(built).chain(overflowed));
            if built.differ() > 0 {
                return built;
            }
            let ordered = |b: &BandResult| {
                let must = part(&spec.sorted, b, width);
                Some(compare::order::compare(&must, b.sorted.as_ref()?, width))
            };
            let ordered = linked.bands.iter().filter_map(ordered);
            let picture = compare::image::compare(&spec.image, &linked.image, width);
            Judgement::sum([picture, built].into_iter().chain(ordered))
        });
        rows.add("linked", &spec, &gpu, judgement);
    }
}
