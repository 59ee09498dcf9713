//! Tiles on every adapter: what a run of few triangles cannot show.

use triptych_gpu::kernel::Kernels;
use triptych_gpu::lists::LONG;
use triptych_gpu::raster::{Path, Rasterizer};
use triptych_gpu::tiles::{Banded, DRAWN, Options, Span, Way, run, run_linked, run_local};
use triptych_gpu::wgsl::Sources;
use triptych_harness::compare::image;
use triptych_harness::compare::order::flatten;
use triptych_spec::abuffer::{Opaque, build, opaque, resolve, sort};
use triptych_spec::tiles::{BIN_SORTED, ROWS, local};

use super::stack;
use crate::abuffer::Layers;
use crate::adapters::devices;

fn options(opaque: &Opaque, drawn: u32) -> Options<'_> {
    Options {
        opaque,
        depth_test: false,
        background: [1.0; 3],
        capacity: None,
        drawn,
    }
}

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
                let options = options(&surfaces, drawn);
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

/// Layers over all of a target, each before the next; the first `slivers` of them lie between samples.
fn sheets(layers: u32, slivers: u32) -> Layers {
    const SLIVER: [[i32; 2]; 3] = [[300, 470], [470, 300], [472, 302]];
    const SHEET: [[i32; 2]; 3] = [[0, 0], [40 << 8, 0], [0, 40 << 8]];
    let mut made = stack(layers);
    let corners = (0..layers).flat_map(|n| if n < slivers { SLIVER } else { SHEET });
    for ((corner, at), number) in made.primitives.snapped.iter_mut().zip(corners).zip(3..) {
        *corner = [at[0], at[1], number / 3];
    }
    made
}

/// Frames that are timed sort where bins come in any order, though the first came in order, as lists of one
/// do; they hold a second array for lists alone that are merged.
#[test]
fn passes_of_timed_frames_do_for_every_frame() {
    for (depth, slivers, sorts, merges) in [
        (100, 0, false, false),
        (BIN_SORTED, BIN_SORTED - 1, false, false),
        (BIN_SORTED + 1, BIN_SORTED, true, false),
        (LONG + 1, 0, true, true),
    ] {
        let layers = sheets(depth, slivers);
        let primitives = &layers.primitives;
        let surfaces = opaque(&layers.scene, primitives);
        let lists = sort(&build(
            &layers.scene,
            primitives,
            &surfaces,
            false,
            u32::MAX,
        ));
        assert_eq!(lists.longest(), depth - slivers, "slivers cover nothing");
        let rows = lists.rows(primitives.size.width);
        let faces = vec![[0.5, 0.25, 0.125, 0.5]; depth as usize];
        for (gpu, kernels) in devices() {
            let rasterizer = Rasterizer::new(gpu, &kernels[0], Path::Compute, primitives, &faces);
            let rasterizer = rasterizer.expect("few triangles");
            let options = options(&surfaces, DRAWN);
            for way in [Way::Runs, Way::Linked] {
                let timed = Banded::new(&rasterizer, &options, (way, &[1]), &rows, 1 << 30);
                let timed = timed.expect("it fits");
                let at = format!("{}, {way:?}, {depth} layers", gpu.name);
                assert!(timed.binned() >= depth.into(), "{at}: slivers are in a bin");
                assert_eq!(timed.parts().contains(&Span::Sort), sorts, "{at}");
                assert_eq!(timed.merges(), merges && way == Way::Runs, "{at}");
            }
        }
    }
}

/// Whatever a kernel of a user's says of its lists, the host has a buffer for what it then runs.
#[test]
fn kernels_may_say_anything_of_their_lists() {
    let layers = sheets(100, 0);
    let primitives = &layers.primitives;
    let surfaces = opaque(&layers.scene, primitives);
    let faces = vec![[0.5, 0.25, 0.125, 0.5]; 100];
    let says = "atomicMax(&longest.length, found.longest);";
    let more = "atomicMax(&longest.length, 5000u); atomicOr(&longest.kernels, 16u);";
    let lies = Sources::shipped(false).patched("jagged", says, more);
    let lies = lies.expect("the text is there, once");
    for (gpu, _) in devices() {
        let kernels = Kernels::new(lies.clone());
        let rasterizer = Rasterizer::new(gpu, &kernels, Path::Compute, primitives, &faces);
        let rasterizer = rasterizer.expect("few triangles");
        let seen = run(&rasterizer, options(&surfaces, DRAWN)).expect("it runs");
        assert_eq!(seen.image.len(), 81, "{}", gpu.name);
    }
}
