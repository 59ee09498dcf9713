//! The rivals of the A-buffer, each against its twin in the spec, from the spec's triangles,
//! opaque surfaces and, where it needs them, sorted lists.

mod reduced;
mod spec;

use triptych_gpu::abuffer::rivals::{
    Given, Rival, Shading, Single, Technique, follow, is_wide, once, peel,
};
use triptych_gpu::error::GpuError;
use triptych_gpu::raster::{Path, Rasterizer};
use triptych_spec::abuffer::{LAYERS_MAX, Target};
use triptych_spec::bound::Bounded;

use super::Extent;
use super::gpu::{GpuLeg, relink};
use super::rows::Rows;
use crate::compare::{self, compare};
use crate::observe::{Gpu, Observed};
use crate::registry::RIVALS;
use crate::row::Class;
pub use reduced::Halved;
pub use spec::{Layered, Listed, NEAREST, Picture, Rivals};

/// Most work of a technique on a scene that a default run has it do: its passes over the
/// triangles times triangles and their fragments.
pub const WORK_MAX: u64 = 1 << 20;

/// Adds rows for every rival.
///
/// # Errors
/// Whatever the device reports.
pub fn run(leg: &GpuLeg<'_>, extent: Extent, rows: &mut Rows) -> Result<(), GpuError> {
    run_only(&RIVALS, leg, extent, rows)
}

