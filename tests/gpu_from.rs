//! `--gpu-from` hands the GPU the spec's results before a stage. Whichever stage it
//! begins with, all of it agrees; and a defect of a stage shows in that stage's row as
//! long as the GPU runs it, and nowhere else, which is what bisecting by hand goes by.

mod devices;

use std::sync::LazyLock;

use devices::Devices;
use triptych_gpu::kernel::Kernels;
use triptych_gpu::raster::Path;
use triptych_gpu::wgsl::Sources;
use triptych_harness::corpus::{self, Entry};
use triptych_harness::observe::Observed;
use triptych_harness::plan::Plan;
use triptych_harness::registry::handing_on;
use triptych_harness::replay::gpu::{Adapter, From, GpuLeg};
use triptych_harness::replay::spec::SpecRun;
use triptych_harness::replay::{Options, replay};
use triptych_harness::row::{Row, Verdict};
use triptych_harness::scene::load_entry;
use triptych_spec::vertex::{SUBPIXEL_BITS, primitives};

static DEVICES: LazyLock<Devices> = LazyLock::new(Devices::default);

/// Stages that the default compares as well, though it hands on the spec's triangles.
const VERTEX: [&str; 3] = ["transform", "clip", "snap"];

/// A defect: its stage, a scene that shows it, the file, what is replaced, and by what.
const DEFECTS: [[&str; 5]; 8] = [
    [
        "transform",
        "raster/near-plane",
        "vertex",
        "row.x * v.x +",
        "bitcast<f32>(bitcast<u32>(row.x * v.x) & 0xffffff00u) +",
    ],
    [
        "clip",
        "raster/near-plane",
        "vertex",
        "clamp(da / select(1.0, apart, defined), 0.0, 1.0)",
        "0.5",
    ],
    [
        "snap",
        "raster/near-plane",
        "vertex",
        "round(pixels * f32(1u << frame.bits))",
        "round(pixels * f32(1u << frame.bits)) + 1.0",
    ],
    [
        "cover",
        "abuffer/lens",
        "raster",
        "append(walk.fragment);",
        "walk.fragment.mask = 3u; append(walk.fragment);",
    ],
    [
        "opaque",
        "abuffer/lens",
        "abuffer",
        "nearest(walk.fragment);",
        "walk.fragment.key += 1u; nearest(walk.fragment);",
    ],
    [
        "build",
        "abuffer/lens",
        "abuffer",
        "colours[address] = faces[fragment.prim]",
        "colours[address] = faces[fragment.prim].bgra",
    ],
    [
        "sort",
        "abuffer/lens",
        "abuffer",
        "x.key < y.key || (x.key == y.key && x.prim < y.prim)",
        "x.key > y.key || (x.key == y.key && x.prim < y.prim)",
    ],
    [
        "resolve",
        "abuffer/lens",
        "abuffer",
        "seen.a * (1.0 - layer.a)",
        "seen.a",
    ],
];

fn entry(scene: &str) -> Entry {
    let all = corpus::list(&corpus::root()).expect("the corpus can be listed");
    let mut found = all.into_iter().filter(|e| e.name == scene);
    found.next().expect("it is there")
}

/// Rows of a scene on every adapter, from a stage on.
fn rows(scene: &str, adapters: &[Adapter], from: From, paths: &[Path]) -> Vec<Row> {
    let options = Options {
        embree: false,
        paths: paths.to_vec(),
        from,
        ..Options::default()
    };
    let outcome = replay(&entry(scene), adapters, &options);
    let rows = outcome.expect("it can be replayed").rows;
    rows.into_iter()
        .filter(|r| r.b.starts_with("gpu@"))
        .collect()
}

#[test]
fn every_stage_can_be_the_first() {
    let named: Vec<String> = From::all().iter().map(|f| f.name()).collect();
    let stages: Vec<&str> = handing_on().map(|s| s.name).collect();
    assert_eq!(named, stages, "in the order in which they run");
}

#[test]
fn from_every_stage_on_all_agrees() {
    let adapters = DEVICES.take().expect("adapters");
    for scene in ["raster/near-plane", "abuffer/lens"] {
        for from in From::all() {
            let rows = rows(scene, &adapters, *from, &Options::default().paths);
            let at = format!("{scene} from {}", from.name());
            for row in &rows {
                assert_ne!(row.verdict(), Verdict::Diverge, "{at}: {row:#?}");
            }
            // What runs from end to end is the leg itself, or the default's beside it.
            let beside = rows.iter().any(|r| r.stage == "end to end");
            assert!(!beside || *from == From::Cover, "{at}");
            for (adapter, stage) in adapters
                .iter()
                .flat_map(|a| handing_on().map(move |s| (a, s)))
            {
                let leg = format!("gpu@{}/compute", adapter.gpu.name);
                let row = rows.iter().find(|r| r.b == leg && r.stage == stage.name);
                let row = row.unwrap_or_else(|| panic!("{at}: no {} of {leg}", stage.name));
                let runs = runs(stage.name, *from);
                let given = row.skipped.as_deref() == Some(From::GIVEN);
                // What the plan leaves out is not needed, whoever would give it.
                let planned = row.skipped.as_ref().is_some_and(|r| r.starts_with("plan:"));
                assert!(planned || given != runs, "{at}: {row:#?}");
                assert!(planned || (row.compared > 0) == runs, "{at}: {row:#?}");
            }
        }
    }
}

