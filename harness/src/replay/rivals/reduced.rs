//! Fragments at a reduced resolution: their lists, and what the full one shows of them.

use triptych_gpu::abuffer::rivals::{Given, Low, Rival, reduce};
use triptych_gpu::abuffer::{self, Abuffer};
use triptych_gpu::error::GpuError;
use triptych_gpu::frame::Band;
use triptych_gpu::raster::{Path, Rasterizer};
use triptych_spec::abuffer::{Lists, Order, Reduced, Reduction, Upsampling};
use triptych_spec::bound::Bounded;
use triptych_spec::scene::Scene;

use super::Picture;
use crate::bench::error::{decibels, psnr};
use crate::compare::lists::{Expected, certify};
use crate::compare::{self, Judgement, compare};
use crate::observe::{Gpu, Observed};
use crate::replay::gpu::{Adapter, GpuLeg, relinked};
use crate::replay::rows::Rows;
use crate::replay::spec::{SpecRun, timed};
use crate::replay::tiles::part;

/// What the spec makes of a reduction.
pub struct Halved {
    /// How far.
    pub reduction: Reduction,
    /// Lists and surfaces at the reduced resolution.
    pub lists: Reduced,
    /// The pictures, by each upsampling.
    pub pictures: [(Upsampling, Picture); 2],
}

impl Halved {
    /// Of a scene whose triangles and surfaces are known.
    pub(super) fn of(reduction: Reduction, scene: &Scene, spec: &SpecRun) -> Self {
        let (lists, building) = timed(|| reduction.lists(scene, &spec.primitives));
        let picture = |upsampling| {
            let how = (reduction, upsampling);
            let show = || {
                triptych_spec::abuffer::reduced(scene, &spec.primitives, &spec.opaque, &lists, how)
            };
            let (image, time) = timed(show);
            let time = building + time;
            (upsampling, Picture { image, time })
        };
        let pictures = [Upsampling::Nearest, Upsampling::Joint].map(picture);
        Self {
            reduction,
            pictures,
            lists,
        }
    }

    /// Fragments of one resolution and the other, as nodes with colours; how far each picture is from that
    /// of all fragments.
    fn saved(&self, spec: &SpecRun) -> String {
        let bytes = |fragments: usize| fragments as u64 * abuffer::NODE;
        let [few, all] = [&self.lists.sorted, &spec.sorted].map(|s| bytes(s.fragments.len()));
        let far = |image: &[[Bounded; 3]]| {
            let values = image.iter().map(|pixel| pixel.map(|c| c.value));
            decibels(psnr(&spec.image, values).psnr)
        };
        let [(_, nearest), (_, joint)] = &self.pictures;
        format!(
            "{few} bytes of nodes, not {all}; nearest {} dB, joint {} dB",
            far(&nearest.image),
            far(&joint.image)
        )
    }
}

impl GpuLeg<'_> {
    /// Adds rows: lists of the reduced resolution, where our rasteriser draws them; the pictures.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub(super) fn reduced(
        &self,
        stage: &'static str,
        full: &Rasterizer<'_>,
        rows: &mut Rows,
    ) -> Result<(), GpuError> {
        let spec = &self.spec.value;
        let Some(must) = spec.rivals.reduced(self.scene, spec) else {
            return Ok(());
        };
        // Hardware has no grid as fine as that of the reduced pixels.
        let path = match self.path {
            Path::Fragment => Path::Compute,
            path => path,
        };
        let Adapter {
            kernels, native, ..
        } = self.adapter;
        let kernels = native
            .as_ref()
            .filter(|_| path == Path::Native)
            .unwrap_or(kernels);
        let (gpu, faces) = (&self.adapter.gpu, &spec.faces);
        let low = Rasterizer::new(gpu, kernels, path, &must.lists.primitives, faces)?;
        if self.path == path && !self.judge_reduced_lists(stage, must, &low, rows)? {
            return Ok(());
        }
        let given = Given {
            opaque: &spec.opaque,
            background: self.scene.background,
        };
        let lists = relinked(&must.lists.sorted, faces);
        let low = Low {
            rasterizer: &low,
            opaque: &must.lists.opaque,
            lists: &lists,
            layers: must.lists.sorted.longest(),
        };
        let seen: [Rival; 2] = reduce(full, low, given, must.reduction)?;
        for ((_, must), seen) in must.pictures.iter().zip(seen) {
            self.judge_picture(stage, must, seen, rows);
        }
        Ok(())
    }

    /// Surfaces and lists of the reduced resolution, from the same triangles; whether they agree.
    fn judge_reduced_lists(
        &self,
        stage: &'static str,
        must: &Halved,
        low: &Rasterizer<'_>,
        rows: &mut Rows,
    ) -> Result<bool, GpuError> {
        let spec = &self.spec.value;
        let options = abuffer::Options {
            given: None,
            capacity: None,
            opaque: true,
            lists: true,
            depth_test: true,
            order: Order::Centroid,
            once: false,
            background: self.scene.background,
        };
        let inspect = |_: Band, lists: &Lists| certify(lists).longest();
        let built = abuffer::run(low, options, |prim| spec.is_opaque(prim), inspect)?;
        let time = built.times.opaque + built.times.build + built.times.sort;
        let seen = Observed::<Gpu, Abuffer>::new(self.label(), built).taking(time);
        let own = self
            .spec
            .derive(&must.lists)
            .taking(must.pictures[0].1.time);
        let mut judgement = compare(&own, &seen, |must, seen| {
            let width = must.primitives.size.width;
            let surfaces = compare::opaque::compare(&must.opaque, &seen.opaque, &must.primitives);
            let bands = seen.bands.iter().map(|band| {
                let expected = Expected {
                    sorted: &must.sorted,
                    first_pixel: band.band.first * width,
                    faces: &spec.faces,
                    width,
                };
                let built = compare::lists::compare(&expected, &band.built);
                let sorted = band.sorted.as_ref();
                let sorted = sorted.map(|lists| {
                    compare::order::compare(&part(&must.sorted, band, width), lists, width)
                });
                Judgement::sum([built].into_iter().chain(sorted))
            });
            Judgement::sum([surfaces].into_iter().chain(bands))
        });
        let agrees = judgement.differ() == 0;
        if agrees {
            judgement.note = must.saved(spec);
        }
        rows.add(stage, &own, &seen, judgement);
        Ok(agrees)
    }
}
