//! Techniques of small scenes, as they ship and with a defect.

use triptych_gpu::context::{Gpu, adapters};
use triptych_gpu::kernel::Kernels;
use triptych_gpu::raster::{Path, Rasterizer};
use triptych_gpu::timer::Clock;
use triptych_gpu::wgsl::Sources;
use triptych_spec::raster::Samples;

use super::{ALL, Beside, Given};
use crate::bench::Method;
use crate::bench::counts::Work;
use crate::bench::gpu::Refusal;
use crate::bench::reference::Grid;
use crate::bench::scene::Measured;
use crate::corpus;
use crate::plan::Plan;
use crate::scene::load;

/// A device.
pub(super) fn device() -> Gpu {
    let device = adapters(wgpu::Backends::VULKAN).into_iter().next();
    Gpu::open(&device.expect("no adapter: `./x setup` installs two")).expect("a device")
}

/// What is wrong with some techniques of a scene on a device, as these kernels make them.
pub(super) fn wrong(
    gpu: &Gpu,
    scene: &str,
    sources: Sources,
    are_meant: impl Fn(Method) -> bool,
) -> Vec<(Method, String)> {
    let loaded =
        load(&corpus::root().join(scene).join("scene.toml")).unwrap_or_else(|e| panic!("{e}"));
    let (scene, plan) = (&loaded.scene, Plan::of(&loaded, true));
    let mut grid = Grid::new(scene, &plan, (8, Samples::ONE)).expect("a small scene");
    grid.draw(scene, Some(&[]));
    let kernels = Kernels::new(sources);
    let (prims, faces) = (&grid.primitives, &grid.faces);
    let rasterizer = Rasterizer::new(gpu, &kernels, Path::Compute, prims, faces);
    let given = Given {
        label: "leg",
        rasterizer: &rasterizer.expect("a small scene"),
        grid: &grid,
        scene,
        run: grid.whole().expect("a small scene"),
        plan: &plan,
        all: true,
    };
    let clock = Clock::Host("a test".to_owned());
    let mut wrong = Vec::new();
    for kind in ALL.iter().filter(|kind| are_meant(kind.method)) {
        match Beside::new(kind, &given, &clock) {
            Ok(mut beside) => {
                assert!(beside.round().is_ok(), "{:?} runs", kind.method);
                let seen = beside.measured(&nothing(&grid));
                assert!(seen.seconds().all(|s| s > 0.0), "{:?}", kind.method);
                let psnr = seen.error.psnr.unwrap_or(f64::INFINITY);
                assert_eq!(
                    psnr < 100.0,
                    kind.method.approximates(),
                    "{:?}: {psnr}",
                    kind.method
                );
            }
            Err(Refusal::Wrong(words)) => wrong.push((kind.method, words)),
            Err(Refusal::Skipped(words)) => panic!("{words}"),
        }
    }
    wrong
}

/// Nothing that comes before.
fn nothing(grid: &Grid) -> Measured {
    Measured {
        method: Method::Sort,
        layers: 0,
        parts: Vec::new(),
        error: grid.error_of_spec(0),
        memory: 0,
        of_fragment: None,
        bands: 1,
        work: Work::default(),
    }
}
