//! Tiles on every adapter: what a run of few triangles cannot show.

use triptych_gpu::lists::LONG;
use triptych_gpu::raster::{Path, Rasterizer};
use triptych_gpu::tiles::{Options, run, run_linked, run_local};
use triptych_harness::compare::image;
use triptych_harness::compare::order::flatten;
use triptych_spec::abuffer::{build, opaque, resolve, sort};
use triptych_spec::tiles::{BIN_SORTED, ROWS, local};

use super::stack;
use crate::adapters::devices;

/// However few triangles a dispatch draws, lists that lie in rows, such that do not, and such that are
/// merged are whole.
#[test]
fn dispatches_go_on_where_the_last_one_stopped() {
    let all: &[u32] = &[1, 7, 64, 1000];
    let few: &[u32] = &[64, 1000];
    let long = [ROWS, ROWS + 1, LONG, LONG + 1].map(|depth| (depth, few));
    for (depth, at_once) in [(40, all), (100, all)].into_iter().chain(long) {
        let layers = stack(depth);
        let primitives = &layers.primitives;
        let surfaces = opaque(&layers.scene, primitives);
        let must = sort(&build(
            &layers.scene,
            primitives,
            &surfaces,
            false,
            u32::MAX,
        ));
        let picture = resolve(&layers.scene, primitives, &surfaces, &must);
        let agrees = |image: &[[f32; 3]], words: &str| {
            let judgement = image::compare(&picture, image, 9);
            assert_eq!(
                (judgement.compared, judgement.differ()),
                (3 * 81, 0),
                "{words}"
            );
        };
        let faces = vec![[0.5, 0.25, 0.125, 0.5]; depth as usize];
        for (gpu, kernels) in devices() {
            let rasterizer = Rasterizer::new(gpu, &kernels[0], Path::Compute, primitives, &faces);
            let rasterizer = rasterizer.expect("few triangles");
            for &drawn in at_once {
                let options = Options {
                    opaque: &surfaces,
                    depth_test: false,
                    background: [1.0; 3],
                    capacity: None,
                    drawn,
                };
                let seen = run(&rasterizer, options).expect("it runs");
                let lists = seen.bands[0].sorted.as_ref().and_then(flatten);
                let words = format!("{}, {depth} layers, {drawn} at once", gpu.name);
                assert_eq!(lists.as_ref(), Some(&must), "{words}");
                agrees(&seen.image, &words);
                let left = run_local(&rasterizer, options).expect("it runs");
                assert_eq!(left.digests, local(&must, primitives.samples), "{words}");
                agrees(&left.image, &words);
                // A bin that is put in order leaves nothing to lists, although the stack is from the back.
                let is_left = depth > BIN_SORTED || depth > drawn;
                let tiles = left.left.iter().flat_map(|(_, tiles)| tiles);
                assert_eq!(
                    tiles.copied().next(),
                    Some(is_left),
                    "{words}, the first tile"
                );
                let nodes = run_linked(&rasterizer, options, |_| Some(depth)).expect("it runs");
                let lists = nodes.bands[0].sorted.as_ref().and_then(flatten);
                assert_eq!(lists.as_ref(), Some(&must), "{words}");
                agrees(&nodes.image, &words);
            }
        }
    }
}
