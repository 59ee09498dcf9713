//! Frames that an adapter cannot bind at once, or has no memory for, run in bands of
//! rows, with the same result; what does not fit even so is refused by name.

#[path = "bands/stages.rs"]
mod stages;
#[path = "bands/tiles.rs"]
mod tiles;
#[path = "bands/timed.rs"]
mod timed;

use triptych_gpu::abuffer::{self, Abuffer};
use triptych_gpu::context::{self, Gpu};
use triptych_gpu::error::GpuError;
use triptych_gpu::kernel::Kernels;
use triptych_gpu::raster::{Path, Rasterizer, cover};
use triptych_gpu::wgsl::Sources;
use triptych_harness::corpus::Entry;
use triptych_harness::observe::Observed;
use triptych_harness::plan::Plan;
use triptych_harness::replay::gpu::{Adapter, From, GpuLeg};
use triptych_harness::replay::rows::Rows;
use triptych_harness::replay::spec::SpecRun;
use triptych_harness::replay::{Options, replay};
use triptych_harness::row::{Row, Verdict};
use triptych_harness::scene::{Loaded, load_entry};
use triptych_spec::vertex::{SUBPIXEL_BITS, primitives};

/// A way in which an adapter is too small.
type Small = fn(&mut Gpu);

/// Room for a few rows of 64 pixels, and for fewer nodes than they need.
const SMALL: [(&str, Small); 2] = [
    ("bindings", |gpu| gpu.restrict_bindings(40_000)),
    ("memory", |gpu| gpu.restrict_memory(120_000)),
];

fn found() -> Vec<wgpu::Adapter> {
    let all = context::adapters(wgpu::Backends::VULKAN);
    assert!(!all.is_empty(), "no Vulkan adapter: run ./x setup");
    all
}

fn adapters(small: Small) -> Vec<Adapter> {
    let open = |adapter: &wgpu::Adapter| {
        let name = context::short_name(&adapter.get_info());
        let mut adapter = Adapter::open(adapter, &name).expect("the adapter opens");
        small(&mut adapter.gpu);
        adapter
    };
    found().iter().map(open).collect()
}

/// Devices without calibration, which takes longer than what they are asked.
fn devices(small: Small) -> Vec<(Gpu, Kernels)> {
    let open = |adapter: &wgpu::Adapter| {
        let mut gpu = Gpu::open(adapter).expect("the adapter opens");
        small(&mut gpu);
        (gpu, Kernels::new(Sources::shipped(false)))
    };
    found().iter().map(open).collect()
}

fn entry(name: &str) -> Entry {
    let path = triptych_harness::corpus::root()
        .join(name)
        .join("scene.toml");
    Entry {
        name: name.into(),
        family: "abuffer".into(),
        path,
    }
}

fn load(name: &str) -> Loaded {
    load_entry(&entry(name), None).expect("a scene of the corpus")
}

/// Runs a leg in bands and demands that all of it agrees.
fn agrees_in_bands(loaded: &Loaded, adapter: &Adapter, path: Path, from: From) {
    let (scene, plan) = (&loaded.scene, Plan::new(&loaded.scene, true));
    let snapped = primitives(scene, adapter.bits(path));
    let run = SpecRun::new(scene, snapped, &plan).expect("a small scene");
    let spec = Observed::new("spec", run);
    let leg = GpuLeg {
        adapter,
        path,
        scene,
        spec: &spec,
        plan: &plan,
        capacity: None,
        from,
    };
    let mut rows = Rows::new("abuffer/quads", "abuffer");
    let seen = leg.run(&mut rows).expect("the leg runs");
    let bands = seen.value.abuffer.bands.len();
    assert!(
        bands > 4,
        "{}: {bands} bands only: it was not felt",
        leg.label()
    );
    for row in &rows.rows {
        assert_ne!(row.verdict(), Verdict::Diverge, "{}: {row:#?}", leg.label());
    }
    let compared: u64 = rows.rows.iter().map(|r| r.compared).sum();
    assert!(compared > 0, "nothing compared on {}", leg.label());
    let pixels = scene.size.pixels();
    assert_eq!(seen.value.abuffer.image.len(), pixels, "{}", leg.label());
}

