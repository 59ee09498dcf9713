//! The same lists by tiles: bins, lists as they lie side by side, picture.

mod nearest;

use triptych_gpu::abuffer::BandResult;
use triptych_gpu::error::GpuError;
use triptych_gpu::frame::Band;
use triptych_gpu::raster::{Path, Rasterizer};
use triptych_gpu::tiles::{self, Drawn, Linked, Local};
use triptych_spec::abuffer::{Lists, Sorted};
use triptych_spec::raster::Fragment;
use triptych_spec::tiles::{Bins, bin, needs_no_lists};
use triptych_spec::vertex::Primitives;

use wgpu::DeviceType;

use super::Extent;
use super::gpu::{From, GpuLeg};
use super::layouts::fragments;
use super::rows::Rows;
use crate::cause::Cause;
use crate::compare::lists::compare_overflowed;
use crate::compare::{self, Judgement, compare};
use crate::observe::{self, Observed};
use crate::row::Class;

/// Most triangles and fragments that a software driver draws by default: with 64-bit integers made of
/// words, and with native ones.
const WORK_MAX: [u64; 2] = [1 << 14, 1 << 17];

/// The stages, and how each is compared.
const STAGES: [(&str, Class); 5] = [
    ("bin", Class::Exact),
    ("jagged", Class::Structure),
    ("shade", Class::Interval),
    ("local", Class::Interval),
    ("linked", Class::Interval),
];

/// Adds rows for the stages, which start from the spec's triangles and opaque surfaces. They have no twin
/// on the fragment path.
///
/// # Errors
/// Whatever the device reports.
pub fn run(leg: &GpuLeg<'_>, extent: Extent, rows: &mut Rows) -> Result<(), GpuError> {
    if leg.path == Path::Fragment {
        return Ok(());
    }
    let mut skipped = false;
    for (stage, class) in STAGES {
        if let Some(reason) = reason_not_run(leg, extent, stage) {
            rows.skip(stage, &leg.spec.label, &leg.label(), class, reason);
            skipped = true;
        }
    }
    match skipped {
        true => Ok(()),
        false => leg.tiles(&leg.rasterizer()?, rows),
    }
}

/// Why the stages do not run on a leg. Software drivers take their time over them.
fn reason_not_run(leg: &GpuLeg<'_>, extent: Extent, stage: &str) -> Option<String> {
    let spec = &leg.spec.value;
    let work = (spec.primitives.prims.len() + spec.sorted.fragments.len()) as u64;
    let most = match leg.adapter.gpu.info.device_type {
        DeviceType::Cpu => WORK_MAX[usize::from(leg.path == Path::Native)],
        _ => u64::MAX,
    };
    let planned = leg.plan.skipped(stage);
    planned.or_else(|| match extent {
        _ if leg.from > From::Build => Some(From::GIVEN.to_owned()),
        Extent::Small if work > most => {
            Some("of a scene of its size only if asked for: --rivals".to_owned())
        }
        _ => None,
    })
}

impl GpuLeg<'_> {
    fn tiles(&self, rasterizer: &Rasterizer<'_>, rows: &mut Rows) -> Result<(), GpuError> {
        let options = tiles::Options {
            opaque: &self.spec.value.opaque,
            depth_test: self.plan.depth_test,
            background: self.scene.background,
            capacity: self.capacity,
            drawn: tiles::DRAWN,
        };
        let drawn = self.done("jagged", tiles::run(rasterizer, options), rows)?;
        let local = self.done("local", tiles::run_local(rasterizer, options), rows)?;
        let linked = tiles::run_linked(rasterizer, options, longest);
        let linked = self.done("linked", linked, rows)?;
        let because = match drawn {
            None => Some("there are no lists, see jagged"),
            Some(drawn) => self.judge_drawn(drawn, rows),
        };
        let Some(reason) = because else {
            local
                .into_iter()
                .for_each(|local| self.judge_local(local, rows));
            linked
                .into_iter()
                .for_each(|linked| self.judge_linked(linked, rows));
            return self.judge_nearest(rasterizer, options, rows);
        };
        for (stage, is_there) in [("local", local.is_some()), ("linked", linked.is_some())] {
            if is_there {
                self.skip(stage, Class::Interval, reason, rows);
            }
        }
        Ok(())
    }

    fn skip(&self, stage: &'static str, class: Class, reason: &str, rows: &mut Rows) {
        rows.skip(stage, &self.spec.label, &self.label(), class, reason.into());
    }

    /// What came of a stage; `None` if it was given up, which is a result.
    ///
    /// # Errors
    /// What says nothing of it.
    fn done<T>(
        &self,
        stage: &'static str,
        tried: Result<T, GpuError>,
        rows: &mut Rows,
    ) -> Result<Option<T>, GpuError> {
        let error = match tried {
            Ok(done) => return Ok(Some(done)),
            Err(error) => error,
        };
        let cause = match &error {
            GpuError::Endless { .. } => Cause::Cycle,
            GpuError::Limit { what, .. } if *what == stage => Cause::Overflow,
            _ => return Err(error),
        };
        let (spec, label) = (&self.spec.label, self.label());
        rows.fail(stage, spec, &label, Some(cause), error.to_string());
        Ok(None)
    }

    /// Bins, lists and their picture; why stages that follow cannot be judged.
    fn judge_drawn(&self, drawn: Drawn, rows: &mut Rows) -> Option<&'static str> {
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
}

impl GpuLeg<'_> {
    /// The picture without lists in memory, and what is left of them.
    fn judge_local(&self, local: Local, rows: &mut Rows) {
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
    fn judge_linked(&self, linked: Linked, rows: &mut Rows) {
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

/// Fragments of the longest list; `None` if links lead astray.
pub(crate) fn longest(lists: &Lists) -> Option<u32> {
    let flat = compare::order::flatten(lists)?;
    flat.offsets.windows(2).map(|run| run[1] - run[0]).max()
}

/// The spec's lists of a band, with pixels counted from its first.
pub(super) fn part(all: &Sorted, band: &BandResult, width: u32) -> Sorted {
    let first = (band.band.first * width) as usize;
    let end = first + (band.band.rows * width) as usize;
    let before = all.offsets[first];
    let own = before as usize..all.offsets[end] as usize;
    Sorted {
        offsets: all.offsets[first..=end]
            .iter()
            .map(|o| o - before)
            .collect(),
        fragments: all.fragments[own]
            .iter()
            .map(|f| Fragment {
                pixel: f.pixel - band.band.first * width,
                ..*f
            })
            .collect(),
    }
}
