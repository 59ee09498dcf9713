//! What conforms is inside, what does not is outside.

mod canaries;
mod laws;
mod reports;
mod rules;
mod scenes;
mod twice;
mod whole;

use triptych_gpu::context::{Gpu, adapters};
use triptych_gpu::kernel::Kernels;
use triptych_gpu::vertex::{Given, Times, VertexRun, run};
use triptych_gpu::wgsl::Sources;
use triptych_spec::vertex::{self, Plane, Primitives, clip_triangle};

use super::clip::outcomes;
use super::positions::exact;
use super::*;
use canaries::{DEFECTS, TRANSFORM, patched};
use scenes::{BITS, floor, hub_in_plane, last, random, through_planes};
use whole::whole;

/// Every Vulkan adapter; at least the two software drivers are set up.
fn devices() -> Vec<Gpu> {
    let all = adapters(wgpu::Backends::VULKAN);
    assert!(!all.is_empty(), "no adapter: `./x setup` installs two");
    all.iter()
        .map(|a| Gpu::open(a).expect("a device"))
        .collect()
}

fn run_with(gpu: &Gpu, sources: Sources, scene: &Scene) -> VertexRun {
    let kernels = Kernels::new(sources);
    run(gpu, &kernels, scene, BITS, Given::Nothing, true).expect("the scene is small")
}

/// The spec as if it were a device: every stage starts from what the one before gave,
/// rounded to `f32`.
#[expect(clippy::cast_possible_truncation, reason = "as a device has it")]
fn in_f32(scene: &Scene, bits: u32) -> VertexRun {
    let rounded = |p: &Position<f64>| p.map(|v| v as f32);
    let widened = |p: &Position<f32>| p.map(f64::from);
    let positions: Vec<Position<f32>> = vertex::transform(scene).iter().map(rounded).collect();
    let given: Vec<_> = positions.iter().map(widened).collect();
    let Polygons { offsets, corners } = vertex::clip(scene, &given);
    let corners: Vec<_> = corners.iter().map(rounded).collect();
    let given = Polygons {
        offsets: offsets.clone(),
        corners: corners.iter().map(widened).collect(),
    };
    VertexRun {
        positions,
        polygons: Some(Polygons { offsets, corners }),
        primitives: vertex::snap(scene, &given, bits),
        times: Times::default(),
    }
}

/// Each stage of a run, from equal inputs.
struct Judged {
    transform: TransformReport,
    clip: VertexReport,
    snap: VertexReport,
}

impl Judged {
    fn new(scene: &Scene, run: &VertexRun) -> Self {
        let VertexRun {
            positions,
            primitives,
            ..
        } = run;
        let polygons = run.polygons.as_ref().expect("they were asked for");
        Self {
            transform: compare_transform(scene, positions),
            clip: compare_clip(scene, positions, polygons),
            snap: compare_snap(scene, primitives.bits, positions, polygons, primitives),
        }
    }

    /// The stages that differ.
    fn diverging(&self) -> Vec<&'static str> {
        let differs = |report: &VertexReport| report.judgement().differ() > 0;
        let stages = [
            ("transform", self.transform.outside > 0),
            ("clip", differs(&self.clip)),
            ("snap", differs(&self.snap)),
        ];
        let diverging = stages.into_iter().filter(|(_, differs)| *differs);
        diverging.map(|(stage, _)| stage).collect()
    }
}

#[test]
fn every_device_stays_inside_the_bound() {
    for gpu in devices() {
        let kernels = Kernels::new(Sources::shipped(false));
        let mut worst = [0.0_f64; 3];
        let mut totals = [VertexReport::default(), VertexReport::default()];
        for (name, scene) in random() {
            let at = format!("{} on {}", name, gpu.name);
            let run = run(&gpu, &kernels, &scene, BITS, Given::Nothing, true);
            let Judged {
                transform,
                clip,
                snap,
            } = Judged::new(&scene, &run.expect("the scene is small"));
            assert_eq!(transform.outside, 0, "{at}: {:?}", transform.told);
            assert!(clip.agrees(), "{at}: {:?} {:?}", clip.malformed, clip.told);
            assert!(snap.agrees(), "{at}: {:?} {:?}", snap.malformed, snap.told);
            let figures = [
                transform.error_over_bound,
                clip.figures.error_over_bound,
                snap.figures.error_over_bound,
            ];
            worst = [0, 1, 2].map(|i| worst[i].max(figures[i]));
            totals[0].add(clip);
            totals[1].add(snap);
        }
        assert!(
            worst.iter().all(|w| *w > 0.05),
            "a bound twenty times too wide, of transform, clip or snap: {worst:?}"
        );
        for total in totals {
            assert!(
                total.decisions < total.triangles / 50,
                "mostly certain: {total}"
            );
            assert!(
                total.undecided < total.triangles / 50,
                "mostly decided: {total}"
            );
            assert!(
                total.figures.unbounded < total.corners / 50,
                "mostly bounded: {total}"
            );
            println!("{}: {total}", gpu.name);
        }
    }
}

#[test]
fn a_triangle_on_the_planes_may_be_clipped_either_way() {
    let scene = through_planes();
    for gpu in devices() {
        let run = run_with(&gpu, Sources::shipped(false), &scene);
        let report = Judged::new(&scene, &run).clip;
        assert!(report.agrees(), "{}: {:?}", gpu.name, report.told);
        assert!(
            report.decisions > 0 && report.admitted >= report.decisions,
            "{report}"
        );
        // Whichever way: no corner of it is free.
        let decided = (0..scene.triangles.len()).filter(|&t| {
            let corners = scene.triangles[t].vertices;
            let corners = corners.map(|v| exact(run.positions[v as usize]));
            let ways = outcomes(&Plane::all(scene.size), corners);
            ways.is_some_and(|w| w.len() > 1)
        });
        let mut polygons = run.polygons.expect("they were asked for");
        let mut visible = decided.filter(|t| !polygon(&polygons, *t).is_empty());
        let first = visible.next().expect("some");
        let corner = polygons.offsets[first] as usize + 1;
        polygons.corners[corner][0] += 64.0;
        let report = compare_clip(&scene, &run.positions, &polygons);
        assert_eq!(report.differing, 1, "a corner 64 pixels off: {report}");
        assert!(
            matches!(report.told[0].kind, Kind::NoOutcome { .. }),
            "{:?}",
            report.told
        );
    }
}
