//! The GPU legs of one scene: every adapter and path.

use triptych_gpu::error::GpuError;
use triptych_gpu::raster::Path;
use triptych_gpu::vertex::CLIPPED;
use triptych_spec::raster::Fragment;
use triptych_spec::vertex::Primitives;

use super::gpu::{Adapter, Broken, Drawn, From, GpuLeg, Vertices};
use super::run::Run;
use super::spec::SpecRun;
use super::stop::Stop;
use super::vertex::{self, VertexLeg};
use super::{end_to_end, hardware, layouts, own_vertices, rivals, skips, tiles};
use crate::cause::Cause;
use crate::observe::{Observed, Spec};
use crate::row::Class;
use crate::scene::value::Capacity;

impl Run<'_> {
    /// An adapter that was asked for is a leg that failed; another is skipped.
    pub(super) fn broken(&mut self, broken: &Broken) {
        let label = format!("gpu@{}", broken.name);
        let reason = broken.to_string();
        if broken.asked {
            let lost = matches!(broken.error, GpuError::Lost { .. });
            let cause = lost.then_some(Cause::DeviceLost);
            self.rows.fail("leg", "spec", &label, cause, reason);
        } else {
            self.rows.skip("leg", "spec", &label, Class::Exact, reason);
        }
    }

    pub(super) fn leg(&mut self, adapter: &Adapter, path: Path) -> Result<(), Stop> {
        if path == Path::Native && adapter.native.is_none() {
            let label = adapter.label(path);
            let stands_in = self.options.paths.contains(&Path::Compute);
            let reason = match stands_in {
                true => "no 64-bit integers: compute takes its place",
                false => "no 64-bit integers",
            };
            self.rows
                .skip("leg", "spec", &label, Class::Exact, reason.to_owned());
            return Ok(());
        }
        let fragment = path == Path::Fragment;
        if let Some(foreign) = adapter.foreign.iter().find(|f| !f.serves(fragment)) {
            let label = adapter.label(path);
            let rasteriser = if fragment { "the hardware's" } else { "our" };
            let stage = foreign.stage.name;
            let reason = format!(
                "{} has no kernel of stage {stage} for {rasteriser} rasteriser",
                foreign.file
            );
            self.rows.skip("leg", "spec", &label, Class::Exact, reason);
            return Ok(());
        }
        let label = adapter.label(path);
        let samples = match self.samples(adapter, path) {
            Ok(Drawn::With(samples)) => samples,
            Ok(Drawn::Not(reason)) => {
                self.rows.skip("leg", "spec", &label, Class::Exact, reason);
                return Ok(());
            }
            Err(error) => {
                self.rows
                    .fail("leg", "spec", &label, None, error.to_string());
                return Ok(());
            }
        };
        let spec = self.spec_with(adapter.bits(path), samples)?;
        if self.options.vertex == Vertices::Hardware {
            let (scene, budget) = (&self.loaded.scene, self.vertex_budget());
            if let Err(error) = hardware::run(adapter, path, scene, budget, &mut self.rows) {
                self.refused("cover", &label, &spec.value, &error);
            }
            return Ok(());
        }
        match self.leg_or_error(&spec, adapter, path) {
            Ok(dumped) => dumped.map_err(Stop::Dump),
            Err(error) => {
                self.refused("leg", &label, &spec.value, &error);
                Ok(())
            }
        }
    }

    /// Notes what kept a device from a result: a limit is a reason to skip only if the
    /// spec's own counts say that the scene exceeds it.
    fn refused(&mut self, stage: &str, label: &str, spec: &SpecRun, error: &GpuError) {
        let cause = match error {
            GpuError::Limit { what, limit, .. } if exceeds(spec, what, *limit) => {
                let reason = error.to_string();
                self.rows.skip(stage, "spec", label, Class::Exact, reason);
                return;
            }
            // What a device has left is no number of the scene's.
            GpuError::Memory { .. } => {
                let reason = error.to_string();
                self.rows.skip(stage, "spec", label, Class::Exact, reason);
                return;
            }
            GpuError::Limit { what: CLIPPED, .. } => Some(Cause::Vertex),
            GpuError::Limit { .. } => Some(Cause::Overflow),
            GpuError::Lost { .. } => Some(Cause::DeviceLost),
            GpuError::Endless { .. } => Some(Cause::Cycle),
            _ => None,
        };
        let reason = error.to_string();
        self.rows.fail(stage, "spec", label, cause, reason);
    }

    fn leg_or_error(
        &mut self,
        spec: &Observed<Spec, SpecRun>,
        adapter: &Adapter,
        path: Path,
    ) -> Result<std::io::Result<()>, GpuError> {
        let (scene, plan) = (&self.loaded.scene, self.plan.clone());
        let moved = self.moved(spec, adapter, path)?;
        let from_own = self.options.from < From::Cover;
        let leg = GpuLeg {
            adapter,
            path,
            scene,
            spec: moved.as_ref().filter(|_| from_own).unwrap_or(spec),
            plan: &plan,
            capacity: self.capacity(&spec.value),
            from: self.options.from,
        };
        let spots = self.rows.spots.len();
        let seen = leg.run(&mut self.rows)?;
        rivals::run(&leg, self.options.rivals, &mut self.rows)?;
        tiles::run(&leg, self.options.rivals, &mut self.rows)?;
        layouts::run(&leg, self.options.rivals, &mut self.rows)?;
        if let Some(moved) = moved.as_ref().filter(|_| !from_own && !leg.by_band()) {
            // Whatever the leg was handed before, this run takes nothing but vertices.
            let leg = GpuLeg {
                spec: moved,
                from: From::Cover,
                ..leg
            };
            end_to_end::run(&leg, spec, &mut self.rows)?;
        }
        if self.options.vertex == Vertices::Gpu {
            own_vertices::run(&leg, spec, &seen, &mut self.rows);
        }
        if self.tests_skipping(adapter, path) {
            let saved = skips::run(&leg, &seen, &mut self.rows)?;
            self.saved.extend(saved.map(|ms| (leg.label(), ms)));
        }
        if self.options.pictures {
            self.keep(&leg, &seen, spots);
        }
        Ok(self.dump_gpu(&leg.spec.value, &seen))
    }

    /// The spec's later stages on the GPU's own vertices, where these are wanted and
    /// differ from the spec's.
    fn moved(
        &mut self,
        spec: &Observed<Spec, SpecRun>,
        adapter: &Adapter,
        path: Path,
    ) -> Result<Option<Observed<Spec, SpecRun>>, GpuError> {
        let own = match self.vertices(spec, adapter, path) {
            Err(lost @ GpuError::Lost { .. }) => return Err(lost),
            Err(error) => {
                let label = adapter.label(path);
                let failed = vertex::stage_of(&error, self.options.from);
                for stage in vertex::STAGES {
                    if stage == failed {
                        self.refused(stage, &label, &spec.value, &error);
                    } else {
                        let reason = format!("the vertex stages did not finish, see {failed}");
                        let rows = &mut self.rows;
                        rows.skip(stage, "spec", &label, Class::Interval, reason);
                    }
                }
                None
            }
            Ok(own) => own,
        };
        let Some(own) = own else {
            return Ok(None);
        };
        let own = Primitives {
            samples: spec.value.primitives.samples,
            ..own
        };
        match SpecRun::new(&self.loaded.scene, own, &self.plan) {
            Ok(run) => Ok(Some(Observed::new("spec", run))),
            Err(message) => {
                let label = adapter.label(path);
                self.rows
                    .fail("end to end", "spec", &label, Some(Cause::Vertex), message);
                Ok(None)
            }
        }
    }

    /// The GPU's own vertex stages, compared with the spec's. They are the same for all
    /// paths, so they are judged on the compute path, which takes the finest grid; on
    /// each if its lists are to follow from them. The triangles are given back where they
    /// are wanted and differ.
    fn vertices(
        &mut self,
        spec: &Observed<Spec, SpecRun>,
        adapter: &Adapter,
        path: Path,
    ) -> Result<Option<Primitives>, GpuError> {
        let only_path = self.options.paths.len() == 1;
        let followed = self.options.vertex == Vertices::Gpu;
        let judged = path == Path::Compute || only_path || followed;
        let from = self.options.from;
        if !judged && from >= From::Cover {
            return Ok(None);
        }
        let leg = VertexLeg {
            adapter,
            path,
            scene: &self.loaded.scene,
            spec,
            from,
            budget: self.vertex_budget(),
        };
        leg.run(judged.then_some(&mut self.rows))
    }

    /// A bare mesh states no budgets.
    fn vertex_budget(&self) -> Option<f64> {
        (!self.loaded.bare).then_some(self.loaded.file.budget.vertex.0)
    }

    fn capacity(&self, spec: &SpecRun) -> Option<u32> {
        match self.loaded.file.abuffer.capacity {
            Capacity::All => None,
            stated => Some(stated.nodes(spec.lists.attempts)),
        }
    }
}

/// Whether a scene's own numbers exceed a limit that a device ran into. What the host
/// sizes by the scene does; what a device counted must be what the spec counts, and
/// is only split down to a row.
fn exceeds(spec: &SpecRun, what: &str, limit: u64) -> bool {
    let width = spec.primitives.size.width;
    let largest = |fragments: &[Fragment]| {
        let mut rows = vec![0_u64; spec.primitives.size.height as usize];
        for f in fragments {
            rows[(f.pixel / width) as usize] += 1;
        }
        rows.into_iter().max().unwrap_or(0)
    };
    match what {
        CLIPPED => false,
        "build" => largest(&spec.sorted.fragments) > limit,
        "cover" => largest(&spec.fragments()) > limit,
        _ => true,
    }
}
