use triptych_gpu::context::{Gpu, adapters};
use triptych_gpu::kernel::Kernels;
use triptych_gpu::raster::{Path, Rasterizer};
use triptych_gpu::timer::Clock;
use triptych_gpu::wgsl::Sources;
use triptych_spec::raster::Samples;

use crate::bench::Method;
use crate::bench::counts::Work;
use crate::bench::gpu::Refusal;
use crate::bench::reference::Grid;
use crate::bench::rivals::{ALL, Beside, Given};
use crate::bench::scene::Measured;
use crate::corpus;
use crate::plan::Plan;
use crate::scene::load;

/// What is wrong with each layout of a scene on a device, as these kernels make it.
fn wrong(gpu: &Gpu, scene: &str, sources: Sources) -> Vec<(Method, String)> {
    let loaded =
        load(&corpus::root().join(scene).join("scene.toml")).unwrap_or_else(|e| panic!("{e}"));
    let (scene, plan) = (&loaded.scene, Plan::new(&loaded.scene, true));
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
        depth_test: plan.depth_test,
        all: true,
    };
    let clock = Clock::Host("a test".to_owned());
    let mut wrong = Vec::new();
    for kind in ALL.iter().filter(|kind| kind.method.layout().is_some()) {
        match Beside::new(kind, &given, &clock) {
            Ok(mut beside) => {
                assert!(beside.round().is_ok(), "{:?} runs", kind.method);
                let seen = beside.measured(&nothing(&grid));
                assert!(seen.seconds().all(|s| s > 0.0), "{:?}", kind.method);
                let psnr = seen.error.psnr.unwrap_or(f64::INFINITY);
                assert_eq!(
                    psnr < 100.0,
                    kind.method == Method::Packed,
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

/// What ships is right; another order, colour or byte is refused by the layout's name, and no other layout is.
#[test]
fn a_layout_that_is_wrong_is_named() {
    let device = adapters(wgpu::Backends::VULKAN).into_iter().next();
    let gpu = Gpu::open(&device.expect("no adapter: `./x setup` installs two")).expect("a device");
    let ships = Sources::shipped(false);
    assert_eq!(wrong(&gpu, "abuffer/mixed", ships.clone()), []);
    let names = |scene, (file, find, replace): (&str, &str, &str)| {
        let patched = ships.patched(file, find, replace);
        let found = wrong(&gpu, scene, patched.expect("it is there once"));
        let starts = |(method, words): &(Method, String)| {
            let start = format!("leg, {}", method.name());
            assert!(words.starts_with(&start), "{words}");
            *method
        };
        found.iter().map(starts).collect::<Vec<_>>()
    };
    let [arrays, linked] = [
        [Method::Precalc, Method::Bucket],
        [Method::Packed, Method::Regions],
    ];
    // Of one colour, so that lists alone tell orders apart.
    let order = (
        "layouts",
        "return a.x < b.x || (a.x == b.x && a.y < b.y);",
        "return a.x > b.x || (a.x == b.x && a.y < b.y);",
    );
    assert_eq!(names("abuffer/quads", order), arrays, "order");
    let bytes = ("packed", "* 255.0 + 0.5", "* 254.0 + 0.5");
    assert_eq!(names("abuffer/mixed", bytes), linked[..1], "bytes");
    let colours = (
        "regions",
        "colours[address] = faces[fragment.prim];",
        "colours[address] = faces[0u];",
    );
    assert_eq!(names("abuffer/mixed", colours), linked[1..], "colours");
    let layers = ("ordered", "faces[slot.y >> MASK_BITS]", "faces[0u]");
    assert_eq!(names("abuffer/mixed", layers), [Method::Ordered], "layers");
}
