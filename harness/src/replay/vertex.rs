//! The GPU's own vertex stages of one scene, each from equal inputs.

use std::time::Duration;

use triptych_gpu::error::GpuError;
use triptych_gpu::raster::Path;
use triptych_gpu::vertex::{self as gpu, CLIPPED, Given};
use triptych_spec::scene::Scene;
use triptych_spec::vertex::{self, DEPTH_ONE, GUARD, Polygons, Position, Primitives, guard_origin};

use super::gpu::{Adapter, From};
use super::rows::Rows;
use super::spec::SpecRun;
use crate::cause::Cause;
use crate::compare::vertex::{compare_clip, compare_snap, compare_transform};
use crate::compare::{Judgement, compare};
use crate::observe::{Gpu, Observed, Spec};
use crate::row::Class;

/// The stages, in the order in which they run.
pub const STAGES: [&str; 3] = ["transform", "clip", "snap"];

/// The vertex stages of one GPU leg.
pub struct VertexLeg<'a> {
    /// The adapter.
    pub adapter: &'a Adapter,
    /// The path that its triangles are for.
    pub path: Path,
    /// The scene.
    pub scene: &'a Scene,
    /// The spec's own run.
    pub spec: &'a Observed<Spec, SpecRun>,
    /// Where the GPU takes over.
    pub from: From,
    /// Share of vertices or triangles that may be admitted, where one is stated.
    pub budget: Option<f64>,
}

/// What the stages started from, and what they gave.
struct Seen {
    positions: Vec<Position<f32>>,
    polygons: Polygons<f32>,
    primitives: Primitives,
    times: gpu::Times,
}

impl VertexLeg<'_> {
    /// Runs the stages on the device and, where `rows` is given, compares each. Gives the
    /// device's triangles if they differ from the spec's and later stages can start from
    /// them.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn run(&self, rows: Option<&mut Rows>) -> Result<Option<Primitives>, GpuError> {
        let first = self
            .from
            .vertex()
            .filter(|_| !self.scene.triangles.is_empty());
        let Some(first) = first else {
            if let Some(rows) = rows {
                let reason = match self.scene.triangles.is_empty() {
                    true => "plan: no triangles",
                    false => From::GIVEN,
                };
                for stage in STAGES {
                    self.skip(stage, reason, rows);
                }
            }
            return Ok(None);
        };
        let seen = self.on_device(first, rows.is_some())?;
        let seen = Observed::<Gpu, _>::new(self.label(), seen);
        let usable = is_usable(self.scene, &seen.value.primitives);
        if let Some(rows) = rows {
            self.judge(first, &seen, rows);
            if !usable {
                let reason = "corners outside the guard rectangle or the depth range".to_owned();
                let (spec, label) = (&self.spec.label, &seen.label);
                rows.fail("end to end", spec, label, Some(Cause::Vertex), reason);
            }
        }
        let own = seen.value.primitives;
        let differ = own != self.spec.value.primitives;
        Ok(Some(own).filter(|_| usable && differ))
    }

    fn label(&self) -> String {
        self.adapter.label(self.path)
    }

    /// The stages from `first` on; what comes before it is the spec's, rounded to `f32`
    /// once. Both sides of every comparison start from the rounded numbers.
    fn on_device(&self, first: From, show: bool) -> Result<Seen, GpuError> {
        let scene = self.scene;
        let (mut positions, mut polygons) = (Vec::new(), None);
        if first > From::Transform {
            let exact = vertex::transform::<f64>(scene);
            positions = exact.iter().map(rounded).collect();
            polygons = (first > From::Clip).then(|| {
                let exact = vertex::clip(scene, &exact);
                Polygons {
                    corners: exact.corners.iter().map(rounded).collect(),
                    offsets: exact.offsets,
                }
            });
        }
        let given = match &polygons {
            Some(polygons) => Given::Polygons(polygons),
            None if first == From::Clip => Given::Positions(&positions),
            None => Given::Nothing,
        };
        let Adapter { gpu, kernels, .. } = self.adapter;
        let bits = self.spec.value.primitives.bits;
        let run = gpu::run(gpu, kernels, scene, bits, given, show)?;
        let nothing = || Polygons {
            offsets: vec![0],
            corners: Vec::new(),
        };
        Ok(Seen {
            polygons: polygons.or(run.polygons).unwrap_or_else(nothing),
            positions: match first {
                From::Transform => run.positions,
                _ => positions,
            },
            primitives: run.primitives,
            times: run.times,
        })
    }

    /// Holds each stage against the spec's, from what the device had before it.
    fn judge(&self, first: From, seen: &Observed<Gpu, Seen>, rows: &mut Rows) {
        let scene = self.scene;
        let (must, took) = (self.spec.value.times, seen.value.times);
        if first > From::Transform {
            self.skip("transform", From::GIVEN, rows);
        } else {
            let times = [must.transform, took.transform];
            self.add("transform", times, seen, rows, |seen| {
                compare_transform(scene, &seen.positions).judgement()
            });
        }
        if first > From::Clip {
            self.skip("clip", From::GIVEN, rows);
        } else {
            self.add("clip", [must.clip, took.clip], seen, rows, |seen| {
                compare_clip(scene, &seen.positions, &seen.polygons).judgement()
            });
        }
        if let Some(reason) = reason_not_snapped(&seen.value) {
            self.skip("snap", reason, rows);
            return;
        }
        let bits = self.spec.value.primitives.bits;
        self.add("snap", [must.snap, took.snap], seen, rows, |seen| {
            let Seen {
                positions,
                polygons,
                primitives,
                ..
            } = seen;
            compare_snap(scene, bits, positions, polygons, primitives).judgement()
        });
    }

    fn skip(&self, stage: &str, reason: &str, rows: &mut Rows) {
        let (spec, label) = (&self.spec.label, self.label());
        rows.skip(stage, spec, &label, Class::Interval, reason.to_owned());
    }

    fn add(
        &self,
        stage: &str,
        [spec, gpu]: [Duration; 2],
        seen: &Observed<Gpu, Seen>,
        rows: &mut Rows,
        judge: impl FnOnce(&Seen) -> Judgement,
    ) {
        let spec = self.spec.map(|_| ()).taking(spec);
        let gpu = seen.map(|seen| seen).taking(gpu);
        let mut judgement = compare(&spec, &gpu, |(), seen| judge(seen));
        judgement.admitted_budget = self.budget;
        rows.add(stage, &spec, &gpu, judgement);
    }
}

