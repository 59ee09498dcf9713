//! The nearest layers alone, of lists by tiles.

use triptych_gpu::error::GpuError;
use triptych_gpu::raster::Rasterizer;
use triptych_gpu::tiles::{Options, Timed};

use super::super::gpu::GpuLeg;
use super::super::rows::Rows;
use crate::compare::{self, Judgement, compare};
use crate::observe::{self, Observed};
use crate::row::Class;

/// Sets up a whole target, and pictures of these numbers of layers.
type SetUp =
    for<'r, 'g> fn(&'r Rasterizer<'g>, &Options<'_>, &[u32]) -> Result<Timed<'r, 'g>, GpuError>;

/// The stages, and how each is set up.
const STAGES: [(&str, SetUp); 3] = [
    ("shade", |r, o, n| Timed::new(r, o, n)),
    ("local", |r, o, n| Timed::local(r, o, n)),
    ("linked", |r, o, n| Timed::linked(r, o, n)),
];

impl GpuLeg<'_> {
    /// Adds a row for each stage that has a picture: that of some nearest layers alone.
    ///
    /// # Errors
    /// Whatever the device reports, unless it is that the whole target does not fit at once.
    pub(super) fn judge_nearest(
        &self,
        rasterizer: &Rasterizer<'_>,
        options: Options<'_>,
        rows: &mut Rows,
    ) -> Result<(), GpuError> {
        let own = &self.spec.value;
        let must = own.rivals.listed(self.scene, own);
        let width = self.scene.size.width;
        for (stage, set_up) in STAGES {
            let mut pictures = Vec::new();
            let made = set_up(rasterizer, &options, &[must.layers])
                .and_then(|timed| timed.pictures(|_, picture| pictures.push(picture)));
            match made {
                // Bands are for the picture of all layers.
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
