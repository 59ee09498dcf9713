//! Frames that an adapter cannot bind at once run in bands of rows, with the same
//! result; what does not fit even so is refused by name.

use triptych_gpu::error::GpuError;
use triptych_gpu::raster::{Path, Rasterizer, cover};
use triptych_gpu::{abuffer, context};
use triptych_harness::corpus::Entry;
use triptych_harness::observe::Observed;
use triptych_harness::plan::Plan;
use triptych_harness::replay::gpu::{Adapter, From, GpuLeg};
use triptych_harness::replay::rows::Rows;
use triptych_harness::replay::spec::SpecRun;
use triptych_harness::row::Verdict;
use triptych_harness::scene::{Loaded, load_entry};
use triptych_spec::vertex::{SUBPIXEL_BITS, primitives};

/// A few rows of 64 pixels, and fewer nodes than they need.
const FEW: u64 = 40_000;

fn adapters(binding_limit: u64) -> Vec<Adapter> {
    let all = context::adapters(wgpu::Backends::VULKAN);
    assert!(!all.is_empty(), "no Vulkan adapter: run ./x setup");
    let open = |adapter: &wgpu::Adapter| {
        let mut adapter = Adapter::open(adapter).expect("the adapter opens");
        adapter.gpu.restrict_bindings(binding_limit);
        adapter
    };
    all.iter().map(open).collect()
}

fn load(name: &str) -> Loaded {
    let path = triptych_harness::corpus::root()
        .join(name)
        .join("scene.toml");
    let entry = Entry {
        name: name.into(),
        family: "abuffer".into(),
        path,
    };
    load_entry(&entry, None).expect("a scene of the corpus")
}

#[test]
fn bands_give_the_same_lists_and_picture() {
    let loaded = load("abuffer/quads");
    let (scene, plan) = (&loaded.scene, Plan::new(&loaded.scene, true));
    for adapter in &adapters(FEW) {
        for path in [Path::Fragment, Path::Compute] {
            let snapped = primitives(scene, adapter.bits(path));
            let run = SpecRun::new(scene, snapped, &plan).expect("a small scene");
            let spec = Observed::new("spec", run);
            let (capacity, from) = (None, From::Cover);
            let leg = GpuLeg {
                adapter,
                path,
                scene,
                spec: &spec,
                plan: &plan,
                capacity,
                from,
            };
            let mut rows = Rows::new("abuffer/quads", "abuffer");
            let seen = leg.run(&mut rows).expect("the leg runs");
            let bands = seen.value.abuffer.bands.len();
            assert!(
                bands > 4,
                "{}: {bands} bands only: the limit is not felt",
                leg.label()
            );
            for row in &rows.rows {
                assert_ne!(row.verdict(), Verdict::Diverge, "{}: {row:#?}", leg.label());
            }
            let compared: u64 = rows.rows.iter().map(|r| r.compared).sum();
            assert!(compared > 0, "nothing compared on {}", leg.label());
        }
    }
}

#[test]
fn the_stream_of_fragments_runs_in_bands_too() {
    let loaded = load("abuffer/quads");
    for adapter in &adapters(FEW) {
        let snapped = primitives(&loaded.scene, SUBPIXEL_BITS);
        let faces = vec![[0.0; 4]; snapped.prims.len()];
        let Adapter { gpu, kernels, .. } = adapter;
        let rasterizer = Rasterizer::new(gpu, kernels, Path::Compute, &snapped, &faces);
        let mut seen = cover(&rasterizer.expect("a small scene"))
            .expect("it runs")
            .fragments;
        let mut must = Vec::new();
        triptych_spec::raster::cover(&snapped, |f| must.push(f));
        assert!(
            16 * must.len() as u64 > FEW,
            "the scene fits: the limit is not felt"
        );
        seen.sort_unstable();
        must.sort_unstable();
        assert_eq!(seen, must, "fragments on {}", gpu.name);
    }
}

#[test]
fn a_row_that_does_not_fit_is_refused_by_name() {
    let loaded = load("abuffer/quads");
    // Eight triangles fit, a row with its nodes does not.
    for adapter in &adapters(2_100) {
        let snapped = primitives(&loaded.scene, SUBPIXEL_BITS);
        let faces = vec![[0.0; 4]; snapped.prims.len()];
        let Adapter { gpu, kernels, .. } = adapter;
        let rasterizer = Rasterizer::new(gpu, kernels, Path::Compute, &snapped, &faces);
        let options = abuffer::Options {
            given: None,
            capacity: None,
            opaque: false,
            lists: true,
            depth_test: false,
            background: [0.0; 3],
        };
        let sound = |_, _: &_| Some(8);
        let result = abuffer::run(&rasterizer.expect("it fits"), options, |_| false, sound);
        let error = result
            .err()
            .expect("a row of 64 pixels with 8 layers needs 8 KiB");
        assert!(
            matches!(error, GpuError::Limit { what: "build", .. }),
            "{error}"
        );
        assert!(!error.to_string().contains('\n'), "one line: {error}");
    }
}
