//! The rivals of the A-buffer, each against its twin in the spec, from the spec's triangles and
//! opaque surfaces.

mod spec;

use triptych_gpu::abuffer::rivals::{self, Given, Rival, Technique, is_wide};
use triptych_gpu::error::GpuError;
use triptych_gpu::raster::{Path, Rasterizer};
use triptych_spec::abuffer::LAYERS_MAX;

use super::gpu::GpuLeg;
use super::rows::Rows;
use crate::compare::{self, compare};
use crate::observe::{Gpu, Observed};
use crate::registry::RIVALS;
use crate::row::Class;
pub use spec::{Layered, Rivals};

/// Adds rows for every rival.
///
/// # Errors
/// Whatever the device reports.
pub fn run(leg: &GpuLeg<'_>, rows: &mut Rows) -> Result<(), GpuError> {
    let mut rasterizer = None;
    for stage in RIVALS {
        if let Some(reason) = reason_not_run(leg, stage) {
            let label = leg.label();
            rows.skip(stage, &leg.spec.label, &label, Class::Exact, reason);
            continue;
        }
        let rasterizer = match &mut rasterizer {
            Some(rasterizer) => rasterizer,
            none => none.insert(leg.rasterizer()?),
        };
        match stage {
            "peel" => peel(leg, rasterizer, Technique::Peel, rows)?,
            "dual" => peel(leg, rasterizer, Technique::Dual, rows)?,
            _ => unreachable!("every rival has its leg"),
        }
    }
    Ok(())
}

/// Why a rival does not run on a leg; `None` if it does.
fn reason_not_run(leg: &GpuLeg<'_>, stage: &str) -> Option<String> {
    let spec = &leg.spec.value;
    let peels = matches!(stage, "peel" | "dual");
    let planned = leg.plan.skipped(stage);
    let band = || {
        let unknown = "the driver's sub-pixel grid is unknown";
        leg.by_band().then(|| unknown.to_owned())
    };
    let long = || {
        let longest = spec.layers();
        (peels && longest > LAYERS_MAX).then(|| {
            format!("plan: the longest list has {longest} layers, of which {LAYERS_MAX} are peeled at most")
        })
    };
    planned.or_else(band).or_else(long)
}

fn given<'a>(leg: &'a GpuLeg<'_>) -> Given<'a> {
    Given {
        opaque: &leg.spec.value.opaque,
        background: leg.scene.background,
    }
}

/// Every layer to the bit, and the picture inside the spec's bound.
fn peel(
    leg: &GpuLeg<'_>,
    rasterizer: &Rasterizer<'_>,
    technique: Technique,
    rows: &mut Rows,
) -> Result<(), GpuError> {
    let spec = &leg.spec.value;
    let is_opaque = |prim| spec.is_opaque(prim);
    let seen = rivals::peel(rasterizer, technique, given(leg), LAYERS_MAX, is_opaque)?;
    let must = spec.rivals.layered(technique, leg.scene, spec);
    let width = leg.scene.size.width;
    let words = match (technique, leg.path, is_wide(rasterizer)) {
        (Technique::Peel, Path::Native, true) => ", one pass over the triangles each",
        (Technique::Peel, Path::Native, false) => ", two passes each: no 64-bit atomics",
        _ => "",
    };
    let note = format!("{} layers{words}", seen.layers);
    let seen = Observed::<Gpu, Rival>::new(leg.label(), seen);
    let seen = seen.map(|s| s).taking(seen.value.time);
    let must = leg.spec.derive(must).taking(must.time);
    let mut layers = compare(&must, &seen, |a, b| {
        let mut judgement = compare::peeled::compare(&a.sorted, &b.sorted, width);
        compare::passes::judge(&b.passes, &mut judgement);
        judgement
    });
    let sound = layers.differ() == 0;
    if sound {
        layers.note = note;
    }
    let stage = technique.name();
    rows.add(stage, &must, &seen, layers);
    // Other layers give another picture.
    if sound {
        let picture = compare(&must, &seen, |a, b| {
            compare::image::compare(&a.image, &b.image, width)
        });
        rows.add(stage, &must, &seen, picture);
    }
    Ok(())
}
