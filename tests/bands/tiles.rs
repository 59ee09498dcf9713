//! Frames by tiles that are timed: in bands of whole tiles, in the same buffers one after another.

use triptych_gpu::raster::{Path, Rasterizer};
use triptych_gpu::tiles::{Banded, DRAWN, Options, Way};
use triptych_harness::plan::Plan;
use triptych_harness::replay::spec::SpecRun;
use triptych_spec::vertex::{SUBPIXEL_BITS, primitives};

use super::{devices, load};

/// What came of a frame: the bits of its pictures by numbers of layers, fragments, triangles in bins,
/// tiles or lists that were left.
#[derive(PartialEq)]
struct Made {
    pictures: Vec<(u32, Vec<[u32; 3]>)>,
    counts: [u64; 3],
}

fn made(timed: &Banded<'_, '_>) -> Made {
    let mut pictures = Vec::new();
    let seen = timed.pictures(|layers, picture| {
        let bits = picture.iter().map(|pixel| pixel.map(f32::to_bits));
        pictures.push((layers, bits.collect()));
    });
    seen.expect("it runs");
    Made {
        pictures,
        counts: [timed.fragments(), timed.binned(), timed.left()],
    }
}

/// A frame by tiles that is timed in bands has, bit for bit, the pictures of one that is made at once, and
/// holds no more than it may; also where tiles without lists leave some to lists, in some bands alone.
#[test]
fn bands_of_tiles_give_the_bytes_of_the_whole() {
    let loaded = load("abuffer/hidden");
    let (scene, plan) = (&loaded.scene, Plan::new(&loaded.scene, true));
    let run = SpecRun::new(scene, primitives(scene, SUBPIXEL_BITS), &plan).expect("a small scene");
    let rows = run.sorted.rows(scene.size.width);
    for (gpu, kernels) in devices(|_| {}) {
        let rasterizer =
            Rasterizer::new(&gpu, &kernels, Path::Compute, &run.primitives, &run.faces)
                .expect("a small scene");
        for (way, drawn) in [
            (Way::Runs, DRAWN),
            (Way::Linked, DRAWN),
            (Way::Local, DRAWN),
            (Way::Local, 4),
        ] {
            let at = format!("{}, {way:?}, {drawn} triangles", gpu.name);
            let options = Options {
                opaque: &run.opaque,
                depth_test: plan.depth_test,
                background: scene.background,
                capacity: None,
                drawn,
            };
            let within = |budget| {
                let timed = Banded::new(&rasterizer, &options, (way, &[1, 64]), &rows, budget);
                timed.expect("it fits in bands")
            };
            let whole = within(u64::MAX);
            assert_eq!(whole.bands(), 1, "{at}");
            if way == Way::Local {
                assert_eq!(whole.left() > 0, drawn == 4, "{at}: {} left", whole.left());
            }
            // More than a third: surfaces and large triangles are held for all of it.
            let budget = whole.bytes() * 2 / 5;
            let parts = within(budget);
            let bands = parts.bands();
            assert!(bands > 2, "{at}: {bands} bands only: it was not felt");
            assert!(
                parts.bytes() <= budget,
                "{at}: {} of {budget} bytes",
                parts.bytes()
            );
            let (whole, parts) = (made(&whole), made(&parts));
            assert_eq!(whole.pictures.len(), 2, "{at}");
            assert_ne!(
                whole.pictures[0].1, whole.pictures[1].1,
                "{at}: one layer is another picture"
            );
            assert_eq!(parts.counts, whole.counts, "{at}");
            assert!(parts == whole, "{at}: pictures");
        }
    }
}
