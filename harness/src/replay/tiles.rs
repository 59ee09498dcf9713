//! The same lists by tiles: bins, lists as they lie side by side, picture.

mod judged;
mod nearest;

use triptych_gpu::abuffer::BandResult;
use triptych_gpu::error::GpuError;
use triptych_gpu::raster::{Path, Rasterizer};
use triptych_gpu::tiles;
use triptych_spec::abuffer::{Lists, Sorted};
use triptych_spec::raster::Fragment;
use wgpu::DeviceType;

use super::gpu::{From, GpuLeg};
use super::rows::Rows;
use super::{Extent, names};
use crate::cause::Cause;
use crate::compare;
use crate::row::Class;

/// Most triangles and fragments that a software driver draws by default: with 64-bit integers made of
/// words, and with native ones.
const WORK_MAX: [u64; 2] = [1 << 14, 1 << 17];

/// The stages, their programs, and how each is compared.
const STAGES: [(&str, &str, Class); 5] = [
    ("bin", LISTS, Class::Exact),
    ("jagged", LISTS, Class::Structure),
    ("shade", LISTS, Class::Interval),
    ("local", LOCAL, Class::Interval),
    ("linked", LINKED, Class::Interval),
];

const LISTS: &str = "tiles";
const LOCAL: &str = "local";
const LINKED: &str = "linked";

/// Adds rows for the stages, which start from the spec's triangles and opaque surfaces. They have no twin
/// on the fragment path.
///
/// # Errors
/// Whatever the device reports.
pub fn run(leg: &GpuLeg<'_>, extent: Extent, rows: &mut Rows) -> Result<(), GpuError> {
    run_only(&[LISTS, LOCAL, LINKED], leg, extent, rows)
}

/// Adds rows for the stages of these programs, or of their variants for several samples.
///
/// # Errors
/// Whatever the device reports.
pub fn run_only(
    files: &[&str],
    leg: &GpuLeg<'_>,
    extent: Extent,
    rows: &mut Rows,
) -> Result<(), GpuError> {
    if leg.path == Path::Fragment {
        return Ok(());
    }
    let has = |file: &str| names(files, file);
    let mut skipped = false;
    for (stage, _, class) in STAGES.into_iter().filter(|(_, file, _)| has(file)) {
        if let Some(reason) = reason_not_run(leg, extent, stage) {
            rows.skip(stage, &leg.spec.label, &leg.label(), class, reason);
            skipped = true;
        }
    }
    match skipped {
        true => Ok(()),
        false => leg.tiles(&leg.rasterizer()?, has, rows),
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
    fn tiles(
        &self,
        rasterizer: &Rasterizer<'_>,
        has: impl Fn(&str) -> bool,
        rows: &mut Rows,
    ) -> Result<(), GpuError> {
        let options = tiles::Options {
            opaque: &self.spec.value.opaque,
            depth_test: self.plan.depth_test,
            background: self.scene.background,
            capacity: self.capacity,
            drawn: tiles::DRAWN,
        };
        let first = rows.rows.len();
        let mut because = None;
        if has(LISTS) {
            because = match self.done("jagged", tiles::run(rasterizer, options), rows)? {
                None => Some("there are no lists, see jagged"),
                Some(drawn) => self.judge_drawn(drawn, rows),
            };
        }
        for stage in [LOCAL, LINKED].into_iter().filter(|stage| has(stage)) {
            if let Some(reason) = because {
                self.skip(stage, Class::Interval, reason, rows);
            } else if stage == LOCAL {
                let local = self.done(stage, tiles::run_local(rasterizer, options), rows)?;
                local
                    .into_iter()
                    .for_each(|local| self.judge_local(local, rows));
            } else {
                let linked = tiles::run_linked(rasterizer, options, longest);
                let linked = self.done(stage, linked, rows)?;
                linked
                    .into_iter()
                    .for_each(|linked| self.judge_linked(linked, rows));
            }
        }
        // What a picture of all layers shows would show again.
        if rows.rows[first..].iter().any(|row| row.differ > 0) {
            return Ok(());
        }
        self.judge_nearest(rasterizer, options, has, rows)
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
}

/// Fragments of the longest list; `None` if links lead astray.
pub(crate) fn longest(lists: &Lists) -> Option<u32> {
    Some(compare::order::flatten(lists)?.longest())
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
