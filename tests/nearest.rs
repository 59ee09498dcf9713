//! The nearest layers alone, on every adapter and path: each number of them is the
//! spec's picture, from unsorted lists and from sorted ones; and kernels with a defect
//! are not.

#[path = "nearest/psnr.rs"]
mod psnr;

use std::path::Path as FilePath;

use triptych_gpu::abuffer::{Options, Part, Timed, can_keep, with_layers};
use triptych_gpu::kernel::Kernels;
use triptych_gpu::raster::{Path, Rasterizer};
use triptych_gpu::wgsl::Sources;
use triptych_harness::compare::lists::certify;
use triptych_harness::compare::{compare, image};
use triptych_harness::corpus::{self, Entry};
use triptych_harness::observe::{Gpu, Observed};
use triptych_harness::plan::Plan;
use triptych_harness::replay::gpu::{Adapter, Adapters};
use triptych_harness::replay::spec::SpecRun;
use triptych_harness::scene::load_entry;
use triptych_spec::abuffer::{nearest_layers, resolve, sort};
use triptych_spec::vertex::primitives;

fn adapters() -> Vec<Adapter> {
    let Adapters { open, broken } = Adapters::open(&[]);
    assert_eq!(broken, [], "every adapter can be used");
    assert!(!open.is_empty(), "no adapter: `./x setup` installs two");
    open
}

/// A scene of ours, whose equal keys differ in colour, beside those of the corpus.
const TIES: &str = "nearest.toml";

fn entry(name: &str) -> Entry {
    if name == TIES {
        return Entry::outside(&FilePath::new(env!("CARGO_MANIFEST_DIR")).join(TIES));
    }
    let entries = corpus::list(&corpus::root()).expect("the corpus can be read");
    let found = entries.into_iter().find(|e| e.name == name);
    found.unwrap_or_else(|| panic!("no scene {name}"))
}

/// The variants of a scene whose picture is not the spec's, and how many were compared.
/// With `skip` false the lists hold what an opaque surface hides.
fn wrong(
    name: &str,
    layers: &[u32],
    adapter: &Adapter,
    path: Path,
    kernels: &Kernels,
    skip: bool,
) -> (Vec<String>, usize) {
    let loaded = load_entry(&entry(name), None).unwrap_or_else(|e| panic!("{name}: {e}"));
    let (scene, plan) = (&loaded.scene, Plan::new(&loaded.scene, skip));
    let snapped = primitives(scene, adapter.bits(path));
    let run = SpecRun::new(scene, snapped, &plan).unwrap_or_else(|e| panic!("{name}: {e}"));
    let (gpu, faces) = (&adapter.gpu, &run.faces);
    let rasterizer = Rasterizer::new(gpu, kernels, path, &run.primitives, faces);
    let rasterizer = rasterizer.unwrap_or_else(|e| panic!("{e}"));
    let options = Options {
        capacity: Some(run.lists.attempts),
        order: triptych_spec::abuffer::Order::Centroid,
        once: false,
        ..plan.abuffer(scene)
    };
    let timed = Timed::new(&rasterizer, options, |prim| run.is_opaque(prim));
    let mut timed = timed.unwrap_or_else(|e| panic!("{e}"));
    let mut longest = None;
    let built = timed.build(|_, lists| longest = certify(&lists).longest());
    built.unwrap_or_else(|e| panic!("{e}"));
    let longest = longest.expect("lists are sound");
    timed
        .follow(longest, layers)
        .unwrap_or_else(|e| panic!("{e}"));
    let (mut wrong, mut compared) = (Vec::new(), 0);
    let seen = timed.pictures(|part, picture| {
        let kept = match part {
            Part::Nearest(n) | Part::NearestSorted(n) => nearest_layers(&run.lists, n),
            _ => sort(&run.lists),
        };
        let must = resolve(scene, &run.primitives, &run.opaque, &kept);
        let must = Observed::<triptych_harness::observe::Spec, _>::new("spec", must);
        let seen = Observed::<Gpu, _>::new("gpu", picture);
        let width = scene.size.width;
        let judgement = compare(&must, &seen, |a, b| image::compare(a, b, width));
        assert!(judgement.compared > 0, "{name}: nothing was compared");
        compared += 1;
        if judgement.differ() > 0 {
            let at = format!("{name} on {}/{}", gpu.name, path.name());
            wrong.push(format!("{at}, {part:?}: {:?}", judgement.described));
        }
    });
    seen.unwrap_or_else(|e| panic!("{e}"));
    (wrong, compared)
}