/// Why there is nothing for `snap` to compare.
fn reason_not_snapped(seen: &Seen) -> Option<&'static str> {
    let Primitives { snapped, prims, .. } = &seen.primitives;
    let mut sizes = seen.polygons.offsets.windows(2).map(|w| w[1] - w[0]);
    if sizes.any(|corners| (1..3).contains(&corners)) {
        Some("polygons of one or two corners, see clip")
    } else if seen.polygons.corners.is_empty() && snapped.is_empty() && prims.is_empty() {
        Some("no triangle is left after clipping")
    } else {
        None
    }
}

/// The stage to which an error belongs, of those that the GPU runs. Only too many
/// corners are one stage's alone; anything else is put down to the first.
pub fn stage_of(error: &GpuError, from: From) -> &'static str {
    match (error, from.vertex()) {
        (GpuError::Limit { what: CLIPPED, .. }, _) | (_, Some(From::Clip)) => "clip",
        (_, Some(From::Snap)) => "snap",
        _ => "transform",
    }
}

fn rounded(exact: &Position<f64>) -> Position<f32> {
    #[expect(
        clippy::cast_possible_truncation,
        reason = "the one rounding of what the GPU is given"
    )]
    exact.map(|v| v as f32)
}

/// Whether a device's triangles keep to what every later stage relies on.
fn is_usable(scene: &Scene, own: &Primitives) -> bool {
    let origin = [scene.size.width, scene.size.height].map(guard_origin);
    let inside = |c: &[i32; 3]| {
        let within = |axis: usize| {
            let low = origin[axis] << own.bits;
            (low..=low + (GUARD << own.bits)).contains(&c[axis])
        };
        within(0) && within(1) && (0..=DEPTH_ONE).contains(&c[2])
    };
    let (corners, triangles) = (own.snapped.len(), scene.triangles.len());
    own.snapped.iter().all(inside)
        && own.prims.len() == own.source.len()
        && own.prims.iter().flatten().all(|c| (*c as usize) < corners)
        && own.source.iter().all(|t| (*t as usize) < triangles)
}
