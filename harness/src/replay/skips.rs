//! Skipping, tested differentially: the same leg with and without it.

use triptych_gpu::error::GpuError;
use triptych_gpu::raster;
use triptych_spec::abuffer::Sorted;
use triptych_spec::raster::Fragment;

use super::gpu::{GpuLeg, GpuSeen};
use super::rows::Rows;
use crate::cause::Cause;
use crate::compare::fragments::at;
use crate::compare::lists::{Fault, certify};
use crate::compare::order::words;
use crate::compare::{Judgement, compare};
use crate::observe::{Gpu, GpuUnskipped, Observed};
use crate::plan::Plan;
use crate::row::Class;

/// Runs the leg again without skipping anything, compares the two, and gives the
/// milliseconds that skipping saved on the device.
///
/// # Errors
/// Whatever the device reports.
pub fn run(
    leg: &GpuLeg<'_>,
    skipped: &Observed<Gpu, GpuSeen>,
    rows: &mut Rows,
) -> Result<Option<f64>, GpuError> {
    let plan = Plan::new(leg.scene, false);
    let everything = GpuLeg {
        plan: &plan,
        capacity: None,
        ..*leg
    };
    let rasterizer = everything.rasterizer()?;
    let seen = everything.abuffer(&rasterizer)?;
    // The stream of all fragments is one of the things that are skipped.
    let stream = raster::cover(&rasterizer)?.time;
    let own_stream = if leg.plan.cover {
        stream
    } else {
        std::time::Duration::ZERO
    };
    let time = seen.time + stream;
    let label = format!("{} --no-skip", leg.label());
    let full = Observed::<GpuUnskipped, _>::new(label, seen).taking(time);
    let skipped = skipped.map(|s| s).taking(skipped.value.time + own_stream);
    let width = leg.scene.size.width;
    if skipped.value.sorted.is_none() {
        let reason = "the lists are damaged, see build".to_owned();
        rows.skip("plan", &skipped.label, &full.label, Class::Exact, reason);
        return Ok(None);
    }
    let judgement = compare(&skipped, &full, |a, b| judge(a, b, width));
    rows.add("plan", &skipped, &full, judgement);
    let saved = time.as_secs_f64() - (skipped.value.time + own_stream).as_secs_f64();
    Ok(Some(saved * 1e3))
}

/// Equal pictures to the bit, and equal lists once what lies at or behind the
/// opaque surface is removed.
fn judge(skipped: &GpuSeen, full: &GpuSeen, width: u32) -> Judgement {
    let mut judgement = Judgement::new(Class::Exact, "pixels");
    let (Some(a), Some(b)) = (&skipped.sorted, &full.sorted) else {
        judge_damage(full, &mut judgement);
        return judgement;
    };
    let images = skipped.abuffer.image.iter().zip(&full.abuffer.image);
    for (pixel, (x, y)) in (0_u32..).zip(images) {
        judgement.compared += 1;
        let end = full.abuffer.opaque.key[pixel as usize];
        let (a, b) = (list(a, pixel), list(b, pixel));
        let visible = b.iter().take_while(|f| f.key < end).count();
        if let Some(cause) = difference(a, &b[..visible]) {
            judgement.differs(cause, Some(pixel), || {
                let (a, b) = (words(a), words(&b[..visible]));
                format!("{} holds {a} with skipping, {b} without", at(pixel, width))
            });
        } else if x.map(f32::to_bits) != y.map(f32::to_bits) {
            // From equal lists only: other lists give another picture.
            judgement.differs(Cause::BlendRounding, Some(pixel), || {
                format!("{} is {x:?} with skipping, {y:?} without", at(pixel, width))
            });
        }
    }
    judgement
}

/// Why two sorted lists of a pixel differ; `None` if they do not.
fn difference(a: &[Fragment], b: &[Fragment]) -> Option<Cause> {
    let ordered = |list: &[Fragment]| {
        let mut list = list.to_vec();
        list.sort_unstable();
        list
    };
    if a == b {
        None
    } else if ordered(a) != ordered(b) {
        Some(Cause::LostNode)
    } else if a.iter().map(|f| f.key).eq(b.iter().map(|f| f.key)) {
        Some(Cause::TieOrder)
    } else {
        Some(Cause::SortOrder)
    }
}

/// Lists that only the run without skipping damages: its certificates say how.
fn judge_damage(full: &GpuSeen, judgement: &mut Judgement) {
    let lists = full
        .abuffer
        .bands
        .iter()
        .map(|b| b.sorted.as_ref().unwrap_or(&b.built));
    let faults = lists.flat_map(|lists| certify(lists).faults);
    for Fault { cause, address, .. } in faults {
        judgement.differs(cause, None, || {
            format!("without skipping a link leads to address {address}")
        });
    }
}

fn list(sorted: &Sorted, pixel: u32) -> &[Fragment] {
    sorted.list(pixel as usize)
}