/// What an adapter can run of these, shipped or with text in place of text.
fn kernels(path: Path, layers: &[u32], patch: Option<(&str, &str)>) -> Kernels {
    let native = path == Path::Native;
    match patch {
        None => Kernels::trusted(native, |sources| with_layers(sources, layers)),
        Some((find, replace)) => {
            let sources = Sources::shipped(native).patched("nearest", find, replace);
            let sources = sources.unwrap_or_else(|e| panic!("{e}"));
            Kernels::new(with_layers(sources, layers))
        }
    }
}

/// Calls with each adapter and each of its paths.
fn each(mut run: impl FnMut(&Adapter, Path)) {
    for adapter in &adapters() {
        for path in Path::ALL {
            if path != Path::Native || adapter.native.is_some() {
                run(adapter, path);
            }
        }
    }
}

/// Equal keys, opaque surfaces behind, empty lists, more layers than a list has, and a
/// list that is too long for one walk.
#[test]
fn every_number_of_layers_is_the_specs() {
    let scenes: [(&str, &[u32], bool, usize); 7] = [
        // Insertion; sorted, of fewer than there are; all of them.
        ("abuffer/quads", &[1, 2, 3, 7, 8, 11], true, 6 + 4 + 1),
        ("abuffer/reversed", &[1, 2, 5, 64], true, 4 + 3 + 1),
        ("abuffer/coplanar", &[1, 2, 5, 15, 16], true, 5 + 4 + 1),
        (TIES, &[1, 2, 5, 11, 12], true, 5 + 4 + 1),
        ("abuffer/mixed", &[1, 2, 3, 64], true, 4 + 3 + 1),
        ("abuffer/mixed", &[1, 2, 3, 64], false, 4 + 3 + 1),
        ("abuffer/contention", &[1, 2, 4, 64, 1000], true, 2 + 5 + 1),
    ];
    each(|adapter, path| {
        for (name, layers, skip, count) in scenes {
            let kernels = kernels(path, layers, None);
            let (wrong, compared) = wrong(name, layers, adapter, path, &kernels, skip);
            assert_eq!(wrong, [""; 0], "{name}");
            let layers_of = |n: &u32| format!("{name}: {n}");
            let all: Vec<String> = layers.iter().map(layers_of).collect();
            assert_eq!(compared, count, "variants of {all:?}");
        }
    });
}

/// Named defects, each on a scene that shows it, on every adapter and path.
#[test]
fn defects_are_seen() {
    let defects = [
        (
            "the first layers instead of the nearest",
            "if !is_before(nearest, LAYERS - 1u, key, at) {",
            "if true {",
            "abuffer/mixed",
        ),
        (
            "no order among equal keys",
            "return nodes[at].prim < nodes[(*nearest).at[place]].prim;",
            "return false;",
            TIES,
        ),
        (
            "one layer too few",
            "i < kept.count; i",
            "i < min(kept.count, LAYERS - 1u); i",
            "abuffer/quads",
        ),
        (
            "one layer too few of a sorted list",
            "i < LAYERS && at != EOL",
            "i + 1u < LAYERS && at != EOL",
            "abuffer/quads",
        ),
        (
            "layers behind an opaque surface",
            "if node.key < end {",
            "if true {",
            "abuffer/mixed",
        ),
        (
            "layers behind an opaque surface, sorted",
            "if node.key >= end {",
            "if false {",
            "abuffer/mixed",
        ),
    ];
    each(|adapter, path| {
        for (defect, find, replace, scene) in defects {
            // Of the stone in `mixed`, three layers are before everything that it hides.
            let layers = [2, 3, 4, 5];
            let kernels = kernels(path, &layers, Some((find, replace)));
            let (wrong, _) = wrong(scene, &layers, adapter, path, &kernels, false);
            let at = format!("{} {}", adapter.gpu.name, path.name());
            assert!(!wrong.is_empty(), "{defect}: not seen on {at}");
        }
    });
}

#[test]
fn lists_are_walked_only_where_the_steps_suffice() {
    assert!(can_keep(1, 8000), "two steps a node");
    assert!(!can_keep(1, 8192), "16,384 and the layer");
    assert!(can_keep(64, 120), "the insertions of all but a few");
    assert!(!can_keep(64, 4096), "64 moves a node");
    assert!(!can_keep(65, 65), "no room");
}
