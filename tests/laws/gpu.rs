//! Random triangles through every adapter and path: each stage equals the spec's.

#[path = "gpu/early.rs"]
mod early;

use std::sync::OnceLock;

use proptest::prelude::*;
use triptych_gpu::abuffer::rivals::{Given, Single, once};
use triptych_gpu::error::GpuError;
use triptych_gpu::raster::Path;
use triptych_harness::compare::image;
use triptych_harness::observe::{Observed, Spec};
use triptych_harness::plan::{Asked, Plan};
use triptych_harness::replay::gpu::{Adapter, Adapters, Drawn, From, GpuLeg};
use triptych_harness::replay::rows::Rows;
use triptych_harness::replay::spec::SpecRun;
use triptych_harness::replay::{Extent, layouts, rivals, tiles};
use triptych_harness::row::Verdict;
use triptych_spec::abuffer::{Lens, Order, Reduction, Target};
use triptych_spec::raster::Samples;
use triptych_spec::vertex::{GUARD, Primitives, guard_origin};

use super::abuffer::{Layers, coloured};
use super::config;
use super::samples::soup_on;

/// Opened once: that takes longer than all that they are asked.
fn adapters() -> &'static [Adapter] {
    static ADAPTERS: OnceLock<Vec<Adapter>> = OnceLock::new();
    ADAPTERS.get_or_init(|| {
        let Adapters { open, broken } = Adapters::open(&[]);
        assert_eq!(broken, [], "every adapter can be used");
        assert!(
            !open.is_empty(),
            "no adapter; `triptych doctor` says what is missing"
        );
        open
    })
}

/// Layers on one of the grids that drivers have. Nothing reaches beyond the guard, as
/// no stage before would let it.
fn layers() -> impl Strategy<Value = Layers> {
    let grids = adapters().iter().map(|a| a.bits(Path::Fragment));
    let soup = prop::sample::select(grids.collect::<Vec<_>>());
    let soup = soup.prop_flat_map(|bits| soup_on(bits, 1..24));
    let soup = soup.prop_map(|mut soup| {
        let bits = soup.bits;
        let low = [soup.size.width, soup.size.height].map(|side| guard_origin(side) << bits);
        for corner in &mut soup.snapped {
            for (at, low) in corner.iter_mut().zip(low) {
                *at = (*at).clamp(low, low + (GUARD << bits));
            }
        }
        soup
    });
    coloured(soup)
}

/// What the spec makes of them.
fn spec_of(layers: &Layers, plan: &Plan) -> Result<Observed<Spec, SpecRun>, TestCaseError> {
    let run = SpecRun::new(&layers.scene, layers.primitives.clone(), plan);
    Ok(Observed::new("spec", run.map_err(TestCaseError::fail)?))
}

/// An adapter's path from the spec's triangles on; with `few`, the first attempt overflows, unless there
/// is next to nothing.
fn leg<'a>(
    layers: &'a Layers,
    (adapter, path): (&'a Adapter, Path),
    (plan, spec): (&'a Plan, &'a Observed<Spec, SpecRun>),
    few: bool,
) -> GpuLeg<'a> {
    GpuLeg {
        adapter,
        path,
        scene: &layers.scene,
        spec,
        plan,
        capacity: few.then_some(spec.value.lists.attempts / 2),
        from: From::Cover,
    }
}

/// Runs all stages and compares each.
fn agrees(layers: &Layers, adapter: &Adapter, path: Path, skip: bool) -> Result<(), TestCaseError> {
    if path == Path::Native && adapter.native.is_none() {
        return Ok(());
    }
    let plan = Plan::new(&layers.scene, skip);
    let spec = spec_of(layers, &plan)?;
    let leg = leg(layers, (adapter, path), (&plan, &spec), true);
    let mut rows = Rows::new("law", "abuffer");
    let failed = |e: GpuError| TestCaseError::fail(e.to_string());
    leg.run(&mut rows).map_err(failed)?;
    tiles::run(&leg, Extent::All, &mut rows).map_err(failed)?;
    let words = || rows.described.join("\n");
    for row in &rows.rows {
        // Triangles at random may cover nothing.
        let nothing = row.compared == 0 && row.differ == 0;
        let verdict = if nothing {
            Verdict::Skipped
        } else {
            row.verdict()
        };
        prop_assert_ne!(verdict, Verdict::Diverge, "{:?}\n{}", row, words());
    }
    let compared = |stage: &str| rows.rows.iter().any(|r| r.stage == stage && r.compared > 0);
    prop_assert!(compared("resolve"), "nothing was compared");
    prop_assert!(
        skip || compared("cover") || spec.value.cover.is_empty(),
        "no fragments were"
    );
    Ok(())
}

/// Whether a leg draws with just these samples.
fn draws(adapter: &Adapter, path: Path, primitives: &Primitives) -> bool {
    let drawn = adapter.samples(path, primitives.samples);
    let on_grid = path != Path::Fragment || adapter.bits(path) == primitives.bits;
    on_grid && matches!(drawn, Ok(Drawn::With(samples)) if samples == primitives.samples)
}

/// The samples of every driver are where WebGPU says, wherever they are in use.
#[test]
fn samples_are_in_standard_places() {
    for adapter in adapters() {
        let four = Samples::standard(4).expect("a pattern");
        let drawn = adapter.samples(Path::Fragment, four);
        assert_eq!(drawn, Ok(Drawn::With(four)), "{}", adapter.gpu.name);
    }
}

