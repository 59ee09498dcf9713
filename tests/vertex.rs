//! `--vertex`: whose vertices the later stages of a GPU leg get.

mod devices;

use std::sync::LazyLock;

use devices::Devices;
use triptych_gpu::kernel::Kernels;
use triptych_gpu::raster::Path;
use triptych_gpu::wgsl::Sources;
use triptych_harness::cause::Cause;
use triptych_harness::corpus::{self, Entry};
use triptych_harness::replay::gpu::{Adapter, From, Vertices};
use triptych_harness::replay::{Options, replay};
use triptych_harness::row::{Class, Row, Verdict};

static DEVICES: LazyLock<Devices> = LazyLock::new(Devices::default);

fn rows(scene: &str, adapters: &[Adapter], vertex: Vertices) -> Vec<Row> {
    let all = corpus::list(&corpus::root()).expect("the corpus can be listed");
    let mut found = all.into_iter().filter(|e| e.name == scene);
    let entry: Entry = found.next().expect("it is there");
    let options = Options {
        embree: false,
        from: vertex.from(None).expect("nothing contradicts it"),
        vertex,
        ..Options::default()
    };
    let outcome = replay(&entry, adapters, &options);
    let rows = outcome.expect("it can be replayed").rows;
    rows.into_iter()
        .filter(|r| r.b.starts_with("gpu@"))
        .collect()
}

/// The legs of all adapters and paths that run.
fn legs(adapters: &[Adapter]) -> Vec<String> {
    let runs = |a: &Adapter, path: &Path| *path != Path::Native || a.native.is_some();
    let leg = |a: &Adapter, path: Path| format!("gpu@{}/{}", a.gpu.name, path.name());
    let of = |a| {
        let paths = Path::ALL.into_iter().filter(move |path| runs(a, path));
        paths.map(move |path| leg(a, path))
    };
    adapters.iter().flat_map(of).collect()
}

/// The row of a leg at a stage.
fn row<'a>(rows: &'a [Row], leg: &str, stage: &str) -> &'a Row {
    let mut found = rows.iter().filter(|r| r.b == leg && r.stage == stage);
    found
        .next()
        .unwrap_or_else(|| panic!("no row {stage} of {leg}"))
}

/// Puts a defect into the kernels of every adapter.
fn patch(adapters: &mut [Adapter], file: &str, find: &str, replace: &str) {
    for adapter in adapters {
        let patched = |native| {
            let patched = Sources::shipped(native).patched(file, find, replace);
            Kernels::new(patched.expect("the kernel has this text once"))
        };
        adapter.kernels = patched(false);
        adapter.native = adapter.native.take().map(|_| patched(true));
    }
}

#[test]
fn what_the_gpus_own_vertices_change_is_counted_on_every_path() {
    let adapters = DEVICES.take().expect("adapters");
    for scene in ["raster/near-plane", "abuffer/mixed", "abuffer/out-of-view"] {
        let rows = rows(scene, &adapters, Vertices::Gpu);
        for leg in legs(&adapters) {
            let diverging = rows.iter().filter(|r| r.b == leg);
            let diverging = diverging.filter(|r| r.verdict() == Verdict::Diverge);
            assert_eq!(diverging.count(), 0, "{scene} {leg}: {rows:#?}");
            let row = row(&rows, &leg, "vertex");
            assert!(row.note.contains("cause vertex"), "{scene}: {row:#?}");
            assert!(row.compared > row.admitted, "{scene}: {row:#?}");
            // Rounded to f32, some corner has another key.
            let moves = scene != "abuffer/out-of-view";
            assert_eq!(row.admitted > 0, moves, "{scene}: {row:#?}");
        }
    }
}

/// Each on every path, whichever grid it works on.
#[test]
fn a_defect_of_the_vertex_stages_has_cause_vertex_on_every_path() {
    let snap = "round(pixels * f32(1u << frame.bits))";
    let keys = "row.x * v.x +";
    let defects = [
        ("snap", snap, format!("{snap} + 2.0")),
        ("transform", keys, "row.x * v.x * 1.0001 +".to_owned()),
    ];
    for (stage, find, replace) in defects {
        let mut adapters = DEVICES.take().expect("adapters");
        adapters.spoil(true);
        patch(&mut adapters, "vertex", find, &replace);
        let rows = rows("raster/near-plane", &adapters, Vertices::Gpu);
        for leg in legs(&adapters) {
            let judged = row(&rows, &leg, stage);
            assert!(judged.causes.contains_key(&Cause::Vertex), "{judged:#?}");
            // What follows from it is the same as the spec's on these vertices.
            let build = row(&rows, &leg, "build");
            assert_eq!(build.verdict(), Verdict::Agree, "{build:#?}");
            let changed = row(&rows, &leg, "vertex");
            assert_eq!(changed.differ, 0, "{changed:#?}");
            assert!(!changed.note.contains(" 0 come or go"), "{changed:#?}");
        }
    }
}

