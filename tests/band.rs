//! A driver whose sub-pixel grid nobody knows: coverage by must, may and must not.
//!
//! SwiftShader, whose grid has 4 bits, stands for it: it is fed the 8-bit grid.

mod devices;

use std::sync::LazyLock;

use devices::{Devices, Lent};
use triptych_gpu::kernel::Kernels;
use triptych_gpu::raster::Path;
use triptych_gpu::wgsl::Sources;
use triptych_harness::calibrate::Grid;
use triptych_harness::cause::Cause;
use triptych_harness::corpus::{self, Entry};
use triptych_harness::digest;
use triptych_harness::replay::gpu::Adapter;
use triptych_harness::replay::{Options, replay};
use triptych_harness::row::{Class, Row, Verdict};
use triptych_spec::vertex::SUBPIXEL_BITS;

static DEVICES: LazyLock<Devices> = LazyLock::new(Devices::default);

/// Scenes with and without opaque triangles: a band is needed where the plan does
/// not ask for the stream of fragments, too.
const SCENES: [&str; 2] = ["abuffer/mixed", "raster/odd-size"];

fn is_coarse(adapter: &Adapter) -> bool {
    matches!(adapter.grid, Grid::Bits(bits) if bits < SUBPIXEL_BITS)
}

/// Replays a scene on the fragment path of one adapter, which is taken to have this
/// grid and given these kernels.
fn rows(scene: &str, coarse: bool, grid: Grid, sources: &Sources) -> Vec<Row> {
    let mut adapters: Lent<'_> = DEVICES.take().expect("adapters");
    adapters.spoil(true); // of these, the grid will be a lie
    let adapter = adapters.iter_mut().find(|a| is_coarse(a) == coarse);
    let adapter = adapter.expect("a driver of that grid: ./x setup installs one of each");
    adapter.grid = grid;
    adapter.kernels = Kernels::new(sources.clone());
    let path = corpus::root().join(scene).join("scene.toml");
    let entry = Entry {
        name: scene.into(),
        family: "raster".into(),
        path,
    };
    let options = Options {
        embree: false,
        paths: vec![Path::Fragment],
        ..Options::default()
    };
    let one = std::slice::from_ref(adapter);
    let outcome = replay(&entry, one, &options).expect("the scene loads");
    let leg = format!("gpu@{}/fragment", adapter.gpu.name);
    let mut rows = outcome.rows;
    rows.retain(|r| r.b == leg);
    rows
}

fn shipped() -> Sources {
    Sources::shipped(false)
}

/// Causes of all rows that diverge.
fn causes(rows: &[Row]) -> Vec<Cause> {
    let diverging = rows.iter().filter(|r| r.verdict() == Verdict::Diverge);
    let mut causes: Vec<Cause> = diverging.flat_map(|r| r.causes.keys().copied()).collect();
    causes.sort_unstable();
    causes.dedup();
    assert!(rows.iter().all(|r| r.unexplained == 0), "{rows:#?}");
    causes
}

fn cover(rows: &[Row]) -> &Row {
    rows.iter()
        .find(|r| r.stage == "cover")
        .expect("a row for stage cover")
}

#[test]
fn a_coarser_grid_is_not_exact() {
    for scene in SCENES {
        let exact = rows(scene, true, Grid::Bits(SUBPIXEL_BITS), &shipped());
        assert!(causes(&exact).contains(&Cause::Coverage), "{exact:#?}");
    }
}

#[test]
fn a_coarser_grid_is_inside_the_band() {
    for scene in SCENES {
        let rows = rows(scene, true, Grid::Unknown, &shipped());
        let row = cover(&rows);
        assert_eq!(causes(&rows), [], "{rows:#?}");
        assert_eq!(
            (row.class, row.verdict()),
            (Class::Band, Verdict::Agree),
            "{row:#?}"
        );
        assert!(row.admitted > 0 && row.admitted_share() < 0.5, "{row:#?}");
        let (share, over) = digest::edge_share(&rows).expect("the share is shown");
        assert!(!over && share >= row.admitted_share(), "{share}");
        assert!(
            row.note.contains(&format!("MAY: {} of", row.admitted)),
            "{}",
            row.note
        );
        assert!(
            !row.note.contains(" 0 of these"),
            "nothing turned: {}",
            row.note
        );
        println!("{scene}: {}", row.note);
    }
}

#[test]
fn the_finest_grid_turns_nothing() {
    let rows = rows("abuffer/mixed", false, Grid::Unknown, &shipped());
    assert_eq!(causes(&rows), [], "{rows:#?}");
    assert!(
        cover(&rows).note.contains(" 0 of these"),
        "{}",
        cover(&rows).note
    );
}

/// Patches of the vertex shader that hands triangles to the driver, and of the key.
#[test]
fn planted_bugs_are_outside_the_band() {
    let at = "let at = corner(prim, number);";
    let missing = "let at = corner(prim, select(number, 0u, prim == 7u));";
    let moved = "let at = corner(prim, number) + select(0, 1 << (frame.bits - 2u), prim == 7u);";
    let key = ("first + second + 1u", "first + second");
    let defects = [
        ("place", at, missing, Cause::Coverage),
        ("place", at, moved, Cause::Coverage),
        ("depth", key.0, key.1, Cause::DepthKey),
    ];
    for scene in ["abuffer/mixed", "raster/jittered-grid"] {
        for (file, find, replace, cause) in defects {
            let sources = shipped().patched(file, find, replace).expect("it applies");
            let rows = rows(scene, true, Grid::Unknown, &sources);
            assert_eq!(causes(&rows), [cause], "{scene}, {replace}: {rows:#?}");
        }
    }
}