/// Fragments change with what is clipped otherwise, if the GPU hands it on.
#[test]
fn later_stages_start_from_the_triangles_of_the_gpu() {
    let mut adapters = DEVICES.take().expect("adapters");
    adapters.spoil(true);
    let [_, scene, file, find, replace] = DEFECTS[1];
    let patched = Sources::shipped(false).patched(file, find, replace);
    let patched = patched.expect("the kernel has this text once");
    for adapter in adapters.iter_mut() {
        adapter.kernels = Kernels::new(patched.clone());
    }
    let built = |from| -> Vec<u64> {
        let rows = rows(scene, &adapters, from, &[Path::Compute]);
        let build = rows.iter().filter(|r| r.stage == "build");
        build.map(|r| r.compared).collect()
    };
    let (own, given) = (built(From::Transform), built(From::Cover));
    assert_eq!((own.len(), given.len()), (adapters.len(), adapters.len()));
    assert!(own.iter().zip(&given).all(|(a, b)| a != b), "{own:?}");
    assert_eq!(built(From::Clip), own, "the GPU clips");
    assert_eq!(built(From::Snap), given, "the spec clips");
}

/// Rows say what was compared; this says what ran.
#[test]
fn the_stages_before_do_not_run() {
    let adapters = DEVICES.take().expect("adapters");
    let scene = load_entry(&entry("abuffer/lens"), None).expect("it loads");
    let (scene, plan) = (&scene.scene, Plan::new(&scene.scene, true));
    let snapped = primitives(scene, SUBPIXEL_BITS);
    let run = SpecRun::new(scene, snapped, &plan).expect("a small scene");
    let spec = Observed::new("spec", run);
    for adapter in adapters.iter() {
        for from in [From::Opaque, From::Build, From::Sort, From::Resolve] {
            let leg = GpuLeg {
                adapter,
                path: Path::Compute,
                scene,
                spec: &spec,
                plan: &plan,
                capacity: None,
                from,
            };
            let rasterizer = leg.rasterizer().expect("a small scene");
            let seen = leg.abuffer(&rasterizer).expect("it runs");
            let times = seen.abuffer.times;
            let ran = [times.opaque, times.build, times.sort, times.resolve].map(|t| !t.is_zero());
            let first = |stage| from <= stage;
            let must = [From::Opaque, From::Build, From::Sort, From::Resolve].map(first);
            assert_eq!(ran, must, "{} from {}", leg.label(), from.name());
            assert!(seen.abuffer.opaque == spec.value.opaque, "{}", leg.label());
            let sorted = seen.sorted.expect("the lists are sound");
            assert!(sorted == spec.value.sorted, "{}", leg.label());
        }
    }
}

/// Whether a stage runs on the GPU and is compared.
fn runs(stage: &str, from: From) -> bool {
    let beside = from == From::Cover && VERTEX.contains(&stage);
    let place = |name: &str| handing_on().position(|s| s.name == name);
    beside || place(stage) >= place(&from.name())
}

/// The first stage, the one given and its next, and the default.
fn around(stage: &str) -> impl Iterator<Item = From> {
    let at = handing_on().position(|s| s.name == stage).expect("a stage");
    let wanted = move |(place, from): &(usize, &From)| {
        [0, at, at + 1].contains(place) || **from == From::Cover
    };
    let all = From::all().iter().enumerate();
    all.filter(wanted).map(|(_, from)| *from)
}

#[test]
fn a_defect_shows_until_it_is_passed() {
    let mut adapters = DEVICES.take().expect("adapters");
    adapters.spoil(true);
    for [stage, scene, file, find, replace] in DEFECTS {
        let patched = Sources::shipped(false).patched(file, find, replace);
        let patched = patched.expect("the kernel has this text once");
        for adapter in adapters.iter_mut() {
            adapter.kernels = Kernels::new(patched.clone());
        }
        for from in around(stage) {
            let rows = rows(scene, &adapters, from, &[Path::Compute]);
            for adapter in adapters.iter() {
                let leg = format!("gpu@{}/compute", adapter.gpu.name);
                let diverging = rows.iter().filter(|r| {
                    let isolated = handing_on().any(|s| s.name == r.stage);
                    isolated && r.b == leg && r.verdict() == Verdict::Diverge
                });
                let diverging: Vec<&str> = diverging.map(|r| r.stage.as_str()).collect();
                let must: &[&str] = if runs(stage, from) { &[stage] } else { &[] };
                assert_eq!(diverging, must, "{stage} on {leg} from {}", from.name());
            }
            // Nothing of it is left in what runs from end to end, either.
            if !runs(stage, from) {
                let left = rows.iter().find(|r| r.verdict() == Verdict::Diverge);
                assert!(left.is_none(), "{stage} from {}: {left:#?}", from.name());
            }
        }
    }
}