/// Every leg on the fragment path, and no other, has coverage by clip space.
#[test]
fn what_the_driver_makes_of_clip_space_is_inside_the_band() {
    let adapters = DEVICES.take().expect("adapters");
    for scene in [
        "raster/near-plane",
        "raster/odd-size",
        "raster/guard",
        "raster/through-camera",
        "abuffer/mixed",
    ] {
        let rows = rows(scene, &adapters, Vertices::Hardware);
        for leg in legs(&adapters) {
            let cover = row(&rows, &leg, "cover");
            if !leg.ends_with("/fragment") {
                assert!(cover.skipped.is_some(), "{scene}: {cover:#?}");
                continue;
            }
            assert_eq!(cover.verdict(), Verdict::Agree, "{scene}: {cover:#?}");
            assert_eq!(cover.class, Class::Band, "{scene}: {cover:#?}");
            assert!(cover.note.contains("MAY: "), "{scene}: {cover:#?}");
            assert!(cover.admitted_share() < 0.5, "{scene}: {cover:#?}");
            let judged = row(&rows, &leg, "vertex");
            assert_eq!(judged.verdict(), Verdict::Agree, "{scene}: {judged:#?}");
            assert_eq!(judged.admitted, 0, "{scene}: {judged:#?}");
        }
    }
}

/// Defects of what is handed to the driver, each on a scene that shows it on any grid.
#[test]
fn defects_of_clip_space_are_outside_the_band() {
    let find = "return Placed(handed[3u * prim + index % 3u], prim);";
    let placed = |position: &str| {
        format!("let at = handed[3u * prim + index % 3u]; return Placed({position}, prim);")
    };
    let defects = [
        // Two sub-pixels of the coarser grid.
        ("raster/odd-size", "vec4(at.x + at.w / 16384.0, at.yzw)"),
        ("raster/near-plane", "vec4(at.xyz, at.w * 1.01)"),
        // Quads in the near and in the far plane are clipped.
        (
            "raster/depth-range",
            "vec4(at.xy, at.z - 0.001 * at.w, at.w)",
        ),
        (
            "raster/depth-range",
            "vec4(at.xy, at.z + 0.001 * at.w, at.w)",
        ),
    ];
    for (scene, position) in defects {
        let mut adapters = DEVICES.take().expect("adapters");
        adapters.spoil(true);
        patch(&mut adapters, "place", find, &placed(position));
        let rows = rows(scene, &adapters, Vertices::Hardware);
        for adapter in adapters.iter() {
            let leg = format!("gpu@{}/fragment", adapter.gpu.name);
            let cover = row(&rows, &leg, "cover");
            let causes: Vec<_> = cover.causes.keys().copied().collect();
            assert_eq!(causes, [Cause::Coverage], "{scene} {position}: {cover:#?}");
            assert_eq!(cover.unexplained, 0, "{scene} {position}: {cover:#?}");
        }
    }
}

#[test]
fn contradictions_are_refused() {
    let fine = [(Vertices::Spec, From::Clip), (Vertices::Gpu, From::Snap)];
    for (vertex, from) in fine {
        assert_eq!(vertex.from(Some(from)), Ok(from));
    }
    let wrong = [
        (Vertices::Gpu, From::Cover),
        (Vertices::Gpu, From::Resolve),
        (Vertices::Hardware, From::Transform),
    ];
    for (vertex, from) in wrong {
        let message = vertex.from(Some(from)).expect_err("a contradiction");
        assert!(message.contains(&from.name()), "{message}");
    }
    assert_eq!(Vertices::Gpu.from(None), Ok(From::Transform));
    assert_eq!(Vertices::Spec.from(None), Ok(From::Cover));
}
