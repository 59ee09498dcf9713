//! Skipping, tested differentially: the same leg with and without it.

use triptych_gpu::error::GpuError;
use triptych_gpu::raster;
use triptych_spec::abuffer::Sorted;

use super::gpu::{GpuLeg, GpuSeen};
use super::rows::Rows;
use crate::cause::Cause;
use crate::compare::fragments::at;
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
        judgement.differs(Cause::CorruptLink, None, || {
            "damaged lists, see build".into()
        });
        return judgement;
    };
    let images = skipped.abuffer.image.iter().zip(&full.abuffer.image);
    for (pixel, (x, y)) in (0_u32..).zip(images) {
        judgement.compared += 1;
        if x.map(f32::to_bits) != y.map(f32::to_bits) {
            judgement.differs(Cause::BlendRounding, Some(pixel), || {
                format!("{} is {x:?} with skipping, {y:?} without", at(pixel, width))
            });
        }
        let end = full.abuffer.opaque.key[pixel as usize];
        let (a, b) = (list(a, pixel), list(b, pixel));
        let visible = b.iter().take_while(|f| f.key < end).count();
        if *a != b[..visible] {
            judgement.differs(Cause::LostNode, Some(pixel), || {
                let (a, b) = (words(a), words(&b[..visible]));
                format!("{} holds {a} with skipping, {b} without", at(pixel, width))
            });
        }
    }
    judgement
}

fn list(sorted: &Sorted, pixel: u32) -> &[triptych_spec::raster::Fragment] {
    sorted.list(pixel as usize)
}
