//! The nearest layers alone, of lists by tiles.

use triptych_gpu::error::GpuError;
use triptych_gpu::raster::{MEMORY, Rasterizer};
use triptych_gpu::tiles::{Banded, Options, Way};

use super::super::gpu::GpuLeg;
use super::super::rows::Rows;
use super::{LINKED, LISTS, LOCAL};
use crate::compare::{self, Judgement, compare};
use crate::observe::{self, Observed};
use crate::row::Class;

/// The stages, their programs, and what a tile does in each.
const STAGES: [(&str, &str, Way); 3] = [
    ("shade", LISTS, Way::Runs),
    ("local", LOCAL, Way::Local),
    ("linked", LINKED, Way::Linked),
];

impl GpuLeg<'_> {
    /// Adds a row for each stage that has a picture: that of some nearest layers alone.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub(super) fn judge_nearest(
        &self,
        rasterizer: &Rasterizer<'_>,
        options: Options<'_>,
        has: impl Fn(&str) -> bool,
        rows: &mut Rows,
    ) -> Result<(), GpuError> {
        let own = &self.spec.value;
        let must = own.rivals.listed(self.scene, own);
        let width = self.scene.size.width;
        let fragments = own.sorted.rows(width);
        for (stage, _, way) in STAGES.into_iter().filter(|(_, file, _)| has(file)) {
            let mut pictures = Vec::new();
            let layers = (way, &[must.layers][..]);
            let made = Banded::new(rasterizer, &options, layers, &fragments, MEMORY)
                .and_then(|made| made.pictures(|_, picture| pictures.push(picture)));
            match made {
                // Bands are of whole tiles, of which a single row may be too much.
                Err(error @ (GpuError::Limit { .. } | GpuError::Memory { .. })) => {
                    let (spec, label) = (&self.spec.label, self.label());
                    rows.skip(stage, spec, &label, Class::Interval, error.to_string());
                    continue;
                }
                made => made?,
            }
            let seen = Observed::<observe::Gpu, _>::new(self.label(), pictures);
            let spec = self.spec.derive(must);
            let mut judgement = compare(&spec, &seen, |must, pictures| {
                let each = |seen: &Vec<_>| compare::image::compare(&must.nearest, seen, width);
                Judgement::sum(pictures.iter().map(each))
            });
            if judgement.differ() == 0 {
                judgement.note = format!("{} nearest layers", must.layers);
            }
            rows.add(stage, &spec, &seen, judgement);
        }
        Ok(())
    }
}
