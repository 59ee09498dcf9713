//! The same lists in other layouts, each against the spec's lists and picture.

mod limits;

use triptych_gpu::abuffer::BandResult;
use triptych_gpu::error::GpuError;
use triptych_gpu::frame::Band;
use triptych_gpu::layouts::{Built, Layout, Options, is_wide, run as draw};
use triptych_gpu::raster::{Path, Rasterizer};
use triptych_spec::abuffer::{Lists, Sorted};

use super::gpu::GpuLeg;
use super::rivals::Listed;
use super::rows::Rows;
use super::tiles::part;
use super::{Extent, names};
use crate::cause::Cause;
use crate::compare::lists::{certify, compare_overflowed};
use crate::compare::{self, Judgement, compare};
use crate::observe::{Gpu, Observed};
use crate::row::Class;
use limits::reason_not_run;
pub use limits::{slots, steps, too_many_steps};

/// Adds rows for every layout, which starts from the spec's triangles and opaque surfaces.
///
/// # Errors
/// Whatever the device reports.
pub fn run(leg: &GpuLeg<'_>, extent: Extent, rows: &mut Rows) -> Result<(), GpuError> {
    let files = Layout::ALL.map(Layout::file);
    run_only(&files, leg, extent, rows)
}

/// Adds rows for the layouts of these programs, or of their variants for several samples.
///
/// # Errors
/// Whatever the device reports.
pub fn run_only(
    files: &[&str],
    leg: &GpuLeg<'_>,
    extent: Extent,
    rows: &mut Rows,
) -> Result<(), GpuError> {
    let has = |layout: &Layout| names(files, layout.file());
    let mut rasterizer = None;
    let mut arrays = Vec::new();
    for layout in Layout::ALL.into_iter().filter(has) {
        if let Some(reason) = reason_not_run(leg, extent, layout) {
            let label = leg.label();
            rows.skip(
                layout.name(),
                &leg.spec.label,
                &label,
                Class::Structure,
                reason,
            );
            continue;
        }
        let rasterizer = match &mut rasterizer {
            Some(rasterizer) => rasterizer,
            none => none.insert(leg.rasterizer()?),
        };
        match leg.draw(layout, rasterizer) {
            Err(error) => leg.refused(layout, error, rows)?,
            Ok(built) => {
                let seen = leg.judge_lists_of(layout, built, rasterizer, rows);
                let ranked = matches!(layout, Layout::Bucket | Layout::Precalc);
                arrays.extend(seen.filter(|_| ranked));
            }
        }
    }
    if !has(&Layout::Bucket) {
        return Ok(());
    }
    match arrays.is_empty() {
        true => {
            let reason = reason_not_run(leg, extent, Layout::Bucket);
            let reason = reason.unwrap_or_else(|| "the lists differ, see bucket".to_owned());
            rows.skip("rank", &leg.spec.label, &leg.label(), Class::Tie, reason);
        }
        false => leg.judge_rank(arrays, rows),
    }
    Ok(())
}

