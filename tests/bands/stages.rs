//! Lists by tiles and in other layouts, in bands whose first rows are no tile's.

use std::collections::BTreeSet;

use triptych_gpu::tiles::{DRAWN, Options as Tiles, run as run_tiles};
use triptych_harness::plan::Asked;
use triptych_harness::replay::{Extent, layouts, tiles};
use triptych_spec::tiles::SIDE;

use super::*;

/// Samples of some rows fill a binding.
const FEW: Small = |gpu| gpu.restrict_bindings(80_000);

/// Whether a band begins within a tile of the whole target.
fn is_split(leg: &GpuLeg<'_>) -> bool {
    let options = Tiles {
        opaque: &leg.spec.value.opaque,
        depth_test: leg.plan.depth_test,
        background: leg.scene.background,
        capacity: None,
        drawn: DRAWN,
    };
    let rasterizer = leg.rasterizer().expect("few triangles");
    let drawn = run_tiles(&rasterizer, options).expect("it runs");
    drawn.bins.iter().any(|(band, ..)| band.first % SIDE != 0)
}

#[test]
fn tiles_and_layouts_have_the_same_lists_and_pictures_in_bands() {
    let asked = Asked {
        rivals: true,
        ..Asked::default()
    };
    let name = "abuffer/msaa-thirds";
    let loaded = load(name);
    let scene = &loaded.scene;
    let plan = Plan::asking(scene, true, asked);
    for adapter in &adapters(FEW) {
        let snapped = primitives(scene, adapter.bits(Path::Compute));
        let run = SpecRun::new(scene, snapped, &plan).expect("a small scene");
        let leg = GpuLeg {
            adapter,
            path: Path::Compute,
            scene,
            spec: &Observed::new("spec", run),
            plan: &plan,
            capacity: None,
            from: From::Cover,
        };
        let words = format!("{name}, {}", leg.label());
        assert!(is_split(&leg), "{words}: no band begins within a tile");
        let mut rows = Rows::new(name, "abuffer");
        tiles::run(&leg, Extent::All, &mut rows).expect("it runs");
        // SwiftShader takes its time over layouts: what is tried here is the host's.
        let with_layouts = adapter.native.is_some();
        if with_layouts {
            layouts::run(&leg, Extent::All, &mut rows).expect("it runs");
        }
        for row in &rows.rows {
            // Which region is fullest depends on how work is shared out: a row may have no room.
            if row.stage != "regions" || row.skipped.is_none() {
                assert_eq!(row.verdict(), Verdict::Agree, "{words}: {row:#?}");
            }
        }
        let stages: BTreeSet<&str> = rows.rows.iter().map(|row| row.stage.as_str()).collect();
        let must = if with_layouts { 11 } else { 5 };
        assert_eq!(stages.len(), must, "{words}: {stages:?}");
    }
}
