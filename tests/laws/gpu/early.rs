//! Lists of the fragment path behind a test of depth, where an adapter has one, and without it.

use proptest::prelude::*;
use triptych_gpu::abuffer::{Abuffer, Options, run};
use triptych_gpu::raster::{Path, Rasterizer};
use triptych_harness::compare::order::flatten;
use triptych_harness::plan::Plan;
use triptych_harness::replay::gpu::Adapter;
use triptych_harness::replay::spec::SpecRun;
use triptych_spec::raster::Samples;

use super::{adapters, config, draws, layers, spec_of};
use crate::abuffer::Layers;

/// The lists of a scene, with or without the test.
fn built(
    layers: &Layers,
    adapter: &Adapter,
    (plan, spec): (&Plan, &SpecRun),
    (early, room): (bool, u32),
) -> Abuffer {
    let kernels = adapter.kernels(Path::Fragment);
    let made = Rasterizer::new(
        &adapter.gpu,
        kernels,
        Path::Fragment,
        &spec.primitives,
        &spec.faces,
    );
    let mut rasterizer = made.expect("few triangles");
    if !early {
        rasterizer.forgo_early_test();
    }
    let options = Options {
        capacity: Some(room),
        ..plan.abuffer(&layers.scene)
    };
    let longest = spec.sorted.longest();
    let opaque = |prim| spec.is_opaque(prim);
    run(&rasterizer, options, opaque, |_, _| Some(longest)).expect("it runs")
}

proptest! {
    #![proptest_config(config(128))]

    /// A pass more, and the same lists: those of the spec.
    #[test]
    fn what_is_rejected_early_is_hidden(
        mut layers in layers(),
        // Drivers without a board have 1 and 4.
        samples in prop::sample::select(vec![1, 1, 1, 2, 4, 4, 4, 8]),
        share in 0_u32..=4,
    ) {
        let samples = Samples::standard(samples).expect("a pattern");
        (layers.scene.samples, layers.primitives.samples) = (samples, samples);
        let plan = Plan::new(&layers.scene, true);
        let spec = spec_of(&layers, &plan)?;
        let spec = &spec.value;
        for adapter in adapters() {
            if !draws(adapter, Path::Fragment, &layers.primitives) {
                continue;
            }
            // Often less than all: then it is tried again.
            let room = spec.lists.attempts.div_ceil(4) * share;
            let both =
                [true, false].map(|early| built(&layers, adapter, (&plan, spec), (early, room)));
            for made in &both {
                let sorted = made.bands.iter().map(|band| band.sorted.as_ref().and_then(flatten));
                let sorted: Vec<_> = sorted.collect();
                prop_assert_eq!(sorted, vec![Some(spec.sorted.clone())], "{}", adapter.gpu.name);
            }
            let passes = both.map(|made| made.passes.iter().filter(|p| p.stage == "build").count());
            let tested = plan.depth_test && passes[1] > 0;
            let tested = tested && adapter.gpu.tests_depth_early(samples.count());
            // Each attempt has one.
            prop_assert_eq!(passes[0], passes[1] << u32::from(tested), "{}", adapter.gpu.name);
        }
    }
}