#[test]
fn bands_give_the_same_lists_and_picture() {
    let loaded = load("abuffer/quads");
    for (name, small) in SMALL {
        for adapter in &adapters(small) {
            for path in [Path::Fragment, Path::Compute] {
                for from in [From::Cover, From::Build, From::Sort, From::Resolve] {
                    println!("{name}, {path:?}, from {from:?}");
                    agrees_in_bands(&loaded, adapter, path, from);
                }
            }
        }
    }
}

#[test]
fn the_stream_of_fragments_runs_in_bands_too() {
    let loaded = load("abuffer/quads");
    for (name, small) in SMALL {
        for (gpu, kernels) in &devices(small) {
            let snapped = primitives(&loaded.scene, SUBPIXEL_BITS);
            let faces = vec![[0.0; 4]; snapped.prims.len()];
            let rasterizer = Rasterizer::new(gpu, kernels, Path::Compute, &snapped, &faces);
            let mut seen = cover(&rasterizer.expect("a small scene"))
                .expect("it runs")
                .fragments;
            let mut must = Vec::new();
            triptych_spec::raster::cover(&snapped, |f| must.push(f));
            assert!(
                16 * must.len() as u64 > 120_000,
                "the scene fits: the limit is not felt"
            );
            seen.sort_unstable();
            must.sort_unstable();
            assert!(seen == must, "fragments on {} with few {name}", gpu.name);
        }
    }
}

/// Builds lists of eight layers on a row of 64 pixels and more, with small adapters.
fn build(small: Small) -> Vec<Result<Abuffer, GpuError>> {
    let loaded = load("abuffer/quads");
    let build = |(gpu, kernels): &(Gpu, Kernels)| {
        let snapped = primitives(&loaded.scene, SUBPIXEL_BITS);
        let faces = vec![[0.0; 4]; snapped.prims.len()];
        let rasterizer = Rasterizer::new(gpu, kernels, Path::Compute, &snapped, &faces)?;
        let options = abuffer::Options {
            given: None,
            capacity: None,
            opaque: false,
            lists: true,
            depth_test: false,
            order: triptych_spec::abuffer::Order::Centroid,
            once: false,
            background: [0.0; 3],
        };
        let sound = |_, _: &_| Some(8);
        abuffer::run(&rasterizer, options, |_| false, sound)
    };
    devices(small).iter().map(build).collect()
}

#[test]
fn a_row_that_does_not_fit_is_refused_by_name() {
    // Eight triangles fit, a row with its nodes does not: it needs 8 KiB, twice.
    let small: [Small; 2] = [
        |gpu| gpu.restrict_bindings(2_100),
        |gpu| gpu.restrict_memory(16_000),
    ];
    for result in small.into_iter().flat_map(build) {
        let error = result.err().expect("a row of 64 pixels with 8 layers");
        assert!(
            matches!(error, GpuError::Limit { what: "build", .. }),
            "{error}"
        );
        assert!(!error.to_string().contains('\n'), "one line: {error}");
    }
}

#[test]
fn triangles_that_do_not_fit_are_refused_by_name() {
    for result in build(|gpu| gpu.restrict_memory(100)) {
        let error = result.err().expect("eight triangles take 288 bytes");
        let corners = matches!(
            error,
            GpuError::Memory {
                what: "corners",
                ..
            }
        );
        assert!(corners, "{error}");
        assert!(!error.to_string().contains('\n'), "one line: {error}");
    }
}

/// A replay goes on without such an adapter, and says why.
#[test]
fn an_adapter_without_memory_is_skipped_by_name() {
    let adapters = adapters(|gpu| gpu.restrict_memory(100));
    let options = Options {
        embree: false,
        ..Options::default()
    };
    let outcome = replay(&entry("abuffer/quads"), &adapters, &options).expect("it loads");
    let legs: Vec<&Row> = outcome
        .rows
        .iter()
        .filter(|r| r.b.starts_with("gpu@") && r.stage == "leg")
        .collect();
    assert_eq!(
        legs.len(),
        adapters.len() * options.paths.len(),
        "{legs:#?}"
    );
    for row in outcome.rows.iter().filter(|r| r.b.starts_with("gpu@")) {
        assert_eq!(row.verdict(), Verdict::Skipped, "{row:#?}");
        let reason = row.skipped.as_deref().unwrap_or_default();
        // Clip and snap have nothing to start from, which row transform explains.
        let known = ["out of memory", "no 64-bit integers", "see transform"];
        assert!(known.iter().any(|k| reason.contains(k)), "{reason}");
    }
}