proptest! {
    #![proptest_config(config(16))]

    /// The same with several samples a pixel, in both orders of layers.
    #[test]
    fn random_samples(
        mut layers in layers(),
        samples in prop::sample::select(vec![2, 4, 4, 8]),
        by_sample in any::<bool>(),
        skip in any::<bool>(),
    ) {
        let samples = Samples::standard(samples).expect("a pattern");
        (layers.scene.samples, layers.primitives.samples) = (samples, samples);
        layers.scene.order = if by_sample { Order::Sample } else { Order::Centroid };
        for adapter in adapters() {
            for path in [Path::Compute, Path::Fragment, Path::Native] {
                if draws(adapter, path, &layers.primitives) {
                    agrees(&layers, adapter, path, skip)?;
                }
            }
        }
    }
}

proptest! {
    #![proptest_config(config(24))]

    /// From the same triangles, every adapter and path has the spec's fragments,
    /// surfaces, lists and order to the bit, and its picture inside the bound.
    #[test]
    fn random_triangles(layers in layers(), skip in any::<bool>()) {
        for adapter in adapters() {
            for path in [Path::Compute, Path::Fragment, Path::Native] {
                if path != Path::Fragment || adapter.bits(path) == layers.primitives.bits {
                    agrees(&layers, adapter, path, skip)?;
                }
            }
        }
    }
}

/// Runs every rival and compares each, with a medium and a lens.
fn rivals_agree(layers: &Layers, adapter: &Adapter, path: Path) -> Result<(), TestCaseError> {
    let lens = Lens {
        focus: 1 << 30,
        aperture: 9,
        radius: 3,
    };
    let asked = Asked {
        rivals: true,
        density: Some(2.5),
        defocus: Some(lens),
        reduced: Some(Reduction {
            halvings: 1,
            falloff: 40.0,
        }),
    };
    let plan = Plan::asking(&layers.scene, true, asked);
    let spec = spec_of(layers, &plan)?;
    let leg = leg(layers, (adapter, path), (&plan, &spec), false);
    let mut rows = Rows::new("law", "abuffer");
    let failed = |e: GpuError| TestCaseError::fail(e.to_string());
    rivals::run(&leg, Extent::All, &mut rows).map_err(failed)?;
    let words = || rows.described.join("\n");
    let transparent = layers.scene.triangles.iter().any(|t| !t.is_opaque());
    for row in &rows.rows {
        let verdict = row.verdict();
        prop_assert_ne!(verdict, Verdict::Diverge, "{:?}\n{}", row, words());
        prop_assert_eq!(verdict == Verdict::Agree, transparent, "{:?}", row);
    }
    if path == Path::Fragment && transparent {
        let rasterizer = leg.rasterizer().map_err(failed)?;
        let is_opaque = |prim| spec.value.is_opaque(prim);
        let given = Given {
            opaque: &spec.value.opaque,
            background: layers.scene.background,
        };
        let half = Single::Alpha { half: true };
        let seen = once(&rasterizer, half, given, is_opaque).map_err(failed)?;
        let must = spec
            .value
            .rivals
            .alpha(Target::Half, &layers.scene, &spec.value);
        let judged = image::compare(&must.image, &seen.image, layers.scene.size.width);
        prop_assert_eq!(judged.differ(), 0, "16 bits: {:?}", judged.described);
    }
    Ok(())
}

proptest! {
    #![proptest_config(config(6))]

    /// From the same triangles, every adapter and path peels the spec's layers to the bit, and
    /// has the pictures of all rivals inside their bounds.
    #[test]
    fn random_rivals(layers in layers()) {
        for adapter in adapters() {
            for path in Path::ALL {
                let can = path != Path::Native || adapter.native.is_some();
                let same = path != Path::Fragment || adapter.bits(path) == layers.primitives.bits;
                if can && same {
                    rivals_agree(&layers, adapter, path)?;
                }
            }
        }
    }
}

/// Runs every layout and compares each; the first attempts have too little room.
fn layouts_agree(layers: &Layers, adapter: &Adapter, path: Path) -> Result<(), TestCaseError> {
    let asked = Asked {
        rivals: true,
        ..Asked::default()
    };
    let plan = Plan::asking(&layers.scene, true, asked);
    let spec = spec_of(layers, &plan)?;
    let leg = leg(layers, (adapter, path), (&plan, &spec), true);
    let mut rows = Rows::new("law", "layouts");
    let failed = |e: GpuError| TestCaseError::fail(e.to_string());
    layouts::run(&leg, Extent::All, &mut rows).map_err(failed)?;
    let transparent = layers.scene.triangles.iter().any(|t| !t.is_opaque());
    for row in &rows.rows {
        let words = || rows.described.join("\n");
        let must = if transparent {
            Verdict::Agree
        } else {
            Verdict::Skipped
        };
        prop_assert_eq!(row.verdict(), must, "{:?}\n{}", row, words());
    }
    Ok(())
}

proptest! {
    #![proptest_config(config(4))]

    /// From the same triangles, every adapter and path has the spec's lists in every layout, with one
    /// sample a pixel and with four.
    #[test]
    fn random_layouts(mut layers in layers(), samples in prop::sample::select(vec![1, 4])) {
        let samples = Samples::standard(samples).expect("a pattern");
        (layers.scene.samples, layers.primitives.samples) = (samples, samples);
        for adapter in adapters() {
            for path in Path::ALL {
                let can = path != Path::Native || adapter.native.is_some();
                if can && draws(adapter, path, &layers.primitives) {
                    layouts_agree(&layers, adapter, path)?;
                }
            }
        }
    }
}
