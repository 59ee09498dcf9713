//! What conforms is inside, what does not is outside.

mod canaries;
mod laws;
mod scenes;

use triptych_gpu::context::{Gpu, adapters};
use triptych_gpu::kernel::Kernels;
use triptych_gpu::vertex::{VertexRun, run};
use triptych_gpu::wgsl::Sources;

use super::*;
use scenes::{BITS, last, random, through_planes};

/// Every Vulkan adapter; at least the two software drivers are set up.
fn devices() -> Vec<Gpu> {
    let all = adapters(wgpu::Backends::VULKAN);
    assert!(!all.is_empty(), "no adapter: `./x setup` installs two");
    all.iter()
        .map(|a| Gpu::open(a).expect("a device"))
        .collect()
}

fn run_with(gpu: &Gpu, sources: Sources, scene: &Scene) -> VertexRun {
    run(gpu, &Kernels::new(sources), scene, BITS).expect("the scene is small")
}

#[test]
fn every_device_stays_inside_the_bound() {
    for gpu in devices() {
        let kernels = Kernels::new(Sources::shipped(false));
        let mut total = VertexReport::default();
        for (name, scene) in random() {
            let at = format!("{} on {}", name, gpu.name);
            let run = run(&gpu, &kernels, &scene, BITS).expect("the scene is small");
            let transform = compare_transform(&scene, &run.positions);
            assert_eq!(transform.outside, 0, "{at}: {:?}", transform.told);
            let whole = compare(&scene, BITS, &run.primitives);
            assert!(
                whole.agrees(),
                "{at}: {:?} {:?}",
                whole.malformed,
                whole.told
            );
            let own = exact_positions(&run.positions);
            let isolated = compare_from(&scene, &own, BITS, &run.primitives);
            assert!(isolated.agrees(), "{at}, isolated: {:?}", isolated.told);
            let worst = transform
                .error_over_bound
                .max(whole.figures.error_over_bound);
            assert!(
                worst > 1e-3,
                "{at}: a bound a thousand times too wide: {worst}"
            );
            total.add(whole);
        }
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

#[test]
fn a_triangle_on_the_planes_may_be_clipped_either_way() {
    let scene = through_planes();
    for gpu in devices() {
        let mut run = run_with(&gpu, Sources::shipped(false), &scene);
        let report = compare(&scene, BITS, &run.primitives);
        assert!(report.agrees(), "{}: {:?}", gpu.name, report.told);
        assert!(
            report.decisions > 0 && report.admitted >= report.decisions,
            "{report}"
        );
        // Whichever way: no corner of it is free.
        let decided = (0..scene.triangles.len()).filter(|&t| {
            let corners = scene.triangles[t].vertices;
            let positions: Vec<Position<Bounded>> = vertex::transform(&scene);
            let ways = outcomes(
                &Plane::all(scene.size),
                corners.map(|v| positions[v as usize]),
            );
            ways.is_some_and(|w| w.len() > 1)
        });
        let first = u32::try_from(decided.clone().next().expect("some")).expect("few");
        let row = run
            .primitives
            .source
            .iter()
            .position(|&s| s == first)
            .expect("visible");
        let corner = run.primitives.prims[row][1] as usize;
        run.primitives.snapped[corner][0] ^= 1 << 14;
        let report = compare(&scene, BITS, &run.primitives);
        assert_eq!(report.differing, 1, "a corner 64 pixels off: {report}");
        assert!(
            matches!(report.told[0].kind, Kind::NoOutcome { .. }),
            "{:?}",
            report.told
        );
    }
}

#[test]
fn twice_the_bound_is_outside() {
    for (name, scene) in random() {
        let spec = vertex::primitives(&scene, BITS);
        let positions: Vec<Position<Bounded>> = vertex::transform(&scene);
        let polygons = vertex::clip(&scene, &positions);
        let own = compare(&scene, BITS, &spec);
        for axis in 0..3 {
            let mut worse = spec.clone();
            let mut moved = 0;
            for (snapped, corner) in worse.snapped.iter_mut().zip(&polygons.corners) {
                let number = vertex::grid_position(*corner, BITS)[axis];
                // Rounding takes up to one unit of the difference away, and z has a
                // factor of 1 + 2^-31 to itself.
                let by = (2.0 * number.bound + 2.0).ceil();
                let target = f64::from(snapped[axis]) + by;
                let low_enough = target < f64::from(last(axis, scene.size));
                if number.value >= 0.0 && low_enough {
                    #[expect(clippy::cast_possible_truncation, reason = "below an i32")]
                    let target = target as i32;
                    snapped[axis] = target;
                    moved += 1;
                }
            }
            let report = compare(&scene, BITS, &worse);
            // A polygon that matches no outcome counts all its corners.
            if own.admitted == 0 {
                assert_eq!(report.outside, moved, "{name}, axis {axis}: {report}");
            }
            assert!(
                moved > 0 && report.outside > 0,
                "{name}, axis {axis}: nothing moved"
            );
        }
    }
}
