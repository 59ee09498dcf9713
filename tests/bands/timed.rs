//! Frames that are timed: in bands, in the same buffers one after another.

use triptych_gpu::abuffer::{self, Part, Timed, with_layers};
use triptych_gpu::context::Gpu;
use triptych_gpu::kernel::Kernels;
use triptych_gpu::raster::{Path, Rasterizer};
use triptych_gpu::wgsl::Sources;
use triptych_harness::plan::Plan;
use triptych_harness::replay::spec::SpecRun;
use triptych_harness::scene::Loaded;
use triptych_spec::vertex::{SUBPIXEL_BITS, primitives};

use super::{found, load};

/// Sorted lists of a band, with the triangles' numbers and keys.
type Ordered = Vec<Vec<[u32; 2]>>;

/// What is timed of a scene within so many bytes: the picture of each part, as bits, the sorted
/// lists from top to bottom, and how many bands there are.
fn timed(
    loaded: &Loaded,
    (gpu, kernels): &(Gpu, Kernels),
    path: Path,
    budget: u64,
) -> (Vec<(Part, Vec<[u32; 3]>)>, Ordered, usize) {
    let (scene, plan) = (&loaded.scene, Plan::new(&loaded.scene, true));
    let run = SpecRun::new(scene, primitives(scene, SUBPIXEL_BITS), &plan).expect("small");
    let rasterizer = Rasterizer::new(gpu, kernels, path, &run.primitives, &run.faces);
    let rasterizer = rasterizer.expect("a small scene");
    let width = scene.size.width as usize;
    let ends = run.sorted.offsets.iter().step_by(width);
    let rows: Vec<u32> = ends.clone().zip(ends.skip(1)).map(|(a, b)| b - a).collect();
    let options = abuffer::Options {
        given: None,
        capacity: None,
        opaque: plan.opaque,
        lists: plan.lists,
        depth_test: plan.depth_test,
        order: scene.order,
        once: plan.once,
        background: scene.background,
    };
    let opaque = |prim| run.is_opaque(prim);
    let made = Timed::in_bands(&rasterizer, options, &rows, budget, opaque);
    let mut made = made.expect("it fits in bands");
    let longest = run.lists.nodes.len().min(64);
    made.follow(u32::try_from(longest).expect("few"), &[1, 2, 64])
        .expect("kernels that ship");
    let mut lists = Ordered::new();
    made.sorted(|_, band| {
        let follow = |head: &u32| {
            let inside = |at: u32| band.nodes.get(at as usize);
            let nodes = std::iter::successors(inside(*head), |node| inside(node.next));
            nodes.map(|node| [node.key, node.prim]).collect()
        };
        lists.extend(band.heads.iter().map(follow));
    })
    .expect("it runs");
    let mut pictures = Vec::new();
    let seen = made.pictures(|part, picture| {
        let bits = picture.iter().map(|pixel| pixel.map(f32::to_bits));
        pictures.push((part, bits.collect()));
    });
    seen.expect("it runs");
    (pictures, lists, made.bands())
}

/// A frame that is timed in bands, in the same buffers one after another, has the lists and, bit for
/// bit, the pictures of one that is made at once; with several samples a pixel as well.
#[test]
fn timed_bands_give_the_bytes_of_the_whole() {
    for name in ["abuffer/mixed", "abuffer/msaa-mixed"] {
        let loaded = load(name);
        for adapter in found() {
            let gpu = Gpu::open(&adapter).expect("the adapter opens");
            let kernels = with_layers(Sources::shipped(false), &[1, 2, 64]);
            let device = (gpu, Kernels::new(kernels));
            for path in [Path::Fragment, Path::Compute] {
                let at = format!("{name}, {} {path:?}", device.0.name);
                if path == Path::Fragment && !device.0.has_samples(loaded.scene.samples.count()) {
                    continue;
                }
                let (whole, lists, one) = timed(&loaded, &device, path, u64::MAX);
                let (parts, ordered, bands) = timed(&loaded, &device, path, 60_000);
                assert_eq!(one, 1, "{at}");
                assert!(bands > 4, "{at}: {bands} bands only: it was not felt");
                assert!(lists.iter().any(|list| list.len() > 2), "{at}: no lists");
                assert!(ordered == lists, "{at}: lists");
                let parts_of = |all: &[(Part, Vec<[u32; 3]>)]| -> Vec<Part> {
                    all.iter().map(|(part, _)| *part).collect()
                };
                assert_eq!(parts_of(&parts), parts_of(&whole), "{at}");
                assert!(parts == whole, "{at}: pictures");
            }
        }
    }
}
