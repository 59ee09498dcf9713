//! A GPU leg: one adapter, one path, every stage from equal inputs.

mod from;
mod judge;
mod lists;
mod path_name;
mod vertices;

use std::borrow::Cow;
use std::time::Duration;

use triptych_gpu::abuffer::{self, Abuffer, Given};
use triptych_gpu::error::GpuError;
use triptych_gpu::frame::Band;
use triptych_gpu::raster::{self, Path, Rasterizer};
use triptych_spec::abuffer::{Lists, Sorted};
use triptych_spec::scene::Scene;

pub use super::adapter::{Adapter, Adapters, Drawn};
pub use super::broken::Broken;
use super::rows::Rows;
use super::spec::SpecRun;
use crate::calibrate::Grid;
use crate::compare::fragments::Rule;
use crate::compare::lists::{Expected, certify};
use crate::compare::{self, compare};
use crate::observe::{self, Observed};
use crate::plan::Plan;
use crate::row::Class;
pub use from::From;
use lists::join;
pub(super) use lists::{relink, relinked};
pub use path_name::PathName;
pub use vertices::Vertices;

/// One GPU leg of one scene.
pub struct GpuLeg<'a> {
    /// The adapter.
    pub adapter: &'a Adapter,
    /// Who decides coverage.
    pub path: Path,
    /// The scene.
    pub scene: &'a Scene,
    /// The spec's results from the same triangles.
    pub spec: &'a Observed<observe::Spec, SpecRun>,
    /// What runs.
    pub plan: &'a Plan,
    /// Nodes of the first attempt.
    pub capacity: Option<u32>,
    /// Where the GPU takes over.
    pub from: From,
}

/// What a leg saw, for pictures, dumps and further comparisons.
pub struct GpuSeen {
    /// Lists, surfaces, picture.
    pub abuffer: Abuffer,
    /// The sorted lists of the whole target, if sound.
    pub sorted: Option<Sorted>,
    /// Time of all stages on the device.
    pub time: Duration,
}

impl GpuLeg<'_> {
    /// `gpu@adapter/path`.
    pub fn label(&self) -> String {
        self.adapter.label(self.path)
    }

    /// Runs every stage and adds a row for each.
    ///
    /// On a driver whose sub-pixel grid is unknown, only its coverage is compared,
    /// by a band: what follows from other coverage has no exact answer.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn run(&self, rows: &mut Rows) -> Result<Observed<observe::Gpu, GpuSeen>, GpuError> {
        let rasterizer = self.rasterizer()?;
        self.cover(&rasterizer, rows)?;
        if self.by_band() {
            for stage in ["opaque", "build", "sort", "resolve"] {
                let reason = "the driver's sub-pixel grid is unknown".to_owned();
                rows.skip(stage, &self.spec.label, &self.label(), Class::Exact, reason);
            }
            return Ok(Observed::new(self.label(), self.abuffer(&rasterizer)?));
        }
        let seen = Observed::new(self.label(), self.abuffer(&rasterizer)?);
        self.judge_opaque(&seen, rows);
        self.judge_lists(&seen, rows);
        self.judge_sort(&seen, rows);
        self.judge_resolve(&seen, rows);
        Ok(seen)
    }

    /// Runs the A-buffer without comparing it.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn abuffer(&self, rasterizer: &Rasterizer<'_>) -> Result<GpuSeen, GpuError> {
        let spec = &self.spec.value;
        let relinked = (self.from == From::Resolve).then(|| relink(spec));
        let built = (self.from == From::Sort).then_some(&spec.lists);
        let options = abuffer::Options {
            given: (self.from >= From::Build).then_some(Given {
                opaque: &spec.opaque,
                lists: relinked.as_ref().or(built),
                sorted: relinked.is_some(),
            }),
            capacity: self.capacity,
            ..self.plan.abuffer(self.scene)
        };
        let inspect = |_: Band, lists: &Lists| certify(lists).longest();
        let abuffer = abuffer::run(rasterizer, options, |prim| spec.is_opaque(prim), inspect)?;
        let t = abuffer.times;
        let time = t.opaque + t.build + t.sort + t.resolve;
        Ok(GpuSeen {
            sorted: join(&abuffer, self.scene.size.width),
            abuffer,
            time,
        })
    }

    /// The triangles on the device.
    ///
    /// # Errors
    /// More triangles than the adapter can bind.
    pub fn rasterizer(&self) -> Result<Rasterizer<'_>, GpuError> {
        let Adapter {
            gpu,
            kernels,
            native,
            ..
        } = self.adapter;
        let kernels = native
            .as_ref()
            .filter(|_| self.path == Path::Native)
            .unwrap_or(kernels);
        let spec = &self.spec.value;
        Rasterizer::new(gpu, kernels, self.path, &spec.primitives, &spec.faces)
    }

    fn cover(&self, rasterizer: &Rasterizer<'_>, rows: &mut Rows) -> Result<(), GpuError> {
        let needed = self.by_band() && self.from <= From::Cover;
        let reason = self.reason_not_run("cover", From::Cover);
        if let Some(reason) = reason.filter(|_| !needed) {
            rows.skip(
                "cover",
                &self.spec.label,
                &self.label(),
                Class::Exact,
                reason,
            );
            return Ok(());
        }
        let covered = raster::cover(rasterizer)?;
        let must = match self.plan.cover {
            true => Cow::Borrowed(&self.spec.value.cover),
            false => Cow::Owned(self.spec.value.fragments()),
        };
        let spec = self.spec.derive(must.as_slice());
        let spec = spec.taking(self.spec.value.times.cover);
        let seen =
            Observed::<observe::Gpu, _>::new(self.label(), covered.fragments).taking(covered.time);
        let rule = self.rule();
        let judgement = compare(&spec, &seen, |a, b| {
            compare::fragments::compare(a, b, self.scene.size, &rule)
        });
        if self.by_band() && judgement.differ() == 0 && judgement.admitted == judgement.compared {
            let reason = "every fragment lies within a sub-pixel of an edge".to_owned();
            rows.skip("cover", &spec.label, &seen.label, Class::Band, reason);
            return Ok(());
        }
        rows.add("cover", &spec, &seen, judgement);
        Ok(())
    }

    /// Whether the driver's sub-pixel grid matters and is unknown.
    pub fn by_band(&self) -> bool {
        self.path == Path::Fragment && self.adapter.grid == Grid::Unknown
    }

    fn rule(&self) -> Rule<'_> {
        if self.by_band() {
            Rule::Band(&self.spec.value.primitives)
        } else {
            Rule::Exact
        }
    }

    /// What the spec says about a band.
    pub fn expected<'e>(&'e self, sorted: &'e Sorted, band: Band) -> Expected<'e> {
        let width = self.scene.size.width;
        let faces = &self.spec.value.faces;
        Expected {
            sorted,
            first_pixel: band.first * width,
            faces,
            width,
        }
    }
}
