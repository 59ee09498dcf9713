//! Frames that are timed: in bands, in the same buffers one after another.

use triptych_gpu::abuffer::{Part, Timed, with_layers};
use triptych_gpu::context;
use triptych_gpu::kernel::Kernels;
use triptych_gpu::raster::{Path, Rasterizer};
use triptych_gpu::wgsl::Sources;
use triptych_harness::plan::Plan;
use triptych_harness::replay::gpu::{Adapter, Drawn};
use triptych_harness::replay::spec::SpecRun;
use triptych_harness::scene::Loaded;
use triptych_spec::vertex::{Primitives, primitives};

use super::{found, load};

/// Of each pixel the keys and triangles of its sorted list.
type Lists = Vec<Vec<[u32; 2]>>;

/// What came of a frame.
#[derive(PartialEq)]
struct Made {
    /// Of each part that makes one, the bits of its picture.
    pictures: Vec<(Part, Vec<[u32; 3]>)>,
    lists: Lists,
}

/// A leg of a scene.
struct Leg<'l> {
    loaded: &'l Loaded,
    adapter: &'l Adapter,
    kernels: &'l Kernels,
    path: Path,
    run: SpecRun,
    plan: Plan,
}

impl Leg<'_> {
    /// Fragments of each row.
    fn rows(&self) -> Vec<u32> {
        self.run.sorted.rows(self.loaded.scene.size.width)
    }

    /// Makes the frame within so many bytes, with room for `rows`; and in how many bands.
    fn made(&self, rows: &[u32], budget: u64) -> (Made, usize) {
        let Self { run, plan, .. } = self;
        let (gpu, scene) = (&self.adapter.gpu, &self.loaded.scene);
        let rasterizer = Rasterizer::new(gpu, self.kernels, self.path, &run.primitives, &run.faces);
        let rasterizer = rasterizer.expect("a small scene");
        let options = plan.abuffer(scene);
        let opaque = |prim| run.is_opaque(prim);
        let timed = Timed::in_bands(&rasterizer, options, rows, budget, opaque);
        let mut timed = timed.expect("it fits in bands");
        timed.follow(64, &[1, 2, 64]).expect("kernels that ship");
        let mut lists = Lists::new();
        let sorted = timed.sorted(|_, band| {
            let inside = |at: u32| band.nodes.get(at as usize);
            let follow = |head: &u32| {
                let nodes = std::iter::successors(inside(*head), |node| inside(node.next));
                nodes.map(|node| [node.key, node.prim]).collect()
            };
            lists.extend(band.heads.iter().map(follow));
        });
        sorted.expect("it runs");
        let mut pictures = Vec::new();
        let seen = timed.pictures(|part, picture| {
            let bits = picture.iter().map(|pixel| pixel.map(f32::to_bits));
            pictures.push((part, bits.collect()));
        });
        seen.expect("it runs");
        (Made { pictures, lists }, timed.bands())
    }
}

/// A frame that is timed in bands, in the same buffers one after another, has the lists and, bit for
/// bit, the pictures of one that is made at once; with several samples a pixel as well. With room
/// for a fragment less in one row it has not.
#[test]
fn timed_bands_give_the_bytes_of_the_whole() {
    for name in ["abuffer/mixed", "abuffer/msaa-mixed"] {
        let loaded = load(name);
        let scene = &loaded.scene;
        for adapter in found() {
            let short = context::short_name(&adapter.get_info());
            let adapter = Adapter::open(&adapter, &short).expect("the adapter opens");
            let kernels = Kernels::new(with_layers(Sources::shipped(false), &[1, 2, 64]));
            for path in [Path::Fragment, Path::Compute] {
                let at = format!("{name}, {short} {path:?}");
                let samples = adapter
                    .samples(path, scene.samples)
                    .expect("it is calibrated");
                let Drawn::With(samples) = samples else {
                    continue;
                };
                let plan = Plan::new(scene, true);
                let snapped = Primitives {
                    samples,
                    ..primitives(scene, adapter.bits(path))
                };
                let leg = Leg {
                    run: SpecRun::new(scene, snapped, &plan).expect("a small scene"),
                    loaded: &loaded,
                    adapter: &adapter,
                    kernels: &kernels,
                    path,
                    plan,
                };
                let mut rows = leg.rows();
                let (whole, one) = leg.made(&rows, u64::MAX);
                let (parts, bands) = leg.made(&rows, 60_000);
                assert_eq!(one, 1, "{at}");
                assert!(bands > 4, "{at}: {bands} bands only: it was not felt");
                let longest = whole.lists.iter().map(Vec::len).max();
                assert!(longest > Some(2), "{at}: no lists");
                assert!(parts.lists == whole.lists, "{at}: lists");
                assert!(parts == whole, "{at}: pictures");
                let middle = rows.len() / 2;
                rows[middle] -= 1;
                let (short, _) = leg.made(&rows, 60_000);
                assert!(short.lists != whole.lists, "{at}: nothing is missing");
            }
        }
    }
}