/// Adds rows for some of them.
///
/// # Errors
/// Whatever the device reports.
pub fn run_only(
    stages: &[&'static str],
    leg: &GpuLeg<'_>,
    extent: Extent,
    rows: &mut Rows,
) -> Result<(), GpuError> {
    let mut rasterizer = None;
    for &stage in stages {
        if let Some(reason) = reason_not_run(leg, extent, stage) {
            let label = leg.label();
            rows.skip(stage, &leg.spec.label, &label, Class::Interval, reason);
            continue;
        }
        let rasterizer = match &mut rasterizer {
            Some(rasterizer) => rasterizer,
            none => none.insert(leg.rasterizer()?),
        };
        leg.rival(stage, rasterizer, rows)?;
    }
    Ok(())
}

/// Whether a technique goes through the triangles once for every layer.
fn peels(leg: &GpuLeg<'_>, stage: &str) -> bool {
    match stage {
        "peel" | "dual" => true,
        // Nothing else blends in order.
        "alpha" => leg.path != Path::Fragment,
        _ => false,
    }
}

/// Why a rival does not run on a leg; `None` if it does.
fn reason_not_run(leg: &GpuLeg<'_>, extent: Extent, stage: &str) -> Option<String> {
    if let Some(planned) = leg.plan.skipped(stage) {
        return Some(planned);
    }
    if leg.by_band() {
        return Some("the driver's sub-pixel grid is unknown".to_owned());
    }
    let blended = matches!(stage, "weighted") && leg.path == Path::Fragment;
    if blended && !leg.adapter.gpu.blends_floats() {
        return Some("the adapter blends no 32-bit floats: compute adds them".to_owned());
    }
    let spec = &leg.spec.value;
    let longest = spec.layers();
    let by_layer = peels(leg, stage) || stage == "defocus";
    if by_layer && longest > LAYERS_MAX {
        return Some(format!(
            "plan: a pixel has {longest} layers, more than the {LAYERS_MAX} that are gone through one by one"
        ));
    }
    let times = if by_layer { u64::from(longest) } else { 1 };
    let each = spec.primitives.prims.len() + spec.sorted.fragments.len();
    if extent == Extent::Small && times * each as u64 > WORK_MAX {
        return Some("of a scene of its size only if asked for: --rivals".to_owned());
    }
    None
}

impl GpuLeg<'_> {
    fn rival(
        &self,
        stage: &'static str,
        rasterizer: &Rasterizer<'_>,
        rows: &mut Rows,
    ) -> Result<(), GpuError> {
        let spec = &self.spec.value;
        let rivals = &spec.rivals;
        let is_opaque = |prim| spec.is_opaque(prim);
        let given = Given {
            opaque: &spec.opaque,
            background: self.scene.background,
        };
        let peeled = |technique| peel(rasterizer, technique, given, LAYERS_MAX, is_opaque);
        let followed = |shading| follow(rasterizer, shading, given, &relink(spec), spec.layers());
        match stage {
            "peel" => {
                let must = rivals.peel(self.scene, spec);
                let seen = peeled(Technique::Peel)?;
                self.judge_layers(stage, must, seen, self.words(rasterizer), rows);
            }
            "dual" => {
                let must = rivals.dual(self.scene, spec);
                self.judge_layers(stage, must, peeled(Technique::Dual)?, "", rows);
            }
            "alpha" if peels(self, stage) => {
                let must = rivals.alpha(Target::Single, self.scene, spec);
                self.judge_picture(stage, must, peeled(Technique::Alpha)?, rows);
            }
            "alpha" => {
                let half = !self.adapter.gpu.blends_floats();
                let target = if half { Target::Half } else { Target::Single };
                let must = rivals.alpha(target, self.scene, spec);
                let seen = once(rasterizer, Single::Alpha { half }, given, is_opaque)?;
                self.judge_picture(stage, must, seen, rows);
            }
            "weighted" => {
                let must = rivals.weighted(self.scene, spec);
                let seen = once(rasterizer, Single::Weighted, given, is_opaque)?;
                self.judge_picture(stage, must, seen, rows);
            }
            "density" => {
                if let Some((sigma, must)) = rivals.density(self.scene, spec) {
                    self.judge_picture(stage, must, followed(Shading::Density(sigma))?, rows);
                }
            }
            "defocus" => {
                if let Some((lens, must)) = rivals.defocus(self.scene, spec) {
                    self.judge_picture(stage, must, followed(Shading::Defocus(lens))?, rows);
                }
            }
            "reduced" => self.reduced(stage, rasterizer, rows)?,
            _ => unreachable!("every rival has its leg"),
        }
        Ok(())
    }

    /// How many passes a layer takes, where that depends on the adapter.
    fn words(&self, rasterizer: &Rasterizer<'_>) -> &'static str {
        match (self.path, is_wide(rasterizer)) {
            (Path::Native, true) => ", one pass over the triangles each",
            (Path::Native, false) => ", two passes each: no 64-bit atomics",
            _ => "",
        }
    }

    /// Every layer to the bit, and the picture inside the spec's bound.
    fn judge_layers(&self, stage: &str, must: &Layered, seen: Rival, words: &str, rows: &mut Rows) {
        let width = self.scene.size.width;
        let note = format!("{} layers{words}", seen.layers);
        let time = seen.time;
        let seen = Observed::<Gpu, Rival>::new(self.label(), seen).taking(time);
        let must = self.spec.derive(must).taking(must.picture.time);
        let mut layers = compare(&must, &seen, |a, b| {
            let mut judgement = compare::peeled::compare(&a.sorted, &b.sorted, b.counted, width);
            compare::passes::judge(&b.passes, &mut judgement);
            judgement
        });
        let sound = layers.differ() == 0;
        if sound {
            layers.note = note;
        }
        rows.add(stage, &must, &seen, layers);
        // Other layers give another picture.
        if sound {
            let image = |a: &&Layered, b: &Rival| {
                compare::image::compare(&a.picture.image, &b.image, width)
            };
            let picture = compare(&must, &seen, image);
            rows.add(stage, &must, &seen, picture);
        }
    }

    /// The picture, inside the spec's bound.
    fn judge_picture(&self, stage: &str, must: &Picture, seen: Rival, rows: &mut Rows) {
        let width = self.scene.size.width;
        let time = seen.time;
        let seen = Observed::<Gpu, Rival>::new(self.label(), seen).taking(time);
        let must = self.spec.derive(must).taking(must.time);
        let judgement = compare(&must, &seen, |a, b| {
            let image: &[[Bounded; 3]] = &a.image;
            let mut judgement = compare::image::compare(image, &b.image, width);
            compare::passes::judge(&b.passes, &mut judgement);
            judgement
        });
        rows.add(stage, &must, &seen, judgement);
    }
}
