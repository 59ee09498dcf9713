//! `--gpu-from` hands the GPU the spec's results before a stage. Whichever stage it
//! begins with, all of it agrees; and a defect of a stage shows in that stage's row as
//! long as the GPU runs it, and nowhere else, which is what bisecting by hand goes by.

mod devices;

use devices::Devices;
use triptych_gpu::kernel::Kernels;
use triptych_gpu::raster::Path;
use triptych_gpu::wgsl::Sources;
use triptych_harness::corpus::{self, Entry};
use triptych_harness::registry::stages;
use triptych_harness::replay::gpu::{Adapter, From};
use triptych_harness::replay::{Options, replay};
use triptych_harness::row::{Row, Verdict};

/// Stages that run on the GPU whatever comes after them is given, unless something is
/// given to a later one: the default compares them, and hands on the spec's triangles.
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
        "abuffer/mixed",
        "raster",
        "append(walk.fragment);",
        "walk.fragment.mask = 3u; append(walk.fragment);",
    ],
    [
        "opaque",
        "abuffer/mixed",
        "abuffer",
        "nearest(walk.fragment);",
        "walk.fragment.key += 1u; nearest(walk.fragment);",
    ],
    [
        "build",
        "abuffer/mixed",
        "abuffer",
        "colours[address] = faces[fragment.prim]",
        "colours[address] = faces[fragment.prim].bgra",
    ],
    [
        "sort",
        "abuffer/mixed",
        "abuffer",
        "x.key < y.key || (x.key == y.key && x.prim < y.prim)",
        "x.key > y.key || (x.key == y.key && x.prim < y.prim)",
    ],
    [
        "resolve",
        "abuffer/mixed",
        "abuffer",
        "seen.a * (1.0 - layer.a)",
        "seen.a",
    ],
];

/// Rows of a scene on every adapter, from a stage on.
fn rows(scene: &str, adapters: &[Adapter], from: From, paths: &[Path]) -> Vec<Row> {
    let all = corpus::list(&corpus::root()).expect("the corpus can be listed");
    let entry: Option<&Entry> = all.iter().find(|e| e.name == scene);
    let options = Options {
        embree: false,
        paths: paths.to_vec(),
        from,
        ..Options::default()
    };
    let outcome = replay(entry.expect("it is there"), adapters, &options);
    let rows = outcome.expect("it can be replayed").rows;
    rows.into_iter()
        .filter(|r| r.b.starts_with("gpu@"))
        .collect()
}

#[test]
fn every_stage_can_be_the_first() {
    let named: Vec<String> = From::all().iter().map(|f| f.name()).collect();
    let stages: Vec<&str> = stages().map(|s| s.name).collect();
    assert_eq!(named, stages, "in the order in which they run");
}

#[test]
fn from_every_stage_on_all_agrees() {
    let devices = Devices::default();
    let adapters = devices.take().expect("adapters");
    for scene in ["raster/near-plane", "abuffer/mixed"] {
        for from in From::all() {
            let rows = rows(scene, &adapters, *from, &Options::default().paths);
            let at = format!("{scene} from {}", from.name());
            for row in &rows {
                assert_ne!(row.verdict(), Verdict::Diverge, "{at}: {row:#?}");
            }
            for (adapter, stage) in adapters.iter().flat_map(|a| stages().map(move |s| (a, s))) {
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

/// Whether a stage runs on the GPU and is compared.
fn runs(stage: &str, from: From) -> bool {
    let beside = from == From::Cover && VERTEX.contains(&stage);
    let place = |name: &str| stages().position(|s| s.name == name);
    beside || place(stage) >= place(&from.name())
}

#[test]
fn a_defect_shows_until_it_is_passed() {
    let devices = Devices::default();
    let mut adapters = devices.take().expect("adapters");
    adapters.spoil();
    for [stage, scene, file, find, replace] in DEFECTS {
        let patched = Sources::shipped(false).patched(file, find, replace);
        let patched = patched.expect("the kernel has this text once");
        for adapter in adapters.iter_mut() {
            adapter.kernels = Kernels::new(patched.clone());
        }
        for from in From::all() {
            let rows = rows(scene, &adapters, *from, &[Path::Compute]);
            for adapter in adapters.iter() {
                let leg = format!("gpu@{}/compute", adapter.gpu.name);
                let diverging = rows.iter().filter(|r| {
                    let isolated = stages().any(|s| s.name == r.stage);
                    isolated && r.b == leg && r.verdict() == Verdict::Diverge
                });
                let diverging: Vec<&str> = diverging.map(|r| r.stage.as_str()).collect();
                let must: &[&str] = if runs(stage, *from) { &[stage] } else { &[] };
                assert_eq!(diverging, must, "{stage} on {leg} from {}", from.name());
            }
            // Nothing of it is left in what runs from end to end, either.
            if !runs(stage, *from) {
                let left = rows.iter().find(|r| r.verdict() == Verdict::Diverge);
                assert!(left.is_none(), "{stage} from {}: {left:#?}", from.name());
            }
        }
    }
}