impl GpuLeg<'_> {
    fn draw(&self, layout: Layout, rasterizer: &Rasterizer<'_>) -> Result<Built, GpuError> {
        let own = &self.spec.value;
        let options = Options {
            opaque: &own.opaque,
            depth_test: self.plan.depth_test,
            background: self.scene.background,
            capacity: self.capacity,
            arrays: None,
            nearest: &[self.listed(layout).layers],
        };
        let inspect = |lists: &Lists| certify(lists).longest();
        let is_opaque = |prim| own.is_opaque(prim);
        draw(rasterizer, layout, options, is_opaque, inspect)
    }

    /// What the plan has made sure of cannot be a limit.
    ///
    /// # Errors
    /// Whatever it says nothing of.
    fn refused(&self, layout: Layout, error: GpuError, rows: &mut Rows) -> Result<(), GpuError> {
        let (spec, label) = (&self.spec.label, self.label());
        let cause = match &error {
            GpuError::Endless { .. } => Cause::Cycle,
            GpuError::Limit { what, .. } if ["bucket", "ordered"].contains(what) => Cause::Overflow,
            // Which region is fullest depends on how work is shared out.
            GpuError::Limit {
                what: "regions", ..
            } => {
                let reason = error.to_string();
                rows.skip(layout.name(), spec, &label, Class::Structure, reason);
                return Ok(());
            }
            _ => return Err(error),
        };
        rows.fail(layout.name(), spec, &label, Some(cause), error.to_string());
        Ok(())
    }

    /// Compares a layout's lists. Where arrays are put in order, that is another stage; `None` if they
    /// differ, as what follows from others says nothing.
    fn judge_lists_of(
        &self,
        layout: Layout,
        built: Built,
        rasterizer: &Rasterizer<'_>,
        rows: &mut Rows,
    ) -> Option<Observed<Gpu, Built>> {
        let own = &self.spec.value;
        let note = note(layout, &built, rasterizer);
        let time = built.build;
        let seen = Observed::<Gpu, Built>::new(self.label(), built).taking(time);
        let spec = self.spec.derive(&own.sorted).taking(own.times.build);
        let mut judgement = compare(&spec, &seen, |sorted, built| {
            self.lists(layout, sorted, built)
        });
        let agrees = judgement.differ() == 0;
        if agrees {
            judgement.note = note;
        }
        rows.add(layout.name(), &spec, &seen, judgement);
        agrees.then_some(seen)
    }

    /// The lists as they were built; for what has no stage of its own, also their order and the picture.
    fn lists(&self, layout: Layout, sorted: &Sorted, built: &Built) -> Judgement {
        let whole = |band: Band, lists: &Lists| {
            compare::lists::compare(&self.expected(sorted, band), lists)
        };
        let bands = built.bands.iter().map(|b| whole(b.band, &b.built));
        let again = built.again.iter().map(|(band, lists)| whole(*band, lists));
        let overflowed = built.overflowed.iter().map(|(band, lists)| {
            let enough = fragments(sorted, *band, self.scene.size.width);
            compare_overflowed(&self.expected(sorted, *band), lists, enough)
        });
        let mut all = Judgement::sum(bands.chain(again).chain(overflowed));
        compare::passes::judge(&built.passes, &mut all);
        // What follows from other lists says nothing.
        if all.differ() == 0 && !matches!(layout, Layout::Bucket | Layout::Precalc) {
            all = Judgement::sum([all, self.finished(layout, built)]);
        }
        all
    }

    /// Order and picture.
    fn finished(&self, layout: Layout, built: &Built) -> Judgement {
        let own = &self.spec.value;
        let width = self.scene.size.width;
        let ordered = |b: &BandResult| {
            let sorted = b.sorted.as_ref()?;
            let must = part(&own.sorted, b, width);
            Some(compare::order::compare(&must, sorted, width))
        };
        let ordered = built.bands.iter().filter_map(ordered);
        let must = self.listed(layout);
        let picture = compare::image::compare(&must.all, &built.image, width);
        let nearest = built.nearest.iter();
        let nearest = nearest.map(|seen| compare::image::compare(&must.nearest, seen, width));
        Judgement::sum(ordered.chain([picture]).chain(nearest))
    }

    /// What the spec makes of a layout's lists.
    fn listed(&self, layout: Layout) -> &Listed {
        let own = &self.spec.value;
        match layout {
            Layout::Packed => own.rivals.packed(self.scene, own),
            _ => own.rivals.listed(self.scene, own),
        }
    }

    /// Arrays in order, and the pictures that they give.
    fn judge_rank(&self, arrays: Vec<Observed<Gpu, Built>>, rows: &mut Rows) {
        let time = arrays.iter().map(|a| a.value.finish).sum();
        let arrays: Vec<Built> = arrays.into_iter().map(|a| a.value).collect();
        let seen = Observed::<Gpu, _>::new(self.label(), arrays).taking(time);
        let times = self.spec.value.times;
        let spec = self.spec.derive(()).taking(times.sort + times.resolve);
        let judgement = compare(&spec, &seen, |(), arrays| {
            let all = |built: &Built| self.finished(Layout::Bucket, built);
            Judgement::sum(arrays.iter().map(all))
        });
        rows.add("rank", &spec, &seen, judgement);
    }
}

/// Fragments of a band.
pub(super) fn fragments(sorted: &Sorted, band: Band, width: u32) -> u64 {
    let [first, end] = [band.first, band.first + band.rows].map(|row| (row * width) as usize);
    u64::from(sorted.offsets[end] - sorted.offsets[first])
}

/// What is worth knowing of lists that agree.
fn note(layout: Layout, built: &Built, rasterizer: &Rasterizer<'_>) -> String {
    match layout {
        Layout::Bucket => format!(
            "{} entries a pixel, {} ranges of depth",
            built.entries, built.ranges
        ),
        Layout::Packed if !built.again.is_empty() => {
            "two frames, the second without clearing".to_owned()
        }
        Layout::Ordered if is_wide(rasterizer) => "one pass over the triangles".to_owned(),
        Layout::Ordered if rasterizer.path == Path::Native => {
            "two passes over the triangles: no 64-bit atomics".to_owned()
        }
        Layout::Ordered => "two passes over the triangles".to_owned(),
        _ => String::new(),
    }
}
